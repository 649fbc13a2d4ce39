// Systems: passes that change components and entities of the world.

#include <doctest/doctest.h>

#include <optional>
#include <string>
#include <vector>

#include <candela/graph/describe.hpp>
#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph system") {

namespace {

using namespace candela;

struct Speed {
    float value = 0.0F;
    bool operator==(const Speed&) const = default;
};
struct Place {
    float value = 0.0F;
    bool operator==(const Place&) const = default;
};
struct Box {
    float least = 0.0F;
    bool operator==(const Box&) const = default;
};

struct Systems : GraphFixture {
    Systems() {
        world.set(entity, Speed{2.0F});
        world.set(entity, Place{});
    }

    void run_frame(float time) {
        runtime.set(seconds, time);
        last = run();
    }

    /// Place = Speed * seconds.
    void add_motion() {
        graph.add("motion", [&](Pass& pass) {
            pass.read(seconds);
            pass.read<Speed>();
            pass.write<Place>();
            pass.run([this](Execution& run) {
                for (const auto& [moved, speed] : run.world().view<Speed>()) {
                    run.world().set(moved, Place{speed.value * run.value(seconds)});
                }
            });
        });
    }
    /// Box = Place - 1.
    void add_bounds() {
        graph.add("bounds", [&](Pass& pass) {
            pass.read<Place>();
            pass.write<Box>();
            pass.run([](Execution& run) {
                for (const auto& [bounded, place] : run.world().view<Place>()) {
                    run.world().set(bounded, Box{place.value - 1.0F});
                }
            });
        });
    }
    /// A pass that does nothing, and declares what it is told to.
    template <class Declare>
    void add_pass(std::string_view name, Declare declare) {
        graph.add(name, [&](Pass& pass) { declare(pass); });
    }

