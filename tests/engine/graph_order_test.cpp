// Checks random graphs against slow, independent answers to the questions that compiling answers: which
// passes are needed, which orders are legal, which resources may share an object.

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_random.hpp"

TEST_SUITE("graph order") {

namespace {

using namespace candela;
using random_graph::Graph;

/// precedes[a][b]: pass a must run before pass b, directly or through other passes.
using Precedence = std::vector<std::vector<bool>>;

/// Whether two passes keep the order of their declaration, whatever their resources are.
bool keep_order(const Graph& graph, std::size_t a, std::size_t b) {
    if (graph.passes[a].side_effect && graph.passes[b].side_effect) return true;
    for (const random_graph::ComponentAccess& first : graph.passes[a].components) {
        for (const random_graph::ComponentAccess& second : graph.passes[b].components) {
            if (first.type == second.type && (first.write || second.write)) return true;
        }
    }
    return false;
}

bool must_precede(const Graph& graph, std::size_t a, std::size_t b) {
    if (a < b && keep_order(graph, a, b)) return true;
    for (const random_graph::Access& first : graph.passes[a].accesses) {
        for (const random_graph::Access& second : graph.passes[b].accesses) {
            if (a == b || first.resource != second.resource) continue;
            const bool hands_over = first.write && !second.write && first.version == second.version;
            const bool reads_before = !first.write && second.write && second.version == first.version + 1;
            const bool writes_before = first.write && second.write && second.version == first.version + 1;
            if (hands_over || reads_before || writes_before) return true;
        }
    }
    return false;
}

Precedence precedence(const Graph& graph) {
    const std::size_t count = graph.passes.size();
    Precedence precedes(count, std::vector<bool>(count, false));
    for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < count; ++b) {
            precedes[a][b] = must_precede(graph, a, b);
        }
    }
    for (std::size_t via = 0; via < count; ++via) {
        for (std::size_t a = 0; a < count; ++a) {
            for (std::size_t b = 0; b < count; ++b) {
                if (precedes[a][via] && precedes[via][b]) precedes[a][b] = true;
            }
        }
    }
    return precedes;
}

/// Whether `reader` uses a result of `writer`.
bool feeds(const Graph& graph, std::size_t writer, std::size_t reader) {
    for (const random_graph::Access& made : graph.passes[writer].accesses) {
        for (const random_graph::Access& used : graph.passes[reader].accesses) {
            if (!made.write || made.resource != used.resource) continue;
            if (made.version == used.version - (used.write ? 1 : 0)) return true;
        }
    }
    return false;
}

std::vector<bool> needed(const Graph& graph) {
    std::vector<bool> needed(graph.passes.size(), false);
    for (std::size_t pass = 0; pass < needed.size(); ++pass) {
        needed[pass] = graph.passes[pass].side_effect;
        for (const random_graph::Access& access : graph.passes[pass].accesses) {
            const bool imported = graph.resources[access.resource].lifetime == Lifetime::imported;
            if (access.write && imported) needed[pass] = true;
        }
        for (const random_graph::ComponentAccess& access : graph.passes[pass].components) {
            if (access.write) needed[pass] = true;
        }
    }
    for (bool grew = true; grew;) {
        grew = false;
        for (std::size_t writer = 0; writer < needed.size(); ++writer) {
            for (std::size_t reader = 0; reader < needed.size() && !needed[writer]; ++reader) {
                if (needed[reader] && feeds(graph, writer, reader)) grew = needed[writer] = true;
            }
        }
    }
    return needed;
}

void check_order(const Graph& graph, const Precedence& precedes, const CompiledGraph& compiled) {
    const auto& order = compiled.plan().order;
    const std::vector<bool> kept = needed(graph);
    RC_ASSERT(order.size() == static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true)));
    for (std::size_t later = 0; later < order.size(); ++later) {
        RC_ASSERT(kept[order[later]]);
        for (std::size_t earlier = 0; earlier < later; ++earlier) {
            RC_ASSERT(order[earlier] != order[later]);
            RC_ASSERT(!precedes[order[later]][order[earlier]]);
        }
    }
}

