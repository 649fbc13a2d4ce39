// Verification: passes run again, and their results are compared.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_fixture.hpp"
#include "tests/engine/graph_machine.hpp"
#include "tests/throws.hpp"

TEST_SUITE("graph verify") {

namespace {

using namespace candela;
using random_graph::Graph;
using random_graph::Host;
using random_graph::Machine;

struct Light {
    int power = 0;
    bool operator==(const Light&) const = default;
};

/// Names of the passes that were verified, joined by spaces.
std::string verified(const FrameRecord& record) {
    std::string names;
    for (const PassRecord& pass : record.passes) {
        if (pass.verified) names += (names.empty() ? "" : " ") + std::string(pass.name);
    }
    return names;
}

struct VerifyFixture : GraphFixture {
    VerifyFixture() { runtime.set_verification(true); }

    /// Runs and verifies a frame. Returns the passes that ran, and those that ran again.
    std::string frame() {
        const FrameRecord& record = runtime.run(world);
        runtime.verify(world);
        return ran(record) + " | " + verified(record);
    }

    std::uint64_t& content(ObjectId object) { return backend.objects.at(object).content; }

    /// A pass that fills a texture with the result of `make`.
    template <class Make>
    TextureHandle fill(std::string_view name, TextureHandle target, Make make) {
        return graph.add(name, [&](Pass& pass) {
            const TextureHandle written = pass.write(target, Usage::storage);
            pass.run([this, written, make](Execution& run) { content(run.object(written)) = make(run); });
            return written;
        });
    }

    /// A pass that adds to a texture in place.
    TextureHandle raise(std::string_view name, TextureHandle target, ValueHandle<int> by) {
        return graph.add(name, [&](Pass& pass) {
            pass.read(by);
            const TextureHandle written = pass.write(target, Usage::storage);
            pass.run([this, written, by](Execution& run) {
                content(run.object(written)) += static_cast<std::uint64_t>(run.value(by));
            });
            return written;
        });
    }

    void show(TextureHandle shown) {
        const TextureHandle target = texture("target", Lifetime::imported);
        target_ = draw("show", {shown}, target);
    }
    void switch_to() {
        GraphFixture::switch_to();
        runtime.bind(target_, 77, colour);
    }

    TextureHandle target_;
};

TEST_CASE_FIXTURE(VerifyFixture, "graph verify: a captured variable is an undeclared input") {
    std::uint64_t captured = 1;
    const TextureHandle lit = fill("light", texture("lit"), [&](Execution&) { return captured; });
    show(lit);
    switch_to();
    CHECK(frame() == "light show | light");
    CHECK(frame() == "show | light");
    captured = 2;
    CHECK_THROWS_WITH_AS(frame(),
                         "pass 'light' has an undeclared input: run again while nothing that it declares has "
                         "changed, it gives texture 'lit' another content",
                         GraphError);
    CHECK(backend.open_passes == 0);
    CHECK(frame() == "light show | light");  // counts as not having run
    CHECK(frame() == "show | light");
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: a pass that is not deterministic is found in its first frame") {
    std::uint64_t calls = 0;
    const auto made = graph.add("scatter", [&](Pass& pass) {
        const auto written = pass.write(graph.buffer<int>("points", 4), Usage::storage);
        pass.run([&, written](Execution& run) { content(run.object(written)) = ++calls; });
        return written;
    });
    graph.add("print", [&](Pass& pass) {
        pass.read(made, Usage::storage);
        pass.side_effect();
    });
    GraphFixture::switch_to();
    CHECK_THROWS_WITH_AS(
        frame(),
        "pass 'scatter' has an undeclared input: run again while nothing that it declares has "
        "changed, it gives buffer 'points' another content",
        GraphError);
}

TEST_CASE_FIXTURE(
    VerifyFixture,
    "graph verify: each version of a resource that is modified in place is compared separately") {
    const auto knob = graph.import_value<int>("knob");
    std::uint64_t captured = 1;
    const TextureHandle first = fill("opaque", texture("lit"), [&](Execution&) { return captured; });
    const TextureHandle second = raise("transparent", first, knob);
    show(raise("bloom", second, knob));
    switch_to();
    runtime.set(knob, 5);
    CHECK(frame() == "opaque transparent bloom show | opaque transparent bloom");
    CHECK(frame() == "show | opaque transparent bloom");
    runtime.set(knob, 7);
    CHECK(frame() == "opaque transparent bloom show | opaque transparent bloom");
    CHECK(content(runtime.object(second)) == 15);
    captured = 2;
    CHECK(throws<GraphError>([&] { static_cast<void>(frame()); }, "pass 'opaque' has an undeclared input"));
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: resources that share an object with others are compared, too") {
    std::uint64_t captured = 1;
    const TextureHandle a = fill("draw a", texture("a"), [&](Execution&) { return captured; });
    const TextureHandle b = draw("draw b", {a}, texture("b"));
    const TextureHandle c = draw("draw c", {b}, texture("c"));
    show(c);
    switch_to();
    CHECK(runtime.object(a) == runtime.object(c));
    CHECK(frame() == "draw a draw b draw c show | draw a draw b draw c");
    CHECK(frame() == "show | draw a draw b draw c");
    captured = 2;
    CHECK(throws<GraphError>([&] { static_cast<void>(frame()); }, "pass 'draw a' has an undeclared input"));
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: a captured variable is also found if it changes with a switch of graphs") {
    const auto declare = [&](std::uint64_t captured, const TextureDesc& other) {
        graph = FrameGraph();
        const TextureHandle kept =
            fill("light", texture("lit", Lifetime::persistent), [=](Execution&) { return captured; });
        const TextureHandle target = graph.texture("target", other, Lifetime::imported);
        graph.add("show", [&](Pass& pass) {
            pass.read(kept, Usage::sampled);
            (void)pass.write(target, Usage::colour_target);
        });
        GraphFixture::switch_to();
        runtime.bind(target, 77, other);
    };
    declare(1, colour);
    CHECK(frame() == "light show | light");
    declare(1, {{8, 8}});
    CHECK(frame() == "show | light");
    declare(2, colour);  // which should have been a parameter
    CHECK(throws<GraphError>([&] { static_cast<void>(frame()); }, "pass 'light' has an undeclared input"));
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: reserved objects stay, and values without operator== are not compared") {
    struct Opaque {
        int number = 0;
    };
    int calls = 0;
    const auto out = graph.add("upload", [&](Pass& pass) {
        const auto buffer = pass.write(graph.buffer<int>("list", 1, Lifetime::persistent), Usage::copy);
        const auto value = pass.write(graph.value<Opaque>("opaque"));
        pass.run([&, buffer, value](Execution& run) {
            run.reserve(buffer, 10);
            run.set(value, Opaque{++calls});
        });
        return buffer;
    });
    graph.add("print", [&](Pass& pass) {
        pass.read(out, Usage::storage);
        pass.side_effect();
    });
    GraphFixture::switch_to();
    CHECK(frame() == "upload print | upload");
    const ObjectId object = runtime.object(out);
    CHECK(frame() == "print | upload");
    CHECK(runtime.object(out) == object);
    CHECK(calls == 3);
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: passes that remember are not run again and keep their results") {
    const auto knob = graph.import_value<int>("knob");
    const TextureHandle blank = texture("sum", Lifetime::persistent);
    const TextureHandle sum = graph.add("accumulate", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(knob);
        const TextureHandle written = pass.update(blank, Usage::storage);
        pass.run([&, knob, written](Execution& run) {
            const std::uint64_t before = run.has_result() ? content(run.object(written)) : 0;
            content(run.object(written)) = before + static_cast<std::uint64_t>(run.value(knob));
        });
        return written;
    });
    const auto count = graph.add("count", [&](Pass& pass) {
        pass.keeps_state();
        pass.read(knob);
        const auto written = pass.update(graph.value<int>("count"));
        pass.run([=](Execution& run) {
            const int* const last = run.previous(written);
            run.set(written, last ? *last + 1 : 1);
        });
        return written;
    });
    show(raise("copy", fill("clear", texture("copy"), [](Execution&) { return 0U; }), count));
    graph.add("watch", [&](Pass& pass) {
        pass.read(sum, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    for (const int number : {1, 2, 3}) {
        runtime.set(knob, number);
        CHECK(frame() == "accumulate count clear copy watch show | clear copy");
        CHECK(frame() == "watch show | clear copy");
    }
    CHECK(content(runtime.object(sum)) == 6);
    CHECK(runtime.value(count) == 3);
}

TEST_CASE_FIXTURE(VerifyFixture, "graph verify: results of passes with side effects are not overwritten") {
    unsigned prints = 0;
    const TextureHandle first =
        fill("draw", texture("page", Lifetime::persistent), [](Execution&) { return 1U; });
    const TextureHandle printed = graph.add("print", [&](Pass& pass) {
        pass.side_effect();
        const TextureHandle written = pass.write(first, Usage::storage);
        pass.run([&, written](Execution& run) { content(run.object(written)) += 10 * ++prints; });
        return written;
    });
    const TextureHandle read = fill("other", texture("other"), [](Execution&) { return 3U; });
    show(draw("read", {printed, read}, texture("read")));
    switch_to();
    CHECK(frame() == "draw other print read show | other read");
    CHECK(content(runtime.object(printed)) == 11);
    CHECK(frame() == "draw print read show | other read");
    CHECK(content(runtime.object(printed)) == 21);
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: a pass is not run again if the import that it has read was overwritten") {
    const TextureHandle target = texture("target", Lifetime::imported);
    const TextureHandle copied = draw("copy", {target}, texture("copied", Lifetime::persistent));
    target_ = draw("show", {copied}, target);
    switch_to();
    CHECK(frame() == "copy show | ");
}

TEST_CASE_FIXTURE(VerifyFixture,
                  "graph verify: passes that usually update parts of their result must compute all of it") {
    const auto left = graph.import_value<int>("left");
    const auto right = graph.import_value<int>("right");
    std::string made;
    bool careless = false;
    const auto both = graph.add("pair", [&](Pass& pass) {
        pass.read(left);
        pass.read(right);
        const auto written = pass.update(graph.buffer<int>("pair", 2, Lifetime::persistent), Usage::copy);
        pass.run([&, left, right, written](Execution& run) {
            std::uint64_t pair = content(run.object(written));
            if (run.changed(left)) {
                made += "l";
                pair = pair % 10 + 10 * static_cast<std::uint64_t>(run.value(left));
            }
            if (run.changed(right) && !(careless && made.empty())) {
                made += "r";
                pair = pair / 10 * 10 + static_cast<std::uint64_t>(run.value(right));
            }
            content(run.object(written)) = pair;
            CHECK_THROWS_WITH_AS(
                (void)run.changed(written),
                "pass 'pair' asks whether buffer 'pair' has changed without having declared it", GraphError);
        });
        return written;
    });
    graph.add("print", [&](Pass& pass) {
        pass.read(both, Usage::storage);
        pass.side_effect();
    });
    GraphFixture::switch_to();
    const auto parts = [&](int first, int second) {
        made.clear();
        runtime.set(left, first);
        runtime.set(right, second);
        (void)run();
        return made;
    };
    CHECK(parts(1, 2) == "lr");
    CHECK(parts(1, 3) == "r");
    CHECK(parts(4, 3) == "l");
    CHECK(parts(4, 3).empty());
    runtime.verify(world);
    CHECK(made == "lr");
    CHECK(content(runtime.object(both)) == 43);
    runtime.invalidate();
    CHECK(parts(4, 3) == "lr");
    careless = true;
    CHECK(parts(4, 5).empty());
    CHECK(throws<GraphError>([&] { static_cast<void>(runtime.verify(world)); },
                             "pass 'pair' has an undeclared input"));
}

TEST_CASE_FIXTURE(GraphFixture,
                  "graph verify: when it is off, nothing is read back, and verify() is an error") {
    draw("draw", {}, texture("drawn"));
    graph.add("print", [&](Pass& pass) { pass.side_effect(); });
    switch_to();
    (void)run();
    CHECK(backend.digests == 0);
    CHECK_THROWS_WITH_AS(runtime.verify(world),
                         "there is no frame to verify: there is no graph, or verification is off",
                         GraphError);
}

TEST_CASE("graph verify: correct random graphs pass, and verifying does not change their results" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20});
        Host host = random_graph::make_host(graph);
        Machine machine(graph);
        machine.runtime().set_verification(true);
        for (int frame = 0; frame < 6; ++frame) {
            const auto expected = meaning(graph, *machine.runtime().graph(), host);
            machine.provide(host);
            (void)machine.run();
            machine.check(expected);
            machine.runtime().verify(machine.world());
            machine.check(expected);
            edit(host);
        }
    }));
}

