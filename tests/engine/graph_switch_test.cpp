// Switching from one graph to the next: what is kept, what is dropped, and what a failure leaves behind.

#include <doctest/doctest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph switch") {

namespace {

using namespace candela;

struct Light {
    int power = 0;
};

/// A configuration of the graph below: a light's shadow map, which is persistent, is drawn from a transient
/// texture, and the picture is shaded by one of two paths.
struct Configuration {
    int map_size = 8;
    int bias = 1;
    bool deferred = false;
    glm::uvec2 target_size{64, 32};
    bool bad = false;
};

struct Handles {
    TextureHandle target;
    TextureHandle shadow_map;
    ValueHandle<int> lights;
    ValueHandle<int> exposure;
};

struct Declared {
    FrameGraph graph;
    Handles handles;
};

Declared declare(const Configuration& configuration) {
    Declared declared;
    FrameGraph& graph = declared.graph;
    Handles& handles = declared.handles;
    handles.target = graph.texture("target", {configuration.target_size}, Lifetime::imported);
    handles.exposure = graph.import_value<int>("exposure");
    handles.lights = graph.add("gather", [&](Pass& pass) {
        pass.read<Light>();
        const auto lights = pass.write(graph.value<int>("lights"));
        pass.run([=](Execution& run) { run.set(lights, static_cast<int>(run.world().count<Light>())); });
        return lights;
    });
    const TextureHandle casters = graph.add("casters", [&](Pass& pass) {
        pass.read(handles.lights);
        return pass.write(graph.texture("casters", {{64, 32}, Format::r32f}), Usage::storage);
    });
    const TextureDesc map{glm::uvec2(static_cast<unsigned>(configuration.map_size)), Format::depth32f};
    handles.shadow_map = graph.add("shadow-maps", [&](Pass& pass) {
        pass.read(casters, Usage::sampled);
        pass.parameter(configuration.bias);
        return pass.write(graph.texture("shadow-map", map, Lifetime::persistent), Usage::depth_target);
    });
    const TextureDesc lit_desc{configuration.target_size, Format::rgba16f};
    TextureHandle lit;
    if (configuration.deferred) {
        const TextureHandle albedo = graph.add("gbuffer", [&](Pass& pass) {
            return pass.write(graph.texture("albedo", lit_desc), Usage::colour_target);
        });
        lit = graph.add("deferred", [&](Pass& pass) {
            pass.read(albedo, Usage::sampled);
            pass.read(handles.shadow_map, Usage::sampled);
            return pass.write(graph.texture("lit", lit_desc), Usage::colour_target);
        });
    } else {
        lit = graph.add("forward", [&](Pass& pass) {
            pass.read(handles.shadow_map, Usage::sampled);
            return pass.write(graph.texture("lit", lit_desc), Usage::colour_target);
        });
    }
    graph.add("tone-map", [&](Pass& pass) {
        pass.read(lit, Usage::sampled);
        pass.read(handles.exposure);
        (void)pass.write(handles.target, Usage::colour_target);
        if (configuration.bad) pass.read(graph.value<int>("never set"));
    });
    return declared;
}

struct Fixture {
    RecordingBackend backend;
    GraphRuntime runtime{backend};
    World world;
    Handles handles;

