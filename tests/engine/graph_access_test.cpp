// What a running pass may access and reserve.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <candela/graph/describe.hpp>
#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph access") {

namespace {

using namespace candela;

TEST_CASE_FIXTURE(GraphFixture, "graph access: reserve() grows a buffer and resizes a texture") {
    const auto wanted = graph.import_value<std::uint64_t>("wanted");
    const auto blank = graph.buffer<float>("vpls", 100, Lifetime::persistent);
    const TextureHandle map = texture("map", Lifetime::persistent);
    std::uint64_t room = 0;
    graph.add("trace", [&](Pass& pass) {
        pass.read(wanted);
        const auto vpls = pass.write(blank, Usage::storage);
        const auto drawn = pass.write(map, Usage::layer_target);
        pass.side_effect();
        pass.run([&, wanted, vpls, drawn](Execution& run) {
            const std::uint64_t count = run.value(wanted);
            run.reserve(vpls, count);
            const TextureDesc desc{{static_cast<std::uint32_t>(count), 1}};
            run.reserve(drawn, desc);
            CHECK(run.desc(drawn) == desc);
            CHECK(backend.objects.at(run.object(drawn)).texture == desc);
            CHECK(backend.objects.at(run.object(vpls)).buffer == BufferDesc{run.count(vpls), sizeof(float)});
            room = run.count(vpls);
        });
    });
    switch_to();
    const auto room_for = [&](std::uint64_t count) {
        runtime.set(wanted, count);
        (void)run();
        return room;
    };
    CHECK(room_for(10) == 100);
    CHECK(room_for(101) == 150);  // grows at least by half
    CHECK(room_for(101) == 150);
    CHECK(room_for(1000) == 1000);
    const auto described = [](const GraphDescription& all, std::string_view name) {
        const auto found = std::ranges::find(all.resources, name, &DescribedResource::name);
        REQUIRE(found != all.resources.end());
        return *found;
    };
    CHECK(described(describe(*runtime.graph()), "vpls").buffer.count == 100);
    CHECK(described(runtime.describe(), "vpls").buffer.count == 1000);
    CHECK(described(runtime.describe(), "map").texture.size == glm::uvec2(1000, 1));
    CHECK(room_for(1) == 1000);  // never shrinks
    CHECK(backend.objects.size() == 2);
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(GraphFixture, "graph access: a pass may only access what it has declared") {
    const TextureHandle a = draw("draw", {}, texture("a"));
    const TextureHandle blank = texture("b");
    const auto number = graph.import_value<int>("number");
    std::vector<std::string> errors;
    const auto attempt = [&](auto act) {
        try {
            act();
        } catch (const GraphError& error) {
            errors.emplace_back(error.what());
        }
    };
    FrameGraph other;
    const TextureHandle foreign = other.texture("foreign", colour);
    graph.add("use", [&](Pass& pass) {
        pass.read(a, Usage::sampled);
        pass.side_effect();
        const auto unset = pass.write(graph.value<int>("unset"));
        pass.run([&, a, blank, number, foreign, unset](Execution& run) {
            attempt([&] { (void)run.object(blank); });
            attempt([&] { (void)run.value(number); });
            attempt([&] { run.set(number, 1); });
            attempt([&] { (void)run.object(foreign); });
            attempt([&] { (void)run.value(unset); });
            attempt([&] { run.reserve(a, colour); });
            attempt([&] { (void)run.previous(unset); });
        });
    });
    switch_to();
    (void)run();
    CHECK(errors == std::vector<std::string>{"pass 'use' uses texture 'b' without having declared it",
                                             "pass 'use' uses value 'number' without having declared it",
                                             "pass 'use' writes value 'number' without having declared it",
                                             "a handle is not of the current frame graph",
                                             "value 'unset' has not been set",
                                             "pass 'use' writes texture 'a' without having declared it",
                                             "pass 'use' asks for the previous content of value 'unset', "
                                             "but does not update it"});
}

TEST_CASE_FIXTURE(GraphFixture, "graph access: an update finds the content of the previous frame") {
    const auto step = graph.import_value<int>("step");
    std::vector<int> found;
    const auto sum = graph.add("sum", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(step);
        const auto out = pass.update(graph.value<int>("sum"));
        pass.run([&found, step, out](Execution& run) {
            const int* const before = run.previous(out);
            found.push_back(before ? *before : -1);
            run.set(out, (before ? *before : 0) + run.value(step));
        });
        return out;
    });
    graph.add("print", [&](Pass& pass) {
        pass.read(sum);
        pass.side_effect();
    });
    switch_to();
    for (const int value : {5, 7, 9}) {
        runtime.set(step, value);
        (void)run();
    }
    CHECK(found == std::vector<int>{-1, 5, 12});
    CHECK(runtime.value(sum) == 21);
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph access: only persistent resources that are not attachments may be reserved") {
    int refused = 0;
    const auto attempt = [&](Execution& run, auto resource, auto extent) {
        try {
            run.reserve(resource, extent);
        } catch (const GraphError&) {
            ++refused;
        }
    };
    const auto kept = graph.buffer<int>("kept", 4, Lifetime::persistent);
    graph.add("write", [&](Pass& pass) {
        const TextureHandle drawn = pass.write(texture("target", Lifetime::persistent), Usage::colour_target);
        const auto transient = pass.write(graph.buffer<int>("transient", 4), Usage::storage);
        const auto written = pass.write(pass.write(kept, Usage::copy), Usage::storage);
        pass.side_effect();
        pass.run([=](Execution& run) {
            attempt(run, drawn, TextureDesc{{8, 8}});
            attempt(run, transient, std::uint64_t{8});
            run.reserve(written, 8);  // version 2, written in two steps
        });
    });
    switch_to();
    (void)run();
    CHECK(refused == 2);
}

}  // namespace

}  // TEST_SUITE("graph access")
