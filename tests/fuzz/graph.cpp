// Declaring frame graphs. The first byte chooses between two properties: a valid graph computes what it
// declares, frame after frame; and a graph in which anything is declared either compiles and runs, or is
// refused with errors.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/graph/recording_backend.hpp>
#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_machine.hpp"
#include "tests/engine/graph_random.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace candela;

namespace {

/// The input as a sequence of choices; all are 0 after its end.
class Choices {
 public:
    explicit Choices(std::span<const std::uint8_t> bytes) : left_(bytes) {}

    std::size_t operator()(std::size_t count) {
        if (left_.empty()) return 0;
        const std::size_t byte = left_.front();
        left_ = left_.subspan(1);
        return byte % count;
    }
    [[nodiscard]] bool at_end() const { return left_.empty(); }

 private:
    std::span<const std::uint8_t> left_;
};

/// The graphs and the checks of the random tests.
void check_contents(Choices choices) {
    random_graph::choose = [&choices](std::size_t count) { return choices(count); };
    const random_graph::Graph graph = random_graph::make({.passes = 20});
    random_graph::Host host = random_graph::make_host(graph);
    random_graph::Machine machine(graph);
    machine.runtime().set_verification(true);
    for (int frame = 0; frame < 3; ++frame) {
        const auto expected = meaning(graph, *machine.runtime().graph(), host);
        machine.provide(host);
        (void)machine.run();
        machine.check(expected);
        machine.runtime().verify(machine.world());
        machine.check(expected);
        edit(host);
    }
}

using Handle = std::variant<TextureHandle, BufferHandle<float>, ValueHandle<int>>;

/// Declares whatever the input says: handles of any version, of any resource, in any order.
class Declarer {
 public:
    explicit Declarer(Choices& choices) : choices_(choices) {}

    FrameGraph declare() {
        for (int step = 0; step < 64 && !choices_.at_end(); ++step) {
            declare_step();
        }
        return std::move(graph_);
    }

 private:
    void declare_step() {
        switch (choices_(8)) {
            case 0:
                handles_.emplace_back(graph_.texture(name("r"), texture(), lifetime()));
                return;
            case 1:
                handles_.emplace_back(graph_.buffer<float>(name("r"), choices_(4), lifetime()));
                return;
            case 2:
                handles_.emplace_back(choices_(2) == 0 ? graph_.value<int>(name("r"))
                                                       : graph_.import_value<int>(name("r")));
                return;
            case 3:
                declare_in_scope();
                return;
            default:
                graph_.add(name("p"), [this](Pass& pass) { declare_pass(pass); });
        }
    }

    void declare_in_scope() {
        const auto key = choices_(2) == 0 ? std::optional<std::string_view>("*") : std::nullopt;
        const Scope scope = graph_.scope({.name_ending = "'", .key_ending = key});
        for (std::size_t steps = choices_(4); steps > 0 && !choices_.at_end(); --steps) {
            declare_step();
        }
    }

    void declare_pass(Pass& pass) {
        for (std::size_t accesses = choices_(4); accesses > 0; --accesses) {
            std::visit([&](auto handle) { access(pass, handle); }, any_handle());
        }
        if (choices_(4) == 0) pass.side_effect();
        if (choices_(8) == 0) {
            graph_.add(name("p"), [](Pass&) {});  // nested
        }
    }

    template <class GpuHandle>
    void access(Pass& pass, GpuHandle handle) {
        const Binding binding(static_cast<Usage>(choices_(10)), static_cast<std::uint32_t>(choices_(16)));
        switch (choices_(3)) {
            case 0:
                pass.read(handle, binding);
                return;
            case 1:
                handles_.emplace_back(pass.write(handle, binding));
                return;
            default:
                handles_.emplace_back(pass.update(handle, binding));
        }
    }
    void access(Pass& pass, ValueHandle<int> handle) {
        if (choices_(2) == 0) {
            pass.read(handle);
        } else {
            handles_.emplace_back(pass.write(handle));
        }
    }

    Handle any_handle() {
        const std::size_t chosen = choices_(handles_.size() + 1);
        return chosen < handles_.size() ? handles_[chosen] : Handle(TextureHandle{{7, 7, 7}});
    }

    std::string name(std::string_view kind) { return std::string(kind) + std::to_string(choices_(12)); }
    Lifetime lifetime() { return static_cast<Lifetime>(choices_(3)); }
    TextureDesc texture() {
        const auto side = static_cast<std::uint32_t>(choices_(3) * 8);
        return {{side, side},
                static_cast<Format>(choices_(10)),
                static_cast<TextureShape>(choices_(3)),
                static_cast<std::uint32_t>(choices_(8)),
                static_cast<std::uint32_t>(choices_(6))};
    }

    Choices& choices_;
    FrameGraph graph_;
    std::vector<Handle> handles_;
};

void check_refused(const std::vector<CompileError>& errors) {
    fuzz::require(!errors.empty(), "a graph, or errors");
    for (const CompileError& error : errors) {
        fuzz::require_readable(error.message);
    }
}

/// Three frames; what the host has not provided is an error.
void run_frames(CompiledGraph compiled) {
    RecordingBackend backend;
    {
        GraphRuntime runtime(backend);
        World world;
        runtime.switch_to(std::move(compiled));
        try {
            for (int frame = 0; frame < 3; ++frame) {
                (void)runtime.run(world);
            }
        } catch (const GraphError& error) {
            fuzz::require_readable(error.what());
        }
    }
    fuzz::require(backend.misuse.empty(), "the backend is used correctly: " + backend.misuse);
    fuzz::require(backend.objects.empty() && backend.open_passes == 0, "nothing is left open");
}

void check_declaration(Choices choices) {
    CompileResult result = compile(Declarer(choices).declare());
    if (!result) {
        check_refused(result.errors);
        return;
    }
    fuzz::require(!describe_text(describe(*result.graph)).empty(), "a graph can be described");
    run_frames(std::move(result).take());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 0) {
        const Choices choices({data + 1, size - 1});
        data[0] % 2 == 0 ? check_contents(choices) : check_declaration(choices);
    }
    return 0;
}
