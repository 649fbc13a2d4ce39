#include "sandbox/panels/pass_costs.hpp"

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("pass costs") {

namespace {

FrameReport frame_of(std::vector<PassReport> passes) {
    return {.index = 0, .cpu_ms = 5.0, .gpu_ms = 7.0, .passes = std::move(passes)};
}

}  // namespace

TEST_CASE("a pass that does not run keeps the cost of its last run") {
    PassCosts costs;
    costs.add(frame_of({{"maps", true, 1.0, 4.0}}));
    costs.add(frame_of({{"maps", false, 0.0, 0.0}}));
    const PassCost& maps = costs.passes().front();
    CHECK_FALSE(maps.ran);
    CHECK(maps.cpu_ms == 1.0);
    CHECK(maps.last_ms() == 4.0);
    CHECK(maps.history == std::vector<float>{4.0F});
}

TEST_CASE("the mean is that of the runs, of the longer of both times") {
    PassCosts costs;
    costs.add(frame_of({{"gather", true, 1.0, 4.0}}));
    costs.add(frame_of({{"gather", false, 0.0, 0.0}}));
    costs.add(frame_of({{"gather", true, 8.0, 2.0}}));
    CHECK(costs.passes().front().mean_ms == 6.0);
    CHECK(costs.frame().mean_ms == 7.0);
    CHECK(costs.frame().history.size() == 3);
}

TEST_CASE("only the last runs are kept") {
    PassCosts costs;
    for (std::size_t i = 0; i < 2 * PassCosts::kept; ++i) {
        costs.add(frame_of({{"gather", true, static_cast<double>(i), 0.0}}));
    }
    const PassCost& gather = costs.passes().front();
    CHECK(gather.history.size() == PassCosts::kept);
    CHECK(gather.history.front() == static_cast<float>(PassCosts::kept));
}

TEST_CASE("passes follow the graph of the last frame") {
    PassCosts costs;
    costs.add(frame_of({{"gbuffer", true, 1.0, 1.0}, {"deferred", true, 2.0, 2.0}}));
    costs.add(frame_of({{"forward", true, 3.0, 3.0}, {"gbuffer", false, 0.0, 0.0}}));
    REQUIRE(costs.passes().size() == 2);
    CHECK(costs.passes()[0].name == "forward");
    CHECK(costs.passes()[1].last_ms() == 1.0);
}
}  // TEST_SUITE("pass costs")

}  // namespace candela::sandbox
