// Keys, by which a runtime finds in another graph what it has.

#include <doctest/doctest.h>

#include <string>

#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph keys") {

namespace {

using namespace candela;

/// Two values take turns: one is shown, the other is prepared.
struct TurnFixture : GraphFixture {
    /// Switches to a graph in which that of `place` is shown.
    void show(int place) {
        graph = FrameGraph();
        const ValueHandle<int> shown = make(place);
        graph.append_to_names(" (next)");
        const ValueHandle<int> next = make(1 - place);
        graph.append_to_names("");
        graph.append_to_keys(std::nullopt);
        graph.add("show", [&](Pass& pass) {
            pass.side_effect();
            pass.read(shown);
            pass.read(next);
            pass.run([=, this](Execution& run) { shown_ = {run.value(shown), run.value(next)}; });
        });
        switch_to();
    }

    ValueHandle<int> make(int place) {
        graph.append_to_keys(place == 0 ? "" : " (odd)");
        const TextureHandle drawn = draw("draw", {}, texture("picture", Lifetime::persistent));
        return graph.add("make", [&](Pass& pass) {
            pass.read(drawn, Usage::sampled);
            const auto made = pass.write(graph.value<int>("made"));
            pass.run([=, this](Execution& run) {
                objects_[place] = run.object(drawn);
                run.set(made, ++count_);
            });
            return made;
        });
    }

    std::pair<int, int> shown_;
    ObjectId objects_[2]{};
    int count_ = 0;
};

std::string error_of(FrameGraph graph) {
    const CompileResult result = compile(std::move(graph));
    REQUIRE(result.errors.size() == 1);
    return result.errors.front().message;
}

}  // namespace

TEST_CASE_FIXTURE(TurnFixture, "what takes its turn has another name, and is as it was made") {
    show(0);
    CHECK(run() == "draw make draw (next) make (next) show");
    CHECK(shown_ == std::pair(1, 2));
    for (const int place : {1, 0, 1, 1}) {
        CAPTURE(place);
        show(place);
        CHECK(run() == "show");
        CHECK(shown_ == (place == 0 ? std::pair(1, 2) : std::pair(2, 1)));
    }
    runtime.invalidate();
    const ObjectId first = objects_[0];
    const ObjectId second = objects_[1];
    CHECK(first != second);
    show(0);
    static_cast<void>(run());
    CHECK(objects_[0] == first);
    CHECK(objects_[1] == second);
}

TEST_CASE_FIXTURE(GraphFixture, "a key that two passes or two kept resources have is an error") {
    SUBCASE("passes") {
        graph.append_to_keys(" (odd)");
        draw("draw", {}, texture("a"));
        graph.append_to_names(" 2");
        draw("draw", {}, texture("b"));
        CHECK(error_of(std::move(graph)) == "two passes have the key 'draw (odd)'");
    }
    SUBCASE("resources") {
        graph.append_to_keys("");
        draw("first", {}, texture("a", Lifetime::persistent));
        graph.append_to_names(" 2");
        draw("second", {}, texture("a", Lifetime::persistent));
        CHECK(error_of(std::move(graph)) == "two textures that are kept or imported have the key 'a'");
    }
    SUBCASE("transients have none") {
        graph.append_to_keys("");
        draw("first", {}, texture("a"));
        graph.append_to_names(" 2");
        draw("second", {}, texture("a"));
        CHECK(compile(std::move(graph)).errors.empty());
    }
}

}  // TEST_SUITE("graph keys")
