// The limit of surfels follows the time that they take.

#include <algorithm>
#include <cstdint>

#include <doctest/doctest.h>

#include "sandbox/headless/update_budget.hpp"

TEST_SUITE("update budget") {

using namespace candela;
using namespace candela::sandbox;

namespace {

constexpr double budget_ms = 60.0;

/// The times of a frame: `surfel_ms` in the map of each of the surfels that were traced, `between_ms` between
/// surfels, and those of the other passes.
FrameReport frame_of(std::uint32_t surfels, double surfel_ms, double others_ms, std::uint32_t waiting,
                     bool moves = true, double between_ms = 0.0) {
    const double maps_ms = surfels * surfel_ms;
    return {.index = 0,
            .cpu_ms = 1.0,
            .gpu_ms = maps_ms + between_ms + others_ms,
            .waiting_surfels = waiting,
            .passes = {{"scene-gather", moves, 0.0, 0.0, Workload::other},
                       {"surfel-visibility", true, 1.0, between_ms, Workload::other},
                       {"vpl-maps", true, 1.0, maps_ms, Workload::other}}};
}

/// The limit after many frames on a machine with these times.
std::uint32_t limit_after(UpdateBudget budget, double surfel_ms, double others_ms) {
    for (int i = 0; i < 100; ++i) budget.learn(frame_of(budget.limit(), surfel_ms, others_ms, 1000));
    return budget.limit();
}

}  // namespace

TEST_CASE("as many surfels are traced as fit") {
    for (const double surfel_ms : {0.01, 0.3, 1.0}) {
        CAPTURE(surfel_ms);
        const std::uint32_t limit = limit_after(UpdateBudget(budget_ms), surfel_ms, 20.0);
        CHECK(limit * surfel_ms + 20.0 <= budget_ms);
        // All but one, as the limit is a whole number.
        CHECK((limit + 1) * surfel_ms + 20.0 >= budget_ms);
    }
}

TEST_CASE("light also follows where other passes take all the time, or surfels too much") {
    const std::uint32_t limit = limit_after(UpdateBudget(budget_ms), 1.0, 100.0);
    CHECK(limit >= 19);
    CHECK(limit <= 20);  // a third of the budget
    CHECK(limit_after(UpdateBudget(budget_ms), 1000.0, 0.0) >= 1);
}

TEST_CASE("at rest, maps take as long as what is not traced, and the picture is complete in few frames") {
    double others_ms = 0.0;
    SUBCASE("the others are shorter than a quarter of a second") {
        others_ms = 240.0;
    }
    SUBCASE("the others are longer") {
        others_ms = 500.0;
    }
    UpdateBudget budget(budget_ms);
    for (int i = 0; i < 100; ++i) budget.learn(frame_of(budget.limit(), 1.0, others_ms, 1000));
    const std::uint32_t moving = budget.limit();
    std::uint32_t waiting = 1000;
    int frames = 0;
    std::uint32_t most = 0;
    for (; waiting > 0 && frames < 10; ++frames) {
        most = std::max(most, budget.limit());
        waiting -= std::min(waiting, budget.limit());
        budget.learn(frame_of(budget.limit(), 1.0, others_ms, waiting, false));
    }
    CHECK(frames == 6);  // of 20 surfels, 80, three of 240 or 250, and the rest
    CHECK(most * 1.0 <= 250.0);
    CHECK(budget.limit() == moving);
}

TEST_CASE("at rest, the time between surfels makes no room for more of them") {
    UpdateBudget budget(budget_ms);
    for (int i = 0; i < 100; ++i) {
        const double between_ms = 2.0 * budget.limit();
        budget.learn(frame_of(budget.limit(), 1.0, 200.0, 1000, false, between_ms));
    }
    CHECK(budget.limit() == 200);
}

TEST_CASE("a frame that had less to trace changes nothing") {
    UpdateBudget budget(budget_ms);
    const std::uint32_t before = budget.limit();
    budget.learn(frame_of(1, 1.0, 0.0, 0));
    CHECK(budget.limit() == before);
    budget.learn({});
    CHECK(budget.limit() == before);
}

TEST_CASE("a configuration's own limit stays, and without a budget there is none") {
    Configuration configuration;
    CHECK(UpdateBudget(budget_ms).limited(configuration).vpls.updates > 0);
    CHECK(UpdateBudget().limited(configuration) == configuration);
    configuration.vpls.updates = 3;
    CHECK(UpdateBudget(budget_ms).limited(configuration) == configuration);
}

}  // TEST_SUITE("update budget")