    Entity entity = world.create();
    ValueHandle<float> seconds = graph.import_value<float>("seconds");
    std::string last;  // names of the passes that ran
};

TEST_CASE_FIXTURE(Systems,
                  "graph system: later passes see the change in the same frame, and only changes run") {
    add_motion();
    add_bounds();
    switch_to();
    run_frame(1.0F);
    CHECK(last == "motion bounds");
    CHECK(world.get<Place>(entity) == Place{2.0F});
    CHECK(world.get<Box>(entity) == Box{1.0F});
    run_frame(1.0F);
    CHECK(last.empty());
    run_frame(3.0F);
    CHECK(world.get<Box>(entity) == Box{5.0F});
    world.set(entity, Speed{0.0F});
    run_frame(3.0F);
    CHECK(world.get<Box>(entity) == Box{-1.0F});
    run_frame(4.0F);  // at speed 0 nothing moves, so that no bounds change
    CHECK(last == "motion");
}

TEST_CASE_FIXTURE(Systems,
                  "graph system: passes that are declared earlier see the change in the next frame") {
    add_bounds();
    add_motion();
    switch_to();
    run_frame(1.0F);
    CHECK(world.get<Box>(entity) == Box{-1.0F});
    run_frame(1.0F);
    CHECK(last == "bounds");
    CHECK(world.get<Box>(entity) == Box{1.0F});
}

TEST_CASE_FIXTURE(Systems, "graph system: what a system writes stays, whoever changes it meanwhile") {
    add_motion();
    add_pass("teleport", [&](Pass& pass) {
        pass.read<Box>();
        pass.write<Place>();
        pass.run([this](Execution& run) {
            if (const Box* box = run.world().find<Box>(entity)) run.world().set(entity, Place{box->least});
        });
    });
    switch_to();
    run_frame(1.0F);
    CHECK(world.get<Place>(entity) == Place{2.0F});
    world.set(entity, Place{7.0F});
    run_frame(1.0F);
    CHECK(world.get<Place>(entity) == Place{2.0F});
    world.set(entity, Box{40.0F});
    run_frame(1.0F);  // the last one to write wins
    CHECK(world.get<Place>(entity) == Place{40.0F});
    run_frame(2.0F);
    CHECK(world.get<Place>(entity) == Place{40.0F});
}

TEST_CASE_FIXTURE(
    Systems, "graph system: a system that changes components in place runs as often as its time changes") {
    add_pass("integrate", [&](Pass& pass) {
        pass.read(seconds);
        pass.read<Speed>();
        pass.read<Place>();
        pass.write<Place>();
        pass.run([this](Execution& run) {
            run.world().edit<Place>(
                entity, [&](Place& place) { place.value += run.world().get<Speed>(entity).value; });
        });
    });
    switch_to();
    for (const float time : {1.0F, 2.0F, 2.0F, 3.0F}) {
        run_frame(time);
    }
    CHECK(world.get<Place>(entity) == Place{6.0F});
}

TEST_CASE_FIXTURE(Systems, "graph system: entities come and go") {
    add_pass("spawn", [&](Pass& pass) {
        pass.read(seconds);
        pass.write_entities();
        pass.write<Speed>();
        pass.run([this](Execution& run) {
            if (run.value(seconds) < 2.0F) return run.world().set(run.world().create(), Speed{5.0F});
            run.world().destroy(entity);
        });
    });
    add_motion();
    switch_to();
    run_frame(1.0F);
    CHECK(last == "spawn motion");
    CHECK(world.count<Place>() == 2);
    run_frame(2.0F);
    CHECK_FALSE(world.alive(entity));
    CHECK(world.count<Place>() == 1);
}

TEST_CASE_FIXTURE(Systems, "graph system: a frame that was abandoned goes on with what changed") {
    add_motion();
    add_bounds();
    switch_to();
    runtime.set(seconds, 1.0F);
    int passes = 1;
    CHECK_FALSE(runtime.run(world, Timing::off, [&] { return passes-- > 0; }).complete);
    CHECK_FALSE(world.has<Box>(entity));
    world.set(entity, Speed{4.0F});
    run_frame(1.0F);
    CHECK(world.get<Box>(entity) == Box{3.0F});
}

TEST_CASE_FIXTURE(Systems, "graph system: another graph with the same systems does not run them again") {
    add_motion();
    add_bounds();
    switch_to();
    run_frame(1.0F);
    graph = {};
    seconds = graph.import_value<float>("seconds");
    add_motion();
    graph.add("other", [](Pass& pass) { pass.side_effect(); });
    add_bounds();
    switch_to();
    CHECK(run() == "other");
}

std::string error_of(Systems& systems, std::string_view name, void (*act)(Execution&, Entity)) {
    systems.add_pass(name, [&](Pass& pass) {
        pass.read<Place>();
        pass.write<Box>();
        pass.run([&systems, act](Execution& run) { act(run, systems.entity); });
    });
    systems.switch_to();
    systems.runtime.invalidate();
    try {
        (void)systems.run();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST_CASE_FIXTURE(Systems, "graph system: what was not declared is an error that names pass and type") {
    const auto check = [&](std::string_view expected, void (*act)(Execution&, Entity)) {
        graph = {};
        seconds = graph.import_value<float>("seconds");
        CHECK(error_of(*this, "meddle", act) == expected);
    };
    check("", [](Execution& run, Entity whose) { run.world().set(whose, Box{}); });
    const std::string changes = "pass 'meddle' changes Place components without having declared it";
    check(changes, [](Execution& run, Entity whose) { run.world().set(whose, Place{}); });
    check(changes, [](Execution& run, Entity whose) { run.world().edit<Place>(whose, [](Place&) {}); });
    check(changes, [](Execution& run, Entity whose) { run.world().remove<Place>(whose); });
    const std::string entities = "pass 'meddle' creates or destroys entities without having declared it";
    const std::string reads = "pass 'meddle' reads Speed components without having declared it";
    check(reads, [](Execution& run, Entity whose) { (void)run.world().find<Speed>(whose); });
    check(reads, [](Execution& run, Entity) { (void)run.world().view<Place, Speed>(); });
    check(entities, [](Execution& run, Entity) { (void)run.world().create(); });
    check(entities, [](Execution& run, Entity whose) { run.world().destroy(whose); });
    CHECK(world.has<Place>(entity));
}

TEST_CASE_FIXTURE(Systems, "graph system: a world that is const cannot be run with systems") {
    add_motion();
    switch_to();
    runtime.set(seconds, 1.0F);
    const World& fixed = world;
    CHECK_THROWS_WITH_AS(runtime.run(fixed),
                         "pass 'motion' changes the world, which is run with one that is const", GraphError);
}

TEST_CASE_FIXTURE(Systems,
                  "graph system: a runtime without a back end runs them, and has no room for textures") {
    add_motion();
    GraphRuntime systems;
    systems.switch_to(compile(std::move(graph)).take());
    systems.set(seconds, 2.0F);
    CHECK(ran(systems.run(world)) == "motion");
    CHECK(world.get<Place>(entity) == Place{4.0F});
    FrameGraph drawing;
    drawing.add("draw", [&](Pass& pass) {
        (void)pass.write(drawing.texture("picture", colour), Usage::storage);
        pass.side_effect();
    });
    CHECK_THROWS_WITH_AS(systems.switch_to(compile(std::move(drawing)).take()),
                         "the runtime has no back end for 'picture'", GraphError);
    CHECK(systems.graph()->pass_count() == 1);
}

TEST_CASE_FIXTURE(Systems,
                  "graph system: verification neither runs systems again nor blames who read before them") {
    runtime.set_verification(true);
    int reads = 0;
    graph.add("watch", [&](Pass& pass) {
        pass.read<Place>();
        const auto seen = pass.write(graph.value<float>("seen"));
        pass.run([&, seen](Execution& run) {
            ++reads;
            run.set(seen, run.world().get<Place>(entity).value);
        });
        pass.side_effect();
    });
    add_motion();
    switch_to();
    run_frame(1.0F);
    runtime.verify(world);
    CHECK(reads == 1);
    CHECK(world.get<Place>(entity) == Place{2.0F});
}

TEST_CASE_FIXTURE(Systems, "graph system: a pass can be put after another one by name") {
    const auto order = [&](bool says_after) {
        graph = {};
        const auto buffer = graph.add(
            "write", [&](Pass& pass) { return pass.write(graph.buffer<int>("numbers", 1), Usage::storage); });
        add_pass("wait", [&](Pass& pass) {
            pass.read(buffer, Usage::storage);
            (void)pass.write(graph.texture("target", colour, Lifetime::imported), Usage::copy);
        });
        add_pass("free", [&](Pass& pass) {
            if (says_after) pass.after("wait");
            (void)pass.write(graph.texture("other", colour, Lifetime::imported), Usage::copy);
        });
        std::string names;
        for (const DescribedPass& pass : describe(compile(std::move(graph)).take()).passes) {
            names += pass.name + " ";
        }
        return names;
    };
    CHECK(order(false) == "write free wait ");  // "wait" needs a barrier
    CHECK(order(true) == "write wait free ");

    graph = {};
    add_pass("lost", [](Pass& pass) { pass.after("nobody"); });
    CHECK(compile(std::move(graph)).errors ==
          std::vector<CompileError>{
              {ErrorCode::unknown_pass,
               "pass 'lost' is to run after pass 'nobody', which was not declared before it"}});
}

TEST_CASE_FIXTURE(Systems,
                  "graph system: two writers of a type are ambiguous unless somebody says who is first") {
    const auto ambiguities = [&](auto declare_second) {
        graph = {};
        const auto number = graph.add("first", [&](Pass& pass) {
            pass.write<Place>();
            return pass.write(graph.value<int>("number"));
        });
        const auto passed_on = graph.add("between", [&](Pass& pass) {
            pass.read(number);
            return pass.write(graph.value<int>("passed on"));
        });
        add_pass("second", [&](Pass& pass) {
            pass.write<Place>();
            declare_second(pass, passed_on);
        });
        return find_ambiguities(compile(std::move(graph)).take());
    };
    const std::vector<Ambiguity> none;
    const std::vector<Ambiguity> places{{"Place", "first", "second"}};
    CHECK(ambiguities([](Pass&, ValueHandle<int>) {}) == places);
    CHECK(ambiguities([](Pass& pass, ValueHandle<int>) { pass.read<Speed>(); }) == places);
    CHECK(ambiguities([](Pass& pass, ValueHandle<int>) { pass.read<Place>(); }) == none);
    CHECK(ambiguities([](Pass& pass, ValueHandle<int>) { pass.after("first"); }) == none);
    CHECK(ambiguities([](Pass& pass, ValueHandle<int> number) { pass.read(number); }) == none);
}

TEST_CASE_FIXTURE(Systems, "graph system: the description says which passes follow systems, and why") {
    add_motion();
    add_bounds();
    add_pass("teleport", [](Pass& pass) {
        pass.write_entities();
        pass.after("motion");
        pass.side_effect();
    });
    add_pass("print", [](Pass& pass) { pass.side_effect(); });
    const GraphDescription description = describe(compile(std::move(graph)).take());
    using enum DependencyKind;
    CHECK(description.edges == std::vector<DescribedEdge>{{0, 1, component_result, {"Place"}},
                                                          {0, 2, component_overwrite, {"Speed", "Place"}},
                                                          {0, 2, after, {}},
                                                          {1, 2, component_overwrite, {"Place", "Box"}},
                                                          {2, 3, side_effect, {}}});
    CHECK(description.passes[0].components ==
          std::vector<DescribedComponent>{{"Speed", false}, {"Place", true}});
    CHECK(description.passes[2].writes_entities);
}

}  // namespace

}  // TEST_SUITE("graph system")