void check_objects(const Graph& graph, const CompiledGraph& compiled) {
    struct Use {
        bool used = false;
        std::size_t first = 0;
        std::size_t last = 0;
    };
    std::vector<Use> uses(graph.resources.size());
    for (std::size_t position = 0; position < compiled.plan().order.size(); ++position) {
        for (const random_graph::Access& access : graph.passes[compiled.plan().order[position]].accesses) {
            Use& use = uses[access.resource];
            if (!use.used) use = {true, position, position};
            use.last = position;
        }
    }
    const std::vector<std::uint32_t>& object = compiled.plan().object;
    for (std::size_t a = 0; a < uses.size(); ++a) {
        RC_ASSERT(uses[a].used == (object[a] != detail::none));
        for (std::size_t b = a + 1; b < uses.size(); ++b) {
            if (!uses[a].used || !uses[b].used) continue;
            const random_graph::Resource& one = graph.resources[a];
            const random_graph::Resource& other = graph.resources[b];
            if (object[a] != object[b]) continue;
            RC_ASSERT(one.lifetime == Lifetime::transient);
            RC_ASSERT(other.lifetime == Lifetime::transient);
            RC_ASSERT(one.kind == other.kind);
            RC_ASSERT(one.deep == other.deep);
            RC_ASSERT((uses[a].last < uses[b].first || uses[b].last < uses[a].first));
        }
    }
}

TEST_CASE("graph: culling, order and shared objects of random graphs agree with a slow check" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({});
        const Precedence precedes = precedence(graph);
        for (const std::optional<std::uint32_t> shuffle : {std::optional<std::uint32_t>(), {1U}, {2U}}) {
            const CompiledGraph compiled = random_graph::compile(graph, shuffle).take();
            check_order(graph, precedes, compiled);
            check_objects(graph, compiled);
        }
    }));
}

/// The orders that the seeds find.
std::set<std::vector<std::uint32_t>> shuffled_orders(const Graph& graph, std::uint32_t seeds) {
    std::set<std::vector<std::uint32_t>> orders;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        orders.insert(random_graph::compile(graph, seed).take().plan().order);
    }
    return orders;
}

TEST_CASE("graph: shuffling finds every legal order") {
    // p0 before p1, since p1 reads what p0 writes; p2 is free, and so is p3 with its own component.
    const Graph graph{.resources = {{.kind = ResourceKind::buffer, .versions = 1}},
                      .passes = {{.accesses = {{.version = 1, .usage = Usage::storage, .write = true}}},
                                 {.accesses = {{.version = 1, .usage = Usage::storage}}, .side_effect = true},
                                 {.components = {{.type = 0, .write = true}}},
                                 {.components = {{.type = 1, .write = true}}}}};
    CHECK(shuffled_orders(graph, 400).size() == 4 * 3 * 2 * 1 / 2);
}

TEST_CASE("graph: passes between which no barrier is needed are together") {
    // Three chains of three passes each, declared one after the other: a barrier before each pass but the
    // first of each chain, unless the chains take turns.
    FrameGraph graph;
    for (const std::string chain : {"a", "b", "c"}) {
        std::optional<BufferHandle<int>> made;
        for (const std::string step : {"1", "2", "3"}) {
            made = graph.add(chain + step, [&](Pass& pass) {
                if (made) pass.read(*made, Usage::storage);
                return pass.write(graph.buffer<int>(chain + step, 4, Lifetime::imported), Usage::storage);
            });
        }
    }
    const CompiledGraph compiled = compile(std::move(graph)).take();
    const auto& barriers = compiled.plan().barrier;
    const auto issued =
        barriers.size() - static_cast<std::size_t>(std::ranges::count(barriers, Barrier::none));
    // Before the second and the third steps. The next frame's first steps overwrite what the second ones have
    // read: the barrier between these serves that, too.
    CHECK(issued == 2);
}

/// Declares and compiles `count` passes, each of which reads the results of the `reads` passes before it.
/// Returns the time in seconds.
double seconds_to_compile(std::size_t count, std::size_t reads) {
    const auto start = std::chrono::steady_clock::now();
    FrameGraph graph;
    std::vector<TextureHandle> made;
    for (std::size_t index = 0; index < count; ++index) {
        made.push_back(graph.add(random_graph::pass_name(index), [&](Pass& pass) {
            for (std::size_t back = 1; back <= std::min(reads, index); ++back) {
                pass.read(made[index - back], Usage::sampled);
            }
            if (index + 1 == count) pass.side_effect();
            return pass.write(graph.texture("result", {{64, 64}, Format::rgba16f}), Usage::storage);
        }));
    }
    const CompiledGraph compiled = compile(std::move(graph)).take();
    CHECK(compiled.pass_count() == count);
    CHECK(compiled.plan().owner.size() <= reads + 2);  // only a window of results is alive at any time
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST_CASE("graph: 10,000 passes compile in seconds, even if each pass doubles the number of paths") {
    // Quadratic time would take minutes, and following all paths, whose number doubles with each pass, would
    // never end. The limit leaves a margin for sanitizers.
    CHECK(seconds_to_compile(10'000, 1) < 5.0);
    CHECK(seconds_to_compile(10'000, 2) < 5.0);
}

}  // namespace

}  // TEST_SUITE("graph order")