    void switch_to(const Configuration& configuration) {
        Declared declared = declare(configuration);
        runtime.switch_to(compile(std::move(declared.graph)).take());
        handles = declared.handles;
        runtime.bind(handles.target, 1000, {configuration.target_size});
    }
    std::string run() { return ran(runtime.run(world)); }
    void start() {
        switch_to({});
        runtime.set(handles.exposure, 1);
        CHECK(run() == "gather casters shadow-maps forward tone-map");
        CHECK(run() == "tone-map");
    }
};

TEST_CASE_FIXTURE(Fixture, "graph switch: another shading path keeps the shadow maps and the host's values") {
    start();
    const ObjectId map = runtime.object(handles.shadow_map);
    switch_to({.deferred = true});
    CHECK(runtime.object(handles.shadow_map) == map);
    CHECK(runtime.value(handles.lights) == 0);
    CHECK(run() == "gbuffer deferred tone-map");
    CHECK(run() == "tone-map");
    world.set(world.create(), Light{});
    CHECK(run() == "gather casters shadow-maps deferred tone-map");
}

TEST_CASE_FIXTURE(Fixture, "graph switch: a pass runs if its parameter has changed, but not if it is equal") {
    start();
    switch_to({.bias = 2});
    CHECK(run() == "shadow-maps forward tone-map");
    switch_to({.bias = 2});
    CHECK(run() == "tone-map");
}

TEST_CASE_FIXTURE(Fixture,
                  "graph switch: transients stay as far as nothing else was put into their objects") {
    // "first" and "third" share an object unless "show" reads both.
    const auto show = [&](bool looks) {
        FrameGraph graph;
        const auto fill = [&](std::string_view name, std::optional<TextureHandle> source) {
            return graph.add(name, [&](Pass& pass) {
                if (source) pass.read(*source, Usage::sampled);
                return pass.write(graph.texture(name, {{8, 8}}), Usage::storage);
            });
        };
        const TextureHandle first = fill("first", {});
        const TextureHandle second = fill("second", first);
        const TextureHandle third = fill("third", second);
        graph.add("show", [&](Pass& pass) {
            pass.side_effect();
            pass.read(third, Usage::sampled);
            if (looks) pass.read(first, Usage::sampled);
        });
        runtime.switch_to(compile(std::move(graph)).take());
    };
    show(false);
    CHECK(run() == "first second third show");
    CHECK(run() == "show");
    show(false);
    CHECK(run() == "show");
    CHECK(backend.objects.size() == 2);
    show(true);
    CHECK(run() == "first show");  // "third" is where "first" was
    show(true);
    CHECK(run() == "show");
    show(false);
    CHECK(run() == "show");
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Fixture, "graph switch: a resource with another description is a new resource") {
    start();
    switch_to({.map_size = 16});
    CHECK(backend.objects.at(runtime.object(handles.shadow_map)).texture.size == glm::uvec2(16));
    CHECK(run() == "shadow-maps forward tone-map");
}

TEST_CASE_FIXTURE(Fixture, "graph switch: changes of the world between two graphs are seen") {
    start();
    world.set(world.create(), Light{});
    switch_to({.deferred = true});
    CHECK(run() == "gather casters gbuffer shadow-maps deferred tone-map");
}

TEST_CASE_FIXTURE(Fixture,
                  "graph switch: an imported object must be bound again, and not with its old handle") {
    start();
    const TextureHandle old_target = handles.target;
    Declared declared = declare({});
    runtime.switch_to(compile(std::move(declared.graph)).take());
    CHECK_THROWS_WITH_AS(run(), "imported texture 'target' has not been bound", GraphError);
    CHECK_THROWS_WITH_AS(runtime.bind(old_target, 1000, {}), "a handle is not of the current frame graph",
                         GraphError);
}

TEST_CASE_FIXTURE(Fixture, "graph switch: a graph that does not compile leaves the running graph unchanged") {
    start();
    const std::size_t objects = backend.objects.size();
    const CompileResult result = compile(declare({.deferred = true, .bad = true}).graph);
    CHECK_FALSE(result);
    CHECK(run() == "tone-map");
    CHECK(backend.objects.size() == objects);
}

TEST_CASE_FIXTURE(Fixture, "graph switch: a back end that fails leaves the running graph unchanged") {
    start();
    const std::size_t objects = backend.objects.size();
    for (std::size_t creations = 0; creations < 3; ++creations) {
        backend.creations_left = creations;
        Declared declared = declare({.map_size = 32, .deferred = true, .target_size = {128, 128}});
        CHECK_THROWS_WITH_AS(runtime.switch_to(compile(std::move(declared.graph)).take()), "out of memory",
                             std::runtime_error);
        CHECK(backend.objects.size() == objects);
        CHECK(run() == "tone-map");
    }
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Fixture, "graph switch: switching back and forth creates nothing after the first round") {
    start();
    switch_to({.deferred = true});
    (void)run();
    switch_to({});
    (void)run();
    const std::size_t created = backend.created;
    const std::size_t objects = backend.objects.size();
    const MemoryUse memory = runtime.memory();
    for (int time = 0; time < 500; ++time) {
        switch_to({.deferred = true});
        (void)run();
        switch_to({});
        (void)run();
    }
    CHECK(backend.created == created);
    CHECK(backend.objects.size() == objects);
    CHECK(runtime.memory().texture_bytes == memory.texture_bytes);
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Fixture, "graph switch: after 200 target sizes there are as many objects as after one") {
    start();
    const std::size_t objects = backend.objects.size();
    for (unsigned size = 1; size <= 200; ++size) {
        switch_to({.target_size = {size, 200 - size / 2}});
        CHECK(run() == "forward tone-map");
        CHECK(backend.objects.size() <= 2 * objects);
    }
    switch_to({});
    switch_to({});  // destroys what the first did not take from the free pool
    CHECK(backend.objects.size() == objects);
    CHECK(backend.misuse.empty());
}

TEST_CASE("graph switch: a destroyed runtime leaves no objects") {
    RecordingBackend backend;
    {
        GraphRuntime runtime(backend);
        runtime.switch_to(compile(declare({}).graph).take());
        runtime.switch_to(compile(declare({.deferred = true}).graph).take());
        CHECK(!backend.objects.empty());
    }
    CHECK(backend.objects.empty());
    CHECK(backend.misuse.empty());
}

TEST_CASE("graph memory: bytes saved by sharing and bytes in the free pool are reported") {
    RecordingBackend backend;
    GraphRuntime runtime(backend);
    const auto chain = [](std::size_t length) {
        FrameGraph graph;
        TextureHandle last;
        for (std::size_t index = 0; index < length; ++index) {
            last = graph.add("draw " + std::to_string(index), [&](Pass& pass) {
                if (index > 0) pass.read(last, Usage::sampled);
                if (index + 1 == length) pass.side_effect();
                return pass.write(graph.texture("image", colour), Usage::colour_target);
            });
        }
        return compile(std::move(graph)).take();
    };
    const std::uint64_t bytes = 64 * 32 * 8;
    runtime.switch_to(chain(5));
    CHECK(runtime.memory().texture_bytes == 2 * bytes);
    CHECK(runtime.memory().shared_by_aliasing_bytes == 3 * bytes);
    CHECK(runtime.memory().free_pool_bytes == 0);
    runtime.switch_to(chain(1));
    CHECK(runtime.memory().texture_bytes == 2 * bytes);
    CHECK(runtime.memory().free_pool_bytes == bytes);
    runtime.switch_to(chain(1));
    CHECK(runtime.memory().texture_bytes == bytes);
}

}  // namespace

}  // TEST_SUITE("graph switch")