/// Runs two frames with constant inputs, the first of them verified.
const FrameRecord& second_frame(Machine& machine, const Graph& graph) {
    machine.runtime().set_verification(true);
    const Host host = random_graph::make_host(graph);
    machine.provide(host);
    (void)machine.run();
    machine.runtime().verify(machine.world());
    machine.provide(host);
    return machine.run();
}

/// Whether verification can detect that the pass writes something else when it runs again. The pass must be
/// one that runs again and writes something. Passes that read imports are excluded: another pass may have
/// written to the import, and then it is unknown whether the import still has the same contents.
bool can_be_found(const Graph& graph, std::size_t pass) {
    Machine machine(graph);
    const FrameRecord& record = second_frame(machine, graph);
    machine.runtime().verify(machine.world());
    const auto is_verified = [&](const PassRecord& run) {
        return run.name == random_graph::pass_name(pass) && run.verified;
    };
    const auto reads_import = [&](const random_graph::Access& access) {
        return !access.write && graph.resources[access.resource].lifetime == Lifetime::imported;
    };
    const auto& accesses = graph.passes[pass].accesses;
    return std::ranges::any_of(record.passes, is_verified) &&
           std::ranges::any_of(accesses, &random_graph::Access::write) &&
           std::ranges::none_of(accesses, reads_import);
}

