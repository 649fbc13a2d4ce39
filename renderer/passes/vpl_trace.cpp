#include "renderer/passes/vpl_trace.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/graph/execute.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr std::uint32_t group_size = 32;  // as in shaders/vpl_trace.comp
// Rays leave a surface this far above it, relative to the scene's radius: some hundred times the rounding of
// positions.
constexpr float relative_ray_offset = 2e-5F;

double power(const LightTable::Entry& entry) {
    return static_cast<double>(entry.flux.r) + static_cast<double>(entry.flux.g) +
           static_cast<double>(entry.flux.b);
}

/// Paths of one light.
struct Share {
    std::uint32_t light;
    std::uint32_t paths;
    double expected;  ///< the share before rounding
};

/// Shares `count` paths out by systematic sampling of the lights' cumulative flux: each gets its expected
/// share, rounded up or down, and the sum is right.
std::vector<Share> share_paths(const LightTable& lights, std::uint32_t count) {
    const double total = std::accumulate(lights.entries.begin(), lights.entries.end(), 0.0,
                                         [](double sum, const auto& entry) { return sum + power(entry); });
    std::vector<Share> shares;
    double cumulative = 0.0;
    std::uint32_t given = 0;
    for (std::uint32_t i = 0; i < lights.entries.size(); ++i) {
        const double expected = count * power(lights.entries[i]) / total;
        cumulative += expected;
        const bool last = i + 1 == lights.entries.size();
        const std::uint32_t until =
            last ? count : std::min(count, static_cast<std::uint32_t>(std::llround(cumulative)));
        if (until > given) {
            shares.push_back({i, until - given, expected});
        }
        given = std::max(given, until);
    }
    return shares;
}

/// Where between 0 and 1 a light's first path lies on the ladder of survival, so that the lights of one path
/// each differ in how far they get.
double ladder_offset(std::uint32_t light) {
    constexpr double golden = 0.6180339887498949;
    return std::fmod((light + 0.5) * golden, 1.0);
}

/// Bounces of path `j` of `paths`: one, and one more for each k with (j + offset) / paths < ρᵏ.
std::uint32_t bounces_of(double position, double albedo, std::uint32_t limit) {
    std::uint32_t bounces = 1;
    for (double survival = albedo; bounces < limit && position < survival; survival *= albedo) {
        ++bounces;
    }
    return bounces;
}

/// Flux that each path of a light starts with. A light whose share is below one path stands for its like.
glm::vec3 path_flux(const LightTable::Entry& entry, const Share& share) {
    const double paths = share.expected >= 1.0 ? share.paths : share.expected;
    return entry.flux / static_cast<float>(paths);
}

std::uint32_t hashed(std::uint32_t seed, std::uint32_t value) {
    std::uint64_t x = (static_cast<std::uint64_t>(seed) << 32U | value) + 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;  // the finalizer of SplitMix64 (Steele et al., 2014)
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<std::uint32_t>(x >> 32U);
}

std::vector<gpu::Path> make_paths(const LightTable& lights, double albedo, std::uint32_t count,
                                  const VplSettings& settings) {
    std::vector<gpu::Path> paths;
    std::uint32_t first_vpl = 0;
    for (const Share& share : share_paths(lights, count)) {
        const LightTable::Entry& entry = lights.entries[share.light];
        for (std::uint32_t j = 0; j < share.paths; ++j) {
            const double position = (j + ladder_offset(share.light)) / share.paths;
            paths.push_back({.flux = path_flux(entry, share),
                             .light = share.light,
                             .index = j,
                             .seed = hashed(settings.seed, entry.entity.index),
                             .first_vpl = first_vpl,
                             .vpl_count = bounces_of(position, albedo, settings.bounces)});
            first_vpl += paths.back().vpl_count;
        }
    }
    return paths;
}

std::uint32_t vpls_of(const std::vector<gpu::Path>& paths) {
    return paths.empty() ? 0 : paths.back().first_vpl + paths.back().vpl_count;
}

/// Ratios of the numbers of paths that reach each bounce and the next.
std::vector<float> continuation_weights(const std::vector<gpu::Path>& paths, std::uint32_t max_bounces) {
    std::vector<std::uint32_t> reach(max_bounces + 1, 0);  // paths that make more than i bounces
    for (const gpu::Path& path : paths) {
        for (std::uint32_t i = 0; i < path.vpl_count; ++i) {
            ++reach[i];
        }
    }
    std::vector<float> weights;
    for (std::uint32_t i = 0; i + 1 < max_bounces; ++i) {
        weights.push_back(static_cast<float>(reach[i]) / static_cast<float>(reach[i + 1]));
    }
    return weights;
}

