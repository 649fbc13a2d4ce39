// Compares the planned barriers of random graphs with all pairs of accesses, over repeated frames.

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_random.hpp"

TEST_SUITE("graph barrier") {

namespace {

using namespace candela;
using random_graph::Graph;

/// One access of one object at one time. Time counts passes, continuously over all frames.
struct Event {
    std::size_t time = 0;
    std::uint32_t object = 0;
    Barrier bit = Barrier::none;
    bool write = false;
    bool incoherent = false;
};

/// The barrier bit that belongs to an access: OpenGL 4.5, section 7.13.2.
Barrier bit_of(ResourceKind kind, Usage usage) {
    const bool texture = kind == ResourceKind::texture;
    if (usage == Usage::sampled) return Barrier::texture_fetch;
    if (usage == Usage::uniform) return Barrier::uniform;
    if (usage == Usage::vertex) return Barrier::vertex_attrib;
    if (usage == Usage::index) return Barrier::element;
    if (usage == Usage::indirect) return Barrier::command;
    if (usage == Usage::storage) return texture ? Barrier::image_access : Barrier::storage;
    if (usage == Usage::copy) return texture ? Barrier::texture_update : Barrier::buffer_update;
    return Barrier::framebuffer;
}

std::vector<Event> unroll(const Graph& graph, const CompiledGraph& compiled, std::size_t frames) {
    std::vector<std::uint32_t> first_object;
    std::uint32_t index = 0;
    for (const random_graph::Resource& resource : graph.resources) {
        first_object.push_back(compiled.plan().object[index]);
        index += resource.has_history ? 2 : 1;
    }
    std::vector<Event> events;
    const std::size_t count = compiled.plan().order.size();
    for (std::size_t frame = 0; frame < frames; ++frame) {
        for (std::size_t position = 0; position < count; ++position) {
            for (const random_graph::Access& access :
                 graph.passes[compiled.plan().order[position]].accesses) {
                const random_graph::Resource& resource = graph.resources[access.resource];
                if (resource.kind == ResourceKind::value) continue;
                const std::size_t turn = resource.has_history ? (frame + (access.previous ? 1 : 0)) % 2 : 0;
                events.push_back({frame * count + position,
                                  first_object[access.resource] + static_cast<std::uint32_t>(turn),
                                  bit_of(resource.kind, access.usage), access.write,
                                  access.write && access.usage == Usage::storage});
            }
        }
    }
    return events;
}

TEST_CASE("graph: exactly those barriers are planned that some pair of accesses needs" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({});
        const CompiledGraph compiled = random_graph::compile(graph).take();
        const auto& barriers = compiled.plan().barrier;
        // A hazard spans at most two frames (with histories), so five frames show each hazard together with
        // the others.
        const std::vector<Event> events = unroll(graph, compiled, 5);
        std::vector<Barrier> needed(barriers.size(), Barrier::none);
        for (const Event& early : events) {
            for (const Event& late : events) {
                const bool after_write = early.incoherent;
                const bool after_read = !early.write && late.incoherent;
                if (late.time <= early.time || late.object != early.object || !(after_write || after_read)) {
                    continue;
                }
                std::set<std::size_t> between;
                for (std::size_t time = early.time + 1; time <= late.time; ++time) {
                    const std::size_t position = time % barriers.size();
                    if ((barriers[position] & late.bit) == late.bit) between.insert(position);
                }
                RC_ASSERT(!between.empty());
                if (between.size() == 1) needed[*between.begin()] = needed[*between.begin()] | late.bit;
            }
        }
        RC_ASSERT(needed == barriers);
    }));
}

TEST_CASE("graph: one barrier covers all writes before it") {
    FrameGraph graph;
    const auto write = [&](std::string_view name) {
        return graph.add(name,
                         [&](Pass& pass) { return pass.write(graph.buffer<int>(name, 4), Usage::storage); });
    };
    const auto read = [&](std::string_view name, BufferHandle<int> buffer, Usage usage) {
        graph.add(name, [&](Pass& pass) {
            pass.read(buffer, usage);
            pass.side_effect();
        });
    };
    const auto a = write("a");
    const auto b = write("b");
    read("use a", a, Usage::uniform);
    read("use b", b, Usage::uniform);
    read("draw b", b, Usage::vertex);
    const auto compiled = compile(std::move(graph)).take();
    // "a" and "b" overwrite what the previous frame has read; one barrier covers both.
    CHECK(compiled.plan().barrier == std::vector{Barrier::storage, Barrier::none, Barrier::uniform,
                                                 Barrier::none, Barrier::vertex_attrib});
}

TEST_CASE("graph: a barrier is kept if a pass between it and the next one needs it") {
    FrameGraph graph;
    std::map<std::string, BufferHandle<int>> buffers;
    const auto write = [&](const std::string& name, std::size_t count) {
        buffers[name] = graph.add(
            name, [&](Pass& pass) { return pass.write(graph.buffer<int>(name, count), Usage::storage); });
    };
    const auto read = [&](const std::string& name) {
        graph.add("read " + name, [&](Pass& pass) {
            pass.read(buffers[name], Usage::storage);
            pass.side_effect();
        });
    };
    write("a", 4);
    write("b", 4);
    read("a");
    write("c", 64);  // of another size, so that it does not share memory with "a"
    read("c");
    read("b");
    const auto compiled = compile(std::move(graph)).take();
    std::string issued;
    for (const Barrier barrier : compiled.plan().barrier) {
        issued += barrier == Barrier::storage ? '|' : barrier == Barrier::none ? '.' : '?';
    }
    // "a" needs no barrier: one comes after the previous frame has read it. But "b" does.
    CHECK(issued == "|.|.|.");
}

TEST_CASE("graph: coherent writes need no barriers") {
    FrameGraph graph;
    const TextureHandle drawn = graph.add("draw", [&](Pass& pass) {
        return pass.write(graph.texture("image", {{8, 8}}), Usage::colour_target);
    });
    graph.add("show", [&](Pass& pass) {
        pass.read(drawn, Usage::sampled);
        pass.side_effect();
    });
    const auto compiled = compile(std::move(graph)).take();
    CHECK(compiled.plan().barrier == std::vector{Barrier::none, Barrier::none});
}

}  // namespace

}  // TEST_SUITE("graph barrier")
