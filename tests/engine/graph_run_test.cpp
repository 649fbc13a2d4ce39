// Which passes run, frame by frame.

#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph run") {

namespace {

using namespace candela;

struct Light {
    int power = 0;
    bool operator==(const Light&) const = default;
};
struct Name {
    std::string text;
};

TEST_CASE_FIXTURE(
    GraphFixture,
    "graph run: if a component pool changes, its readers and the readers of their results run") {
    const Entity entity = world.create();
    world.set(entity, Light{1});
    const auto power = graph.add("gather", [&](Pass& pass) {
        pass.read<Light>();
        const auto written = pass.write(graph.value<int>("power"));
        pass.run([=](Execution& run) { run.set(written, run.world().get<Light>(entity).power); });
        return written;
    });
    const TextureHandle lit = graph.add("light", [&](Pass& pass) {
        pass.read(power);
        return pass.write(texture("lit"), Usage::colour_target);
    });
    const TextureHandle target = texture("target", Lifetime::imported);
    draw("show", {lit}, target);
    switch_to();
    runtime.bind(target, 77, colour);

    CHECK(run() == "gather light show");
    CHECK(run() == "show");
    world.set(entity, Name{"lamp"});  // a pool that no pass reads
    CHECK(run() == "show");
    world.set(entity, Light{2});
    CHECK(run() == "gather light show");
    CHECK(runtime.value(power) == 2);

    SUBCASE("an equal value leaves its readers clean") {
        world.set(entity, Light{3});
        world.set(entity, Light{2});
        CHECK(run() == "gather show");
    }
    SUBCASE("a copy of the world is the same until one of them changes") {
        World copy = world;
        CHECK(ran(runtime.run(copy)) == "show");
        copy.set(entity, Light{5});
        CHECK(ran(runtime.run(copy)) == "gather light show");
        CHECK(run() == "gather light show");
    }
    SUBCASE("another world in the same place is another world") {
        World other;
        REQUIRE(other.create() == entity);
        other.set(entity, Light{1});
        other.set(entity, Name{"lamp"});
        other.set(entity, Light{7});  // as many changes as the first world has seen
        world = other;
        CHECK(run() == "gather light show");
        CHECK(runtime.value(power) == 7);
    }
    SUBCASE("all passes run after invalidate()") {
        runtime.invalidate();
        CHECK(run() == "gather light show");
    }
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: the host need not provide imports that only culled passes read") {
    const auto exposure = graph.import_value<float>("exposure");
    const TextureHandle sky = texture("sky", Lifetime::imported);
    graph.add("unseen", [&](Pass& pass) {
        pass.read(exposure);
        pass.read(sky, Usage::sampled);
        (void)pass.write(graph.value<float>("mapped"));
    });
    graph.add("print", [&](Pass& pass) { pass.side_effect(); });
    switch_to();
    CHECK(run() == "print");
    runtime.set(exposure, 1.0F);  // allowed, without effect
    runtime.bind(sky, 9, colour);
    CHECK(run() == "print");
}

TEST_CASE_FIXTURE(
    GraphFixture,
    "graph run: imported values and objects must be provided before the first frame, and are kept") {
    const auto exposure = graph.import_value<float>("exposure");
    const TextureHandle target = texture("target", Lifetime::imported);
    const TextureHandle mapped = graph.add("tone-map", [&](Pass& pass) {
        pass.read(exposure);
        return pass.write(texture("mapped"), Usage::colour_target);
    });
    draw("show", {mapped}, target);
    CHECK_THROWS_WITH_AS(run(), "there is no frame graph", GraphError);
    CHECK_THROWS_WITH_AS(runtime.set(exposure, 1.0F), "there is no frame graph", GraphError);
    switch_to();
    CHECK_THROWS_WITH_AS(run(), "imported value 'exposure' has not been set", GraphError);
    runtime.set(exposure, 1.0F);
    CHECK_THROWS_WITH_AS(run(), "imported texture 'target' has not been bound", GraphError);
    runtime.bind(target, 77, colour);
    CHECK(run() == "tone-map show");
    runtime.set(exposure, 1.0F);
    CHECK(run() == "show");
    runtime.set(exposure, 2.0F);
    CHECK(run() == "tone-map show");
    CHECK(runtime.value(exposure) == 2.0F);

    CHECK_THROWS_WITH_AS(runtime.bind(mapped, 5, colour), "texture 'mapped' is not imported", GraphError);
    FrameGraph other;
    CHECK_THROWS_WITH_AS(runtime.set(other.import_value<int>("x"), 1),
                         "a handle is not of the current frame graph", GraphError);
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: binding an import counts as new content") {
    const TextureHandle sky = texture("sky", Lifetime::imported);
    const TextureHandle blurred = draw("blur", {sky}, texture("blurred"));
    graph.add("show", [&](Pass& pass) {
        pass.read(blurred, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.bind(sky, 9, colour);
    CHECK(run() == "blur show");
    CHECK(run() == "show");
    runtime.bind(sky, 9, colour);
    CHECK(run() == "blur show");
}

TEST_CASE_FIXTURE(
    GraphFixture,
    "graph run: a result overwritten in a shared object is not made again if no running pass reads it") {
    // "a" and "c" share an object, which holds "c" after a frame.
    const auto knob = graph.import_value<int>("knob");
    const TextureHandle a = draw("draw a", {}, texture("a"));
    const TextureHandle b = draw("draw b", {a}, texture("b"));
    const TextureHandle c = graph.add("draw c", [&](Pass& pass) {
        pass.read(b, Usage::sampled);
        return pass.write(texture("c"), Usage::colour_target);
    });
    const auto turn = graph.import_value<int>("turn");
    graph.add("show", [&](Pass& pass) {
        pass.read(c, Usage::sampled);
        pass.side_effect();
    });
    const TextureHandle late = graph.add("late", [&](Pass& pass) {
        pass.read(b, Usage::sampled);
        pass.read(knob);
        return pass.write(texture("late", Lifetime::persistent), Usage::colour_target);
    });
    graph.add("show late", [&](Pass& pass) {
        pass.read(late, Usage::sampled);
        pass.read(turn);
        pass.side_effect();
    });
    switch_to();
    runtime.set(knob, 1);
    runtime.set(turn, 1);
    CHECK(runtime.object(a) == runtime.object(c));
    CHECK(run() == "draw a draw b draw c show late show late");
    CHECK(run() == "show show late");  // their inputs are still there
    runtime.set(knob, 2);
    CHECK(run() == "show late show late");  // "b" is still there
}

TEST_CASE_FIXTURE(
    GraphFixture,
    "graph run: before a pass modifies a result in place, the pass that made the result runs again") {
    const auto knob = graph.import_value<int>("knob");
    const TextureHandle lit = draw("opaque", {}, texture("lit"));
    const TextureHandle both = graph.add("transparent", [&](Pass& pass) {
        pass.read(knob);
        return pass.write(lit, Usage::colour_target);
    });
    const TextureHandle mapped = draw("tone-map", {both}, texture("mapped"));
    graph.add("show", [&](Pass& pass) {
        pass.read(mapped, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.set(knob, 1);
    CHECK(run() == "opaque transparent tone-map show");
    CHECK(run() == "show");
    runtime.set(knob, 2);
    CHECK(run() == "opaque transparent tone-map show");
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph run: a pass that runs only to restore a result leaves its other readers clean") {
    // "peek" reads the first version of "lit", which "transparent" has overwritten.
    const auto knob = graph.import_value<int>("knob");
    const TextureHandle lit = draw("opaque", {}, texture("lit"));
    const TextureHandle seen = graph.add("peek", [&](Pass& pass) {
        pass.read(lit, Usage::sampled);
        pass.read(knob);
        return pass.write(texture("seen", Lifetime::persistent), Usage::colour_target);
    });
    const TextureHandle both = draw("transparent", {}, lit);
    const TextureHandle mapped = draw("tone-map", {both}, texture("mapped", Lifetime::persistent));
    graph.add("show", [&](Pass& pass) {
        pass.read(mapped, Usage::sampled);
        pass.read(seen, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.set(knob, 1);
    CHECK(run() == "opaque peek transparent tone-map show");
    CHECK(run() == "show");
    runtime.set(knob, 2);
    CHECK(run() == "opaque peek show");  // "mapped" stays valid, though "lit" is at its first version again
    CHECK(run() == "show");
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph run: a result is not restored for an in-place pass that turns out to be clean") {
    const auto knob = graph.import_value<int>("knob");
    const auto half = graph.add("halve", [&](Pass& pass) {
        pass.read(knob);
        const auto written = pass.write(graph.value<int>("half"));
        pass.run([=](Execution& run) { run.set(written, run.value(knob) / 2); });
        return written;
    });
    const TextureHandle first = draw("clear", {}, texture("lit", Lifetime::persistent));
    const TextureHandle both = graph.add("light", [&](Pass& pass) {
        pass.read(half);
        return pass.write(first, Usage::colour_target);
    });
    graph.add("show", [&](Pass& pass) {
        pass.read(both, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.set(knob, 2);
    CHECK(run() == "halve clear light show");
    runtime.set(knob, 3);
    CHECK(run() == "halve show");
    runtime.set(knob, 4);
    CHECK(run() == "halve clear light show");
    CHECK(run() == "show");
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph run: a value whose elements have no == counts as changed when it is set") {
    struct Plain {
        int value = 0;
    };
    const auto list = graph.import_value<std::vector<Plain>>("list");
    const auto size = graph.add("count", [&](Pass& pass) {
        pass.read(list);
        const auto written = pass.write(graph.value<std::size_t>("size"));
        pass.run([=](Execution& run) { run.set(written, run.value(list).size()); });
        return written;
    });
    graph.add("print", [&](Pass& pass) {
        pass.read(size);
        pass.side_effect();
    });
    switch_to();
    for (int times = 0; times < 2; ++times) {
        runtime.set(list, {{1}});
        CHECK(run() == "count print");
        CHECK(run() == "print");
    }
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: the runtime still works after a pass has thrown") {
    bool fail = false;
    const auto knob = graph.import_value<int>("knob");
    const TextureHandle a = draw("draw", {}, texture("a", Lifetime::persistent));
    const TextureHandle b = graph.add("filter", [&](Pass& pass) {
        pass.read(a, Usage::sampled);
        pass.read(knob);
        pass.run([&](Execution&) {
            if (fail) throw std::runtime_error("out of luck");
        });
        return pass.write(texture("b", Lifetime::persistent), Usage::colour_target);
    });
    graph.add("show", [&](Pass& pass) {
        pass.read(b, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.set(knob, 1);
    CHECK(run() == "draw filter show");
    fail = true;
    runtime.set(knob, 2);
    CHECK_THROWS_WITH_AS(run(), "out of luck", std::runtime_error);
    CHECK(backend.open_passes == 0);
    CHECK_THROWS_AS(run(), std::runtime_error);
    fail = false;
    runtime.set(knob, 1);  // the input of the last successful run
    CHECK(run() == "filter show");
    CHECK(run() == "show");
    CHECK(runtime.run(world).frame == 3);  // counts successful frames only
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: a frame that is abandoned goes on in the next run") {
    const auto knob = graph.import_value<int>("knob");
    const auto doubled = graph.add("double", [&](Pass& pass) {
        pass.read(knob);
        const auto written = pass.write(graph.value<int>("doubled"));
        pass.run([=](Execution& run) { run.set(written, 2 * run.value(knob)); });
        return written;
    });
    const auto squared = graph.add("square", [&](Pass& pass) {
        pass.read(doubled);
        const auto written = pass.write(graph.value<int>("squared"));
        pass.run([=](Execution& run) { run.set(written, run.value(doubled) * run.value(doubled)); });
        return written;
    });
    int shown = 0;
    graph.add("show", [&](Pass& pass) {
        pass.read(squared);
        pass.side_effect();
        pass.run([&, squared](Execution& run) { shown = run.value(squared); });
    });
    switch_to();
    const auto run_some = [&](int passes) {
        const FrameRecord& record = runtime.run(world, Timing::off, [&passes] { return passes-- > 0; });
        CHECK_FALSE(record.complete);
        CHECK(record.frame == 0);
        return ran(record);
    };
    runtime.set(knob, 3);
    CHECK(run_some(0) == "");
    CHECK(run_some(1) == "double");
    CHECK(run_some(1) == "square");
    CHECK(run_some(0) == "");
    CHECK(shown == 0);
    CHECK(run() == "show");
    CHECK(shown == 36);
    runtime.set(knob, 4);
    CHECK(ran(runtime.run(world, Timing::off, [&] { return runtime.value(doubled) != 8; })) == "double");
    runtime.set(knob, 5);
    CHECK(run() == "double square show");
    CHECK(shown == 100);
    // Nobody asks about passes that do not run.
    int asked = 0;
    const FrameRecord& last = runtime.run(world, Timing::off, [&] { return ++asked > 0; });
    CHECK(last.complete);
    CHECK(last.frame == 2);
    CHECK(asked == 1);
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: a pass that ends between its parts runs again") {
    const auto knob = graph.import_value<int>("knob");
    int parts = 0;
    bool had_result = false;
    bool could_end = false;
    const auto sum = graph.add("add up", [&](Pass& pass) {
        pass.read(knob);
        const auto written = pass.write(graph.value<int>("sum"));
        pass.run([&, knob, written](Execution& run) {
            had_result = run.has_result();
            could_end = run.may_end();
            run.set(written, 0);  // not complete
            for (parts = 0; parts < 3; ++parts) run.end_if_unwanted();
            run.set(written, 3 * run.value(knob));
        });
        return written;
    });
    int shown = 0;
    graph.add("show", [&](Pass& pass) {
        pass.read(sum);
        pass.side_effect();
        pass.run([&, sum](Execution& run) { shown = run.value(sum); });
    });
    switch_to();
    runtime.set(knob, 2);
    CHECK(run() == "add up show");
    CHECK_FALSE(could_end);
    runtime.set(knob, 3);
    int asked = 0;
    const FrameRecord& ended = runtime.run(world, Timing::off, [&] { return ++asked < 4; });
    CHECK_FALSE(ended.complete);
    CHECK(ran(ended) == "");
    CHECK(parts == 2);
    CHECK(had_result);
    CHECK(could_end);
    CHECK(run() == "add up show");
    CHECK_FALSE(had_result);
    CHECK(shown == 9);
}

TEST_CASE_FIXTURE(
    GraphFixture,
    "graph run: the back end is told passes, their targets, and also barriers of skipped passes") {
    const auto knob = graph.import_value<int>("knob");
    const auto traced = graph.add("trace", [&](Pass& pass) {
        pass.read(knob);
        return pass.write(graph.buffer<int>("hits", 4), Usage::storage);
    });
    const auto counted = graph.add("count", [&](Pass& pass) {
        pass.read(traced, Usage::storage);
        return pass.write(graph.buffer<int>("sum", 1), Usage::copy);
    });
    const TextureHandle target = texture("target", Lifetime::imported);
    const TextureHandle depth = graph.texture("depth", {colour.size, Format::depth32f}, Lifetime::imported);
    graph.add("show", [&](Pass& pass) {
        pass.read(counted, Usage::uniform);
        (void)pass.write(target, Usage::colour_target);
        (void)pass.write(depth, Usage::depth_target);
    });
    switch_to();
    runtime.bind(target, 70, colour);
    runtime.bind(depth, 71, {colour.size, Format::depth32f});
    runtime.set(knob, 1);
    (void)run();
    CHECK(backend.log == std::vector<std::string>{"barrier storage", "begin trace", "end", "barrier storage",
                                                  "begin count", "end", "begin show", "end"});
    CHECK(backend.targets.colour == std::vector<ObjectId>{70});
    CHECK(backend.targets.depth == 71);
    CHECK(backend.targets.writes_depth);
    CHECK(backend.targets.size == colour.size);
    backend.log.clear();
    (void)run();
    CHECK(backend.log == std::vector<std::string>{"barrier storage", "begin show", "end"});
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: a pass that only reads depth does not write it") {
    const TextureHandle depth = graph.add("draw", [&](Pass& pass) {
        return pass.write(graph.texture("depth", {colour.size, Format::depth32f}), Usage::depth_target);
    });
    graph.add("test", [&](Pass& pass) {
        pass.side_effect();
        pass.read(depth, Usage::depth_target);
    });
    switch_to();
    (void)run();
    CHECK(backend.targets.depth != 0);
    CHECK_FALSE(backend.targets.writes_depth);
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph run: held passes keep what they have written, and run once they are not held") {
    const auto power = graph.import_value<int>("power");
    const auto held = graph.import_value<bool>("held");
    const auto negated = [&] {
        const Scope scope = graph.scope({.held = held});
        const auto doubled = graph.add("double", [&](Pass& pass) {
            pass.read(power);
            const auto written = pass.write(graph.value<int>("doubled"));
            pass.run([=](Execution& run) { run.set(written, 2 * run.value(power)); });
            return written;
        });
        return graph.add("negate", [&](Pass& pass) {
            pass.read(doubled);
            const auto written = pass.write(graph.value<int>("negated"));
            pass.run([=](Execution& run) { run.set(written, -run.value(doubled)); });
            return written;
        });
    }();
    int shown = 0;
    graph.add("show", [&](Pass& pass) {
        pass.side_effect();
        pass.read(power);
        pass.read(negated);
        pass.run([=, &shown](Execution& run) { shown = run.value(negated); });
    });
    switch_to();
    runtime.set(power, 1);
    runtime.set(held, true);
    CHECK(run() == "double negate show");  // what has never run cannot stay
    runtime.set(power, 2);
    CHECK(run() == "show");
    CHECK(shown == -2);
    runtime.set(held, false);
    CHECK(run() == "double negate show");
    CHECK(shown == -4);
    runtime.set(held, true);
    CHECK(run() == "show");
    runtime.set(held, false);
    CHECK(run() == "show");  // nothing has changed meanwhile

    SUBCASE("after an invalidation all of them run") {
        runtime.set(held, true);
        runtime.invalidate();
        CHECK(run() == "double negate show");
    }
}

TEST_CASE_FIXTURE(GraphFixture, "graph run: CPU time is measured only if requested") {
    graph.add("work", [&](Pass& pass) {
        pass.side_effect();
        pass.run([](Execution&) {
            const auto start = std::chrono::steady_clock::now();
            while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(2)) {
            }
        });
    });
    switch_to();
    CHECK(runtime.run(world).passes.front().cpu_ms == 0.0);
    CHECK(runtime.run(world, Timing::on).passes.front().cpu_ms >= 2.0);
}

TEST_CASE_FIXTURE(GraphFixture, "the record carries what the host says about passes") {
    enum class Room : std::uint8_t { kitchen, bath = 7 };
    const auto work = [&](std::string_view name, std::optional<Room> room) {
        graph.add(name, [&](Pass& pass) {
            pass.side_effect();
            if (room) {
                pass.note(Room::kitchen);
                pass.note(*room);
            }
        });
    };
    work("wash", Room::bath);
    work("sleep", std::nullopt);
    switch_to();
    const auto& passes = runtime.run(world).passes;
    REQUIRE(std::any_cast<Room>(passes[0].note) != nullptr);
    CHECK(*std::any_cast<Room>(passes[0].note) == Room::bath);
    CHECK(passes[1].note == nullptr);
}

}  // namespace

}  // TEST_SUITE("graph run")