/// What verifying the second frame reports if pass `culprit` starts to write something else.
std::string message_about(const Graph& graph, std::size_t culprit) {
    Machine machine(graph);
    (void)second_frame(machine, graph);
    machine.sabotage(culprit);
    try {
        machine.runtime().verify(machine.world());
    } catch (const GraphError& error) {
        return error.what();
    }
    return "";
}

bool is_named(const std::string& message, std::size_t pass) {
    return message.starts_with("pass '" + random_graph::pass_name(pass) + "' has an undeclared input");
}

TEST_CASE("graph verify: the error names the pass with the undeclared input, not its reader") {
    const random_graph::Access writes{.version = 1, .usage = Usage::storage, .write = true};
    const random_graph::Access reads{.version = 1, .usage = Usage::sampled};
    const Graph graph{.resources = {{.versions = 1}},
                      .passes = {{.accesses = {writes}}, {.accesses = {reads}, .side_effect = true}}};
    CHECK(can_be_found(graph, 0));
    CHECK(is_named(message_about(graph, 0), 0));
    CHECK_FALSE(can_be_found(graph, 1));
    CHECK(message_about(graph, 1).empty());
}

TEST_CASE("graph verify: in random graphs the error names the pass with the undeclared input" *
          doctest::test_suite("random")) {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20});
        const auto order = Machine(graph).runtime().graph()->plan().order;
        if (order.empty()) return;
        const std::size_t culprit = order[random_graph::choose(order.size())];
        const std::string message = message_about(graph, culprit);
        RC_ASSERT((message.empty() || is_named(message, culprit)));
        RC_ASSERT((!message.empty() || !can_be_found(graph, culprit)));
    }));
}

}  // namespace

}  // TEST_SUITE("graph verify")
