// What random graphs compute must be what a plain evaluation of the versions gives, however passes are
// ordered, objects shared and passes skipped.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "tests/engine/graph_machine.hpp"

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

/// Of passes in this order those that run in every frame, and those that read a texture or buffer which such
/// a pass makes anew: that is a change, whatever is in it. Values that stay equal are none.
std::set<std::size_t> made_anew(const Graph& graph, const std::vector<std::uint32_t>& order) {
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
            const bool is_value = graph.resources[access.resource].kind == ResourceKind::value;
            if (access.write && !is_value) versions.insert({access.resource, access.version});
        }
    }
    return passes;
}

TEST_CASE("graph: running what is dirty gives what the declaration means, in any legal order" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .histories = false, .backward_afters = false});
        Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine straight(graph, {});
        Machine shuffled(graph, {.shuffle_seed = *rc::gen::arbitrary<std::uint64_t>()});
        for (int frame = 0; frame < 6; ++frame) {
            const Meaning expected = meaning(graph, straight.runtime().graph()->plan().order, host, nullptr);
            for (Machine* machine : {&straight, &shuffled}) {
                machine->provide(host);
                (void)machine->run();
                machine->check(expected);
            }
            edit(host);
        }
    }));
}

TEST_CASE("graph: frames that remember the last give what the declaration means, in any legal order" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .backward_afters = false});
        Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine straight(graph, {});
        Machine shuffled(graph, {.shuffle_seed = *rc::gen::arbitrary<std::uint64_t>()});
        Meaning before;
        for (int frame = 0; frame < 6; ++frame) {
            const Meaning expected = meaning(graph, straight.runtime().graph()->plan().order, host,
                                             frame == 0 ? nullptr : &before);
            for (Machine* machine : {&straight, &shuffled}) {
                machine->provide(host);
                machine->runtime().invalidate();  // memories are not inputs: without them all would not run
                (void)machine->run();
                machine->check(expected);
            }
            before = expected;
            edit(host);
        }
    }));
}

TEST_CASE(
    "graph: when nothing has changed, only those run that always do or read what those make, and those that "
    "they lack results of" *
    doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .histories = false, .backward_afters = false});
        const Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine machine(graph, {});
        machine.provide(host);
        (void)machine.run();
        const FrameRecord& record = machine.run();
        const auto& order = machine.runtime().graph()->plan().order;
        const auto feeds_one_that_ran = [&](std::size_t writer) {
            for (std::size_t position = 0; position < order.size(); ++position) {
                for (const random_graph::Access& used : graph.passes[order[position]].accesses) {
                    for (const random_graph::Access& made : graph.passes[writer].accesses) {
                        const bool handed = made.write && made.resource == used.resource &&
                                            made.version == used.version - (used.write ? 1 : 0);
                        if (handed && record.passes[position].ran) {
                            return true;
                        }
                    }
                }
            }
            return false;
        };
        const std::set<std::size_t> anew = made_anew(graph, order);
        for (std::size_t position = 0; position < order.size(); ++position) {
            const bool ran = record.passes[position].ran;
            const bool may = anew.contains(order[position]) || feeds_one_that_ran(order[position]);
            RC_ASSERT((ran || !always(graph, order[position])));
            RC_ASSERT((may || !ran));
        }
    }));
}

}  // namespace
