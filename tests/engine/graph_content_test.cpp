// What random graphs compute must equal a plain evaluation of the versions, whatever the order of passes, the
// sharing of objects and the skipping of passes.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_machine.hpp"

TEST_SUITE("graph content") {

namespace {

using namespace candela;
using random_graph::Content;
using random_graph::edit;
using random_graph::Graph;
using random_graph::Host;
using random_graph::Machine;
using random_graph::Meaning;
using random_graph::meaning;

/// Whether the pass must run in every frame.
bool always(const Graph& graph, std::size_t pass) {
    bool always = graph.passes[pass].side_effect;
    for (const random_graph::Access& access : graph.passes[pass].accesses) {
        always |= access.write && graph.resources[access.resource].lifetime == Lifetime::imported;
    }
    return always;
}

/// Whether all values are the same in the second frame. An import that a pass has written does not start the
/// second frame with its first contents, and a value that is set several times keeps the last one.
bool values_stay_equal(const Graph& graph) {
    return std::ranges::none_of(graph.resources, [](const random_graph::Resource& resource) {
        return resource.lifetime == Lifetime::imported
                   ? resource.versions > 0
                   : resource.kind == ResourceKind::value && resource.versions > 1;
    });
}

/// The passes, visited in this order, that run in every frame, and those that read what such a pass writes
/// again. For a texture or buffer every write counts as a change, for a value only one that may differ.
std::set<std::size_t> made_again(const Graph& graph, const std::vector<std::uint32_t>& order) {
    const bool stay_equal = values_stay_equal(graph);
    std::set<std::size_t> passes;
    std::set<std::pair<std::size_t, std::uint32_t>> versions;  // resource and version
    for (const std::size_t pass : order) {
        const auto& accesses = graph.passes[pass].accesses;
        const auto has_changed = [&](const random_graph::Access& access) {
            return versions.contains({access.resource, access.version - (access.write ? 1 : 0)});
        };
        if (!always(graph, pass) && std::ranges::none_of(accesses, has_changed)) continue;
        passes.insert(pass);
        for (const random_graph::Access& access : accesses) {
            const bool equal = stay_equal && graph.resources[access.resource].kind == ResourceKind::value;
            if (access.write && !equal) versions.insert({access.resource, access.version});
        }
    }
    return passes;
}

TEST_CASE("graph: running only the dirty passes gives the same results as running all" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20});
        Host host = random_graph::make_host(graph);
        Machine machine(graph);
        for (int frame = 0; frame < 6; ++frame) {
            const Meaning expected = meaning(graph, *machine.runtime().graph(), host);
            machine.provide(host);
            (void)machine.run();
            machine.check(expected);
            edit(host);
        }
    }));
}

TEST_CASE("graph: all legal orders give the same results" * doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20});
        Host host = random_graph::make_host(graph);
        Machine machine(graph);
        for (std::uint32_t seed = 0; seed < 6; ++seed) {
            // What the order before has left behind stays.
            machine.switch_to(graph, seed);
            machine.provide(host);
            (void)machine.run();
            machine.check(meaning(graph, *machine.runtime().graph(), host));
            edit(host);
        }
    }));
}

/// The graph with other side effects, which other passes are then needed for, and with one more pass that
/// reads some results.
Graph varied(Graph graph) {
    for (random_graph::Pass& pass : graph.passes) {
        if (random_graph::one_in(6)) pass.side_effect = !pass.side_effect;
    }
    random_graph::Pass reader{.accesses = {}, .side_effect = true};
    for (std::size_t index = 0; index < graph.resources.size(); ++index) {
        const random_graph::Resource& resource = graph.resources[index];
        if (resource.versions > 0 && random_graph::one_in(4)) {
            const bool gpu = resource.kind != ResourceKind::value;
            const Usage usage = gpu ? random_graph::read_usage(resource.kind) : Usage{};
            reader.accesses.push_back({index, resource.versions, usage});
        }
    }
    graph.passes.push_back(reader);
    return graph;
}

TEST_CASE("graph: switching between graphs that differ a little gives the same results as running all" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph one = random_graph::make({.passes = 20});
        const Graph other = varied(one);
        Host host = random_graph::make_host(one);
        Machine machine(one);
        for (int frame = 0; frame < 8; ++frame) {
            const Graph& graph = frame / 2 % 2 == 0 ? one : other;
            machine.switch_to(graph);
            for (const bool edits : {false, true}) {
                machine.provide(host);
                (void)machine.run();
                machine.check(meaning(graph, *machine.runtime().graph(), host));
                if (edits) edit(host);
            }
        }
    }));
}

TEST_CASE("graph: abandoned frames give the same results as running all, whatever the host edits meanwhile" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20});
        Host host = random_graph::make_host(graph);
        Machine machine(graph);
        for (int frame = 0; frame < 6; ++frame) {
            for (auto tries = random_graph::choose(4); tries > 0; --tries) {
                machine.provide(host);
                const FrameRecord& record = machine.run_some(static_cast<int>(random_graph::choose(20)));
                if (record.complete) continue;
                machine.check_use();
                if (random_graph::one_in(2)) edit(host);
            }
            machine.provide(host);
            RC_ASSERT(machine.run().complete);
            machine.check(meaning(graph, *machine.runtime().graph(), host));
            edit(host);
        }
    }));
}

/// Whether nothing else is ever written to the object that holds the pass's result.
bool stays(const Graph& graph, const std::vector<std::uint32_t>& objects,
           const random_graph::Access& result) {
    return graph.resources[result.resource].versions == 1 &&
           std::ranges::count(objects, objects[result.resource]) == 1;
}

TEST_CASE("graph: without changes, only passes that always run, their readers and overwritten ones run" *
          doctest::test_suite("random")) {
    // In a small graph most passes run in every frame, which would test nothing.
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 60, .systems = false});
        const Host host = random_graph::make_host(graph);
        Machine machine(graph);
        machine.provide(host);
        (void)machine.run();
        const FrameRecord& record = machine.run();
        const auto& plan = machine.runtime().graph()->plan();
        const std::set<std::size_t> again = made_again(graph, plan.order);
        for (std::size_t position = 0; position < plan.order.size(); ++position) {
            const std::size_t pass = plan.order[position];
            const bool ran = record.passes[position].ran;
            const bool all_stay =
                std::ranges::all_of(graph.passes[pass].accesses, [&](const random_graph::Access& access) {
                    return !access.write || stays(graph, plan.object, access);
                });
            RC_ASSERT((ran || !always(graph, pass)));
            RC_ASSERT((!ran || again.contains(pass) || !all_stay));
        }
    }));
}

}  // namespace

}  // TEST_SUITE("graph content")
