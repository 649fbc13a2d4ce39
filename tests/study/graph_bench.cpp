// The cost of the frame graph itself: declaring and compiling, and running passes that do nothing, for 10 to
// 10,000 passes. `per_pass` is the relevant figure.

#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include <candela/graph/frame_graph.hpp>
#include "tests/study/study.hpp"

namespace {

using namespace candela;

/// For each pass, the passes whose results it reads; at most three.
using Wiring = std::vector<std::vector<std::size_t>>;

Wiring chain(std::size_t passes) {
    Wiring reads(passes);
    for (std::size_t pass = 1; pass < passes; ++pass) {
        reads[pass] = {pass - 1};
    }
    return reads;
}

/// Each pass reads three earlier ones.
Wiring random_dag(std::size_t passes) {
    std::mt19937 random(1);
    Wiring reads(passes);
    for (std::size_t pass = 1; pass < passes; ++pass) {
        for (int read = 0; read < 3; ++read) {
            reads[pass].push_back(random() % pass);
        }
    }
    return reads;
}

/// One pass, two that read it, one that reads both, and so on: the number of paths doubles with every
/// diamond.
Wiring diamonds(std::size_t passes) {
    Wiring reads(passes);
    for (std::size_t pass = 1; pass < passes; ++pass) {
        switch (pass % 3) {
            case 0:
                reads[pass] = {pass - 1, pass - 2};
                break;
            case 1:
                reads[pass] = {pass - 1};
                break;
            default:
                reads[pass] = {pass - 2};
                break;
        }
    }
    return reads;
}

struct Plans {
    Wiring reads;
    std::vector<std::string> names;
    std::vector<bool> unread;  // by pass: no pass reads its result
};

Plans plans(Wiring reads) {
    Plans plans{std::move(reads), {}, {}};
    plans.unread.assign(plans.reads.size(), true);
    for (std::size_t pass = 0; pass < plans.reads.size(); ++pass) {
        plans.names.push_back("pass " + std::to_string(pass));
        for (const std::size_t read : plans.reads[pass]) {
            plans.unread[read] = false;
        }
    }
    return plans;
}

/// Kinds of passes: plain ones, some whose functions own memory, and some whose writes need barriers.
enum class Passes : std::uint8_t { plain, owning, storing };

/// Every pass writes a texture. Passes whose result is not read have a side effect, so that nothing is
/// culled.
FrameGraph declare(const Plans& plans, std::vector<TextureHandle>& made, bool all_run,
                   Passes kind = Passes::plain) {
    FrameGraph graph;
    std::uint64_t ran = 0;
    for (std::size_t index = 0; index < plans.reads.size(); ++index) {
        made[index] = graph.add(plans.names[index], [&](Pass& pass) {
            for (const std::size_t read : plans.reads[index]) {
                pass.read(made[read], Usage::sampled);
            }
            if (all_run || plans.unread[index]) pass.side_effect();
            if (kind == Passes::owning) {
                pass.run([list = std::vector{index}, ran](Execution&) mutable {
                    benchmark::DoNotOptimize(ran += list.front());
                });
            } else {
                pass.run([index, ran](Execution&) mutable { benchmark::DoNotOptimize(ran += index); });
            }
            const Usage usage = kind == Passes::storing ? Usage::storage : Usage::colour_target;
            return pass.write(graph.texture("result", {{64, 64}, Format::rgba16f}), usage);
        });
    }
    return graph;
}

class Idle final : public Backend {
 public:
    ObjectId create_texture(std::string_view, const TextureDesc&) override { return ++created_; }
    ObjectId create_buffer(std::string_view, const BufferDesc&) override { return ++created_; }
    void destroy_texture(ObjectId) override {}
    void destroy_buffer(ObjectId) override {}
    void barrier(Barrier) override {}
    void begin_pass(std::string_view, std::uint32_t, const PassTargets*) override {}
    void end_pass() override {}
    void bind_texture(ObjectId, const TextureDesc&, Binding) override {}
    void bind_buffer(ObjectId, Binding) override {}
    std::uint64_t texture_digest(ObjectId) override { return 0; }
    std::uint64_t buffer_digest(ObjectId) override { return 0; }

 private:
    ObjectId created_ = 0;
};

void count(benchmark::State& state) {
    const auto passes = static_cast<double>(state.range(0));
    state.counters["per_pass"] = benchmark::Counter(
        passes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build_and_compile(benchmark::State& state, Wiring (*wiring)(std::size_t), Passes kind = Passes::plain) {
    const Plans plan = plans(wiring(static_cast<std::size_t>(state.range(0))));
    std::vector<TextureHandle> made(plan.reads.size());
    for (auto _ : state) {
        benchmark::DoNotOptimize(compile(declare(plan, made, false, kind)));
    }
    count(state);
}

void run_idle_passes(benchmark::State& state, Wiring (*wiring)(std::size_t)) {
    const Plans plan = plans(wiring(static_cast<std::size_t>(state.range(0))));
    std::vector<TextureHandle> made(plan.reads.size());
    Idle backend;
    GraphRuntime runtime(backend);
    runtime.switch_to(compile(declare(plan, made, true)).take());
    const World world;
    for (auto _ : state) {
        benchmark::DoNotOptimize(runtime.run(world).passes.data());
    }
    count(state);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
    for (const std::int64_t passes : {10, 100, 1'000, 10'000}) {
        benchmark->Arg(passes);
    }
}

BENCHMARK_CAPTURE(build_and_compile, chain, chain)->Apply(sizes);
BENCHMARK_CAPTURE(build_and_compile, random_dag, random_dag)->Apply(sizes);
BENCHMARK_CAPTURE(build_and_compile, diamonds, diamonds)->Apply(sizes);
BENCHMARK_CAPTURE(build_and_compile, owning_chain, chain, Passes::owning)->Apply(sizes);
BENCHMARK_CAPTURE(build_and_compile, storing_chain, chain, Passes::storing)->Apply(sizes);
BENCHMARK_CAPTURE(build_and_compile, storing_dag, random_dag, Passes::storing)->Apply(sizes);
BENCHMARK_CAPTURE(run_idle_passes, chain, chain)->Apply(sizes);
BENCHMARK_CAPTURE(run_idle_passes, random_dag, random_dag)->Apply(sizes);
BENCHMARK_CAPTURE(run_idle_passes, diamonds, diamonds)->Apply(sizes);

}  // namespace

int candela::study::graph(int count, char** arguments) {
    return run_benchmarks(count, arguments);
}

int candela::study::run_benchmarks(int count, char** arguments) {
    benchmark::Initialize(&count, arguments);
    if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
