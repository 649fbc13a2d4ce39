// A host that uses the engine alone: it runs a frame graph with the back end for tests. Two passes, of which
// the second doubles what the first has written.

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/graph/recording_backend.hpp>
#include <candela/version.hpp>

namespace {

struct Number {
    int value = 0;
    bool operator==(const Number&) const = default;
};

bool check(bool holds, const char* what) {
    if (!holds) std::fprintf(stderr, "graph_host: %s\n", what);
    return holds;
}

}  // namespace

int main() {
    candela::RecordingBackend memory;
    candela::GraphRuntime runtime(memory);
    candela::FrameGraph graph;
    const auto sum = graph.add("sum", [&](candela::Pass& pass) {
        pass.read<Number>();
        const auto out = pass.write(graph.buffer<int>("sum", 1), {candela::Usage::storage, 0});
        pass.run([=, &memory](candela::Execution& run) {
            int total = 0;
            for (const auto& [entity, number] : run.world().view<Number>()) total += number.value;
            memory.objects.at(run.object(out)).content = static_cast<std::uint64_t>(total);
        });
        return out;
    });
    const auto doubled = graph.add("double", [&](candela::Pass& pass) {
        pass.read(sum, {candela::Usage::storage, 0});
        const auto out = pass.write(graph.value<int>("doubled"));
        pass.side_effect();
        pass.run([=, &memory](candela::Execution& run) {
            const candela::ObjectId bound = memory.bound.at(0).first;
            run.set(out, 2 * static_cast<int>(memory.objects.at(bound).content));
        });
        return out;
    });
    runtime.switch_to(compile(std::move(graph)).take());

    candela::World world;
    const candela::Entity entity = world.create();
    world.set(entity, Number{20});
    world.set(world.create(), Number{1});
    bool good = true;
    runtime.run(world);
    good &= check(runtime.value(doubled) == 42, "the result is not 42");
    // The first barrier keeps the sum from being overwritten before the frame before has read it.
    const std::vector<std::string> expected{"barrier storage", "begin sum",    "end",
                                            "barrier storage", "begin double", "end"};
    good &= check(memory.log == expected, "the passes are not in order");
    memory.log.clear();
    runtime.run(world);
    const std::vector<std::string> again{"barrier storage", "begin double", "end"};
    good &= check(memory.log == again, "a clean pass ran");
    good &= check(memory.misuse.empty(), "the back end was misused");
    world.set(entity, Number{0});
    runtime.run(world);
    good &= check(runtime.value(doubled) == 2, "a change was missed");
    good &= check(describe_text(describe(*runtime.graph())).find("double") != std::string::npos,
                  "no description");
    good &= check(std::string(CANDELA_VERSION).starts_with("0."), "no version");
    return good ? 0 : 1;
}
