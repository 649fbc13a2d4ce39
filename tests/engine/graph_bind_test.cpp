// Resources are bound where passes have declared them, before each pass runs.

#include <doctest/doctest.h>

#include <utility>

#include "tests/engine/graph_fixture.hpp"

namespace candela {

TEST_SUITE("graph: binding") {
namespace {

class Binds : public GraphFixture {
 protected:
    /// The object that was bound last with this usage at this point; 0: none.
    [[nodiscard]] ObjectId bound(Usage usage, std::uint32_t point = Binding::unbound) const {
        ObjectId found = 0;
        for (const auto& [object, binding] : backend.bound) {
            if (binding.usage == usage && binding.point == point) found = object;
        }
        return found;
    }
};

}  // namespace

TEST_CASE_FIXTURE(Binds, "each resource is bound where the pass has declared it") {
    const auto numbers = graph.add("numbers", [&](Pass& pass) {
        return pass.write(graph.buffer<int>("numbers", 4), {Usage::storage, 7});
    });
    const TextureHandle picture = draw("picture", {}, texture("picture"));
    graph.add("reader", [&](Pass& pass) {
        pass.read(numbers, {Usage::uniform, 1});
        pass.read(numbers, Usage::indirect);
        pass.read(picture, {Usage::sampled, 3});
        pass.side_effect();
        pass.run([=, this](Execution& run) {
            CHECK(bound(Usage::uniform, 1) == run.object(numbers));
            CHECK(bound(Usage::indirect) == run.object(numbers));
            CHECK(bound(Usage::sampled, 3) == run.object(picture));
            CHECK(backend.bound.size() == 3);
        });
    });
    switch_to();
    CHECK(run() == "numbers picture reader");
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Binds, "a usage without a binding point binds nothing") {
    const TextureHandle picture = draw("picture", {}, texture("picture"));
    graph.add("reader", [&](Pass& pass) {
        pass.read(picture, Usage::sampled);
        pass.side_effect();
        pass.run([this](Execution&) { CHECK(backend.bound.empty()); });
    });
    switch_to();
    CHECK(run() == "picture reader");
}

TEST_CASE_FIXTURE(Binds, "an object that the pass replaces is bound again") {
    graph.add("grows", [&](Pass& pass) {
        const auto list = pass.write(graph.buffer<int>("list", 1, Lifetime::persistent), {Usage::storage, 2});
        const auto map = pass.write(graph.texture("map", colour, Lifetime::persistent), {Usage::storage, 5});
        pass.side_effect();
        pass.run([=, this](Execution& run) {
            const ObjectId small = run.object(list);
            CHECK(bound(Usage::storage, 2) == small);
            run.reserve(list, 100);
            CHECK(run.object(list) != small);
            CHECK(bound(Usage::storage, 2) == run.object(list));
            run.reserve(map, {{2, 2}, Format::r32f});
            CHECK(bound(Usage::storage, 5) == run.object(map));
        });
    });
    switch_to();
    CHECK(run() == "grows");
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Binds, "a binding point for a usage that has none is an error") {
    graph.add("draws", [&](Pass& pass) {
        static_cast<void>(pass.write(texture("picture"), {Usage::colour_target, 1}));
        pass.side_effect();
    });
    const CompileResult result = compile(std::move(graph));
    REQUIRE(result.errors.size() == 1);
    CHECK(result.errors[0].message ==
          "pass 'draws' writes texture 'picture' as colour target, for which there are no binding points");
}
}  // TEST_SUITE("graph: binding")

}  // namespace candela