void trace(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing,
           const Vpls& out) {
    const VplPaths& plan = run.value(out.paths);
    run.reserve(out.vpls, std::max(plan.vpl_count, 1U));
    run.reserve(out.flux, std::max<std::size_t>(plan.paths.size(), 1));
    if (plan.paths.empty()) {
        return;
    }

    const auto path_count = static_cast<std::uint32_t>(plan.paths.size());
    bind_tracing(gpu, run, program, tracing);
    gpu.bind_storage(BINDING_VPLS, run.object(out.vpls));
    gpu.bind_storage(BINDING_FLUX, run.object(out.flux));
    program.set("path_count", path_count);
    program.set("max_bounces", plan.max_bounces);
    program.set("ray_offset", relative_ray_offset * run.value(tracing.metrics).radius());
    program.use();
    gpu.gl().DispatchCompute((path_count + group_size - 1) / group_size, 1, 1);
}

/// The plan and its buffers.
struct PlannedPaths {
    ValueHandle<VplPaths> plan;
    BufferHandle<gpu::Path> paths;
    BufferHandle<float> continuation;
};

PlannedPaths add_vpl_paths(FrameGraph& graph, const Gpu& gpu, ValueHandle<SceneMetrics> metrics,
                           ValueHandle<LightTable> lights, const VplSettings& settings) {
    return graph.add("vpl-paths", [&](Pass& pass) {
        pass.read(lights);
        pass.read(metrics);
        pass.parameter(settings);
        const PlannedPaths out{
            .plan = pass.write(graph.value<VplPaths>("vpl paths")),
            .paths = pass.write(graph.buffer<gpu::Path>("paths", 1, Lifetime::persistent), Usage::copy),
            .continuation =
                pass.write(graph.buffer<float>("continuation", 1, Lifetime::persistent), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            VplPaths plan = plan_paths(run.value(lights), run.value(metrics).mean_albedo, settings);
            upload<gpu::Path>(gpu, run, out.paths, plan.paths);
            upload<float>(gpu, run, out.continuation, plan.continuation);
            run.set(out.plan, std::move(plan));
        });
        return out;
    });
}

}  // namespace

VplPaths plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings) {
    VplPaths plan;
    if (lights.entries.empty() || settings.count == 0 || settings.bounces == 0) {
        return plan;
    }
    const double albedo = std::clamp(static_cast<double>(mean_albedo), 0.0, 1.0);
    double vpls_per_path = 0.0;
    double survival = 1.0;
    for (std::uint32_t k = 0; k < settings.bounces && survival > 1e-6; ++k, survival *= albedo) {
        vpls_per_path += survival;
    }
    // The ladder of survival rounds, light by light; take as many paths as fit.
    auto count = static_cast<std::uint32_t>(settings.count / vpls_per_path) + 1;
    plan.paths = make_paths(lights, albedo, count, settings);
    while (count > 1 && vpls_of(plan.paths) > settings.count) {
        const std::uint32_t excess = vpls_of(plan.paths) - settings.count;
        const auto fewer = static_cast<std::uint32_t>(excess / vpls_per_path);
        count -= std::clamp(fewer, 1U, count - 1);
        plan.paths = make_paths(lights, albedo, count, settings);
    }
    plan.paths.back().vpl_count =
        std::min(plan.paths.back().vpl_count, settings.count);  // a single path may be too long
    plan.vpl_count = vpls_of(plan.paths);
    for (const gpu::Path& path : plan.paths) {
        plan.max_bounces = std::max(plan.max_bounces, path.vpl_count);
    }
    plan.continuation = continuation_weights(plan.paths, plan.max_bounces);
    return plan;
}

Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, ValueHandle<LightTable> lights,
                   BufferHandle<gpu::Light> light_buffer, const VplSettings& settings) {
    const PlannedPaths planned = add_vpl_paths(graph, gpu, tracing.metrics, lights, settings);
    return graph.add("vpl-trace", [&](Pass& pass) {
        pass.read(planned.plan);
        pass.read(planned.paths, Usage::storage);
        pass.read(planned.continuation, Usage::storage);
        pass.read(light_buffer, Usage::storage);
        read_tracing(pass, tracing);
        const gl::Program& program = gpu.program({"vpl_trace.comp"});
        const Vpls out{
            .paths = planned.plan,
            .vpls = pass.write(graph.buffer<gpu::Vpl>("vpls", 1, Lifetime::persistent), Usage::storage),
            .flux =
                pass.write(graph.buffer<gpu::FluxAccount>("flux", 1, Lifetime::persistent), Usage::storage)};
        pass.run([=, &gpu, &program](Execution& run) {
            gpu.bind_storage(BINDING_LIGHTS, run.object(light_buffer));
            gpu.bind_storage(BINDING_PATHS, run.object(planned.paths));
            gpu.bind_storage(BINDING_CONTINUATION, run.object(planned.continuation));
            trace(gpu, run, program, tracing, out);
        });
        return out;
    });
}

}  // namespace candela
