// Keys, by which a runtime finds in another graph what it has.

#include <doctest/doctest.h>

#include <string>
#include <string_view>
#include <vector>

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
        const ValueHandle<int> next = [&] {
            const Scope scope = graph.scope({.name_ending = " (next)"});
            return make(1 - place);
        }();
        graph.add("show", [&](Pass& pass) {
            pass.side_effect();
            pass.read(shown);
            pass.read(next);
            pass.run([=, this](Execution& run) { shown_ = {run.value(shown), run.value(next)}; });
        });
        switch_to();
    }

    ValueHandle<int> make(int place) {
        const Scope scope = graph.scope({.key_ending = place == 0 ? "" : " (odd)"});
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

TEST_CASE_FIXTURE(GraphFixture,
                  "a scope ends where its object does, and the ending of an inner one comes first") {
    {
        const Scope outer = graph.scope({.name_ending = " 2"});
        {
            const Scope inner = graph.scope({.name_ending = " (mirrored)"});
            draw("draw", {}, texture("a"));
        }
        draw("draw", {}, texture("a"));
    }
    draw("draw", {}, texture("a"));
    CHECK(graph.pass_names() == std::vector<std::string_view>{"draw (mirrored) 2", "draw 2", "draw"});
}

TEST_CASE_FIXTURE(GraphFixture, "a key that two passes or two kept resources have is an error") {
    const auto declare = [&](std::string_view key, std::string_view second, Lifetime lifetime) {
        const Scope keys = graph.scope({.key_ending = key});
        draw("draw", {}, texture("a", lifetime));
        const Scope names = graph.scope({.name_ending = " 2"});
        draw(second, {}, texture("a", lifetime));
    };
    SUBCASE("passes") {
        declare(" (odd)", "draw", Lifetime::transient);
        CHECK(error_of(std::move(graph)) == "two passes have the key 'draw (odd)'");
    }
    SUBCASE("resources") {
        declare("", "draw again", Lifetime::persistent);
        CHECK(error_of(std::move(graph)) == "two textures that are kept or imported have the key 'a'");
    }
    SUBCASE("transients have none") {
        declare("", "draw again", Lifetime::transient);
        CHECK(compile(std::move(graph)).errors.empty());
    }
}

}  // TEST_SUITE("graph keys")
