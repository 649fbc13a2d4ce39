// Compares the planned barriers of random graphs with all pairs of accesses, over repeated frames.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <map>
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
    std::vector<Event> events;
    const std::size_t count = compiled.plan().order.size();
    for (std::size_t frame = 0; frame < frames; ++frame) {
        for (std::size_t position = 0; position < count; ++position) {
            for (const random_graph::Access& access :
                 graph.passes[compiled.plan().order[position]].accesses) {
                const random_graph::Resource& resource = graph.resources[access.resource];
                if (resource.kind == ResourceKind::value) continue;
                events.push_back({frame * count + position, compiled.plan().object[access.resource],
                                  bit_of(resource.kind, access.usage), access.write,
                                  access.write && access.usage == Usage::storage});
            }
        }
    }
    return events;
}

/// Two accesses that need a barrier between them, with the bit of the later one.
struct Hazard {
    std::size_t early = 0;
    std::size_t late = 0;
    Barrier bit = Barrier::none;
};

std::vector<Hazard> hazards_of(const std::vector<Event>& events) {
    std::vector<Hazard> hazards;
    for (const Event& early : events) {
        for (const Event& late : events) {
            const bool after_write = early.incoherent;
            const bool after_read = !early.write && late.incoherent;
            if (late.time > early.time && late.object == early.object && (after_write || after_read)) {
                hazards.push_back({early.time, late.time, late.bit});
            }
        }
    }
    return hazards;
}

/// Whether each hazard has a barrier, of any bits, between its accesses. `positions`: bit i of it says
/// whether a barrier comes before the pass at position i.
bool suffice(std::uint32_t positions, std::size_t count, const std::vector<Hazard>& hazards) {
    return std::ranges::all_of(hazards, [&](const Hazard& hazard) {
        for (std::size_t time = hazard.early + 1; time <= hazard.late; ++time) {
            if ((positions >> time % count & 1U) != 0) return true;
        }
        return false;
    });
}

/// The smallest number of barriers that serves all hazards, found by trying all sets of positions.
int fewest_barriers(std::size_t count, const std::vector<Hazard>& hazards) {
    int fewest = static_cast<int>(count);
    for (std::uint32_t positions = 0; positions < 1U << count; ++positions) {
        if (std::popcount(positions) < fewest && suffice(positions, count, hazards)) {
            fewest = std::popcount(positions);
        }
    }
    return fewest;
}

TEST_CASE(
    "graph: every pair of accesses that needs a barrier has one, and there are hardly more than needed" *
    doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 10});
        const CompiledGraph compiled = random_graph::compile(graph).take();
        const auto& barriers = compiled.plan().barrier;
        // A hazard ends in the next frame at the latest, so three frames show each together with the others.
        const std::vector<Hazard> hazards = hazards_of(unroll(graph, compiled, 3));
        for (const Hazard& hazard : hazards) {
            bool served = false;
            for (std::size_t time = hazard.early + 1; time <= hazard.late; ++time) {
                served |= (barriers[time % barriers.size()] & hazard.bit) == hazard.bit;
            }
            RC_ASSERT(served);
        }
        // Around the cycle of frames, barriers that each come as late as possible may be one more than
        // needed.
        const auto issued =
            barriers.size() - static_cast<std::size_t>(std::ranges::count(barriers, Barrier::none));
        RC_ASSERT(static_cast<int>(issued) <= fewest_barriers(barriers.size(), hazards) + 1);
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
    // The barrier between writes and reads serves all accesses up to the next frame's writes. These overwrite
    // what this frame reads, and need a barrier of their own.
    CHECK(compiled.plan().barrier == std::vector{Barrier::storage, Barrier::none,
                                                 Barrier::uniform | Barrier::vertex_attrib, Barrier::none,
                                                 Barrier::none});
}

TEST_CASE("graph: passes are in an order in which two barriers serve them all") {
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
    write("c", 64);
    read("c");
    read("b");
    const auto compiled = compile(std::move(graph)).take();
    std::string issued;
    for (const Barrier barrier : compiled.plan().barrier) {
        issued += barrier == Barrier::storage ? '|' : barrier == Barrier::none ? '.' : '?';
    }
    // All are written, then all are read.
    CHECK(issued == "|..|..");
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
