// A host that uses the engine alone: it runs a frame graph with a back end of its own. Two passes, of which
// the second doubles what the first has written; "memory" stands for a graphics API.

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/version.hpp>

namespace {

class Memory final : public candela::Backend {
 public:
    candela::ObjectId create_texture(std::string_view, const candela::TextureDesc& desc) override {
        return create(candela::byte_size(desc));
    }
    candela::ObjectId create_buffer(std::string_view, const candela::BufferDesc& desc) override {
        return create(candela::byte_size(desc));
    }
    void destroy_texture(candela::ObjectId texture) override { objects.erase(texture); }
    void destroy_buffer(candela::ObjectId buffer) override { objects.erase(buffer); }
    void barrier(candela::Barrier) override { passes += "barrier;"; }
    void begin_pass(std::string_view name, std::uint32_t, const candela::PassTargets*) override {
        passes += std::string(name) + ";";
    }
    void end_pass() override {}
    void bind_texture(candela::ObjectId, const candela::TextureDesc&, candela::Binding) override {}
    void bind_buffer(candela::ObjectId buffer, candela::Binding binding) override {
        bound[binding.point] = buffer;
    }
    std::uint64_t texture_digest(candela::ObjectId) override { return 0; }
    std::uint64_t buffer_digest(candela::ObjectId) override { return 0; }

    std::map<candela::ObjectId, std::vector<std::byte>> objects;
    std::map<std::uint32_t, candela::ObjectId> bound;
    std::string passes;

 private:
    candela::ObjectId create(std::uint64_t bytes) {
        objects.emplace(++last_, std::vector<std::byte>(bytes));
        return last_;
    }
    candela::ObjectId last_ = 0;
};

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
    Memory memory;
    candela::GraphRuntime runtime(memory);
    candela::FrameGraph graph;
    const auto sum = graph.add("sum", [&](candela::Pass& pass) {
        pass.read<Number>();
        const auto out = pass.write(graph.buffer<int>("sum", 1), {candela::Usage::storage, 0});
        pass.run([=, &memory](candela::Execution& run) {
            int total = 0;
            for (const auto& [entity, number] : run.world().view<Number>()) total += number.value;
            reinterpret_cast<int&>(*memory.objects.at(run.object(out)).data()) = total;
        });
        return out;
    });
    const auto doubled = graph.add("double", [&](candela::Pass& pass) {
        pass.read(sum, {candela::Usage::storage, 0});
        const auto out = pass.write(graph.value<int>("doubled"));
        pass.side_effect();
        pass.run([=, &memory](candela::Execution& run) {
            run.set(out, 2 * reinterpret_cast<int&>(*memory.objects.at(memory.bound.at(0)).data()));
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
    good &= check(memory.passes.ends_with("sum;barrier;double;"), "the passes are not in order");
    memory.passes.clear();
    runtime.run(world);
    good &= check(memory.passes.find("sum") == std::string::npos, "a clean pass ran");
    world.set(entity, Number{0});
    runtime.run(world);
    good &= check(runtime.value(doubled) == 2, "a change was missed");
    good &= check(describe_text(describe(*runtime.graph())).find("double") != std::string::npos,
                  "no description");
    good &= check(std::string(CANDELA_VERSION).starts_with("0."), "no version");
    return good ? 0 : 1;
}
