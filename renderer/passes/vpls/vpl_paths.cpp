#include "renderer/passes/vpls/vpl_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <candela/graph/execute.hpp>

namespace candela {
namespace {

double power(const LightTable::Entry& entry) {
    return static_cast<double>(entry.flux.r) + static_cast<double>(entry.flux.g) +
           static_cast<double>(entry.flux.b);
}

/// Number of paths of one light.
struct Share {
    std::uint32_t light;
    std::uint32_t paths;
    double expected;  ///< number of paths before rounding
};

/// Distributes `count` paths by systematic sampling of the cumulative flux of the lights: each light gets its
/// expected number, rounded up or down, and the sum is exactly `count`.
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
        if (until > given) shares.push_back({i, until - given, expected});
        given = std::max(given, until);
    }
    return shares;
}

/// Offset, between 0 and 1, of the first path of a light in the stratified survival test (see bounces_of). It
/// differs from light to light, so that lights with a single path each make different numbers of bounces.
double ladder_offset(std::uint32_t light) {
    constexpr double golden = 0.6180339887498949;
    return std::fmod((light + 0.5) * golden, 1.0);
}

/// Number of bounces of a path at `position` = (j + offset) / paths: one, and one more for each k ≥ 1 with
/// position < ρᵏ, at most `limit`. ρ is `albedo`.
std::uint32_t bounces_of(double position, double albedo, std::uint32_t limit) {
    std::uint32_t bounces = 1;
    for (double survival = albedo; bounces < limit && position < survival; survival *= albedo) {
        ++bounces;
    }
    return bounces;
}

std::uint32_t hashed(std::uint32_t seed, std::uint32_t value) {
    std::uint64_t x = (static_cast<std::uint64_t>(seed) << 32U | value) + 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;  // finalizer of SplitMix64 (Steele et al., 2014)
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
            paths.push_back({.flux = entry.flux,
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

/// Share of the light's flux that each of its paths starts with. Of the lights whose expected number of paths
/// is below 1 only some get a path; their weight 1 / expected makes them carry the flux of similar lights
/// that get none.
double start_weight(const Share& share) {
    return 1.0 / (share.expected >= 1.0 ? share.paths : share.expected);
}

/// By i from 0 to max_bounces: number of paths that make more than i bounces.
std::vector<std::uint32_t> count_reach(const PathPlan& plan) {
    std::vector<std::uint32_t> reach(plan.max_bounces + 1, 0);
    for (const gpu::Path& path : plan.paths) {
        for (std::uint32_t i = 0; i < path.vpl_count; ++i) {
            ++reach[i];
        }
    }
    return reach;
}

/// Weights of Russian roulette: paths that continue from a bounce also carry the flux of those that end
/// there.
std::vector<float> make_weights(const PathPlan& plan, const std::vector<Share>& shares) {
    const std::vector<std::uint32_t> reach = count_reach(plan);
    std::vector<float> weights;
    weights.reserve(plan.vpl_count);
    auto share = shares.begin();
    for (const gpu::Path& path : plan.paths) {
        share += path.light != share->light ? 1 : 0;
        double weight = start_weight(*share);
        for (std::uint32_t i = 0; i < path.vpl_count; ++i) {
            weights.push_back(static_cast<float>(weight));
            weight *= static_cast<double>(reach[i]) / std::max(reach[i + 1], 1U);
        }
    }
    return weights;
}

}  // namespace

PathPlan plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings) {
    PathPlan plan;
    if (lights.entries.empty() || settings.count == 0 || settings.bounces == 0) return plan;
    const double albedo = std::clamp(static_cast<double>(mean_albedo), 0.0, 1.0);
    double vpls_per_path = 0.0;
    double survival = 1.0;
    for (std::uint32_t k = 0; k < settings.bounces && survival > 1e-6; ++k, survival *= albedo) {
        vpls_per_path += survival;
    }
    // Numbers of bounces are rounded for each light: search for the largest number of paths that fits.
    auto count = static_cast<std::uint32_t>(settings.count / vpls_per_path) + 1;
    plan.paths = make_paths(lights, albedo, count, settings);
    while (count > 1 && vpls_of(plan.paths) > settings.count) {
        const std::uint32_t excess = vpls_of(plan.paths) - settings.count;
        const auto fewer = static_cast<std::uint32_t>(excess / vpls_per_path);
        count -= std::clamp(fewer, 1U, count - 1);
        plan.paths = make_paths(lights, albedo, count, settings);
    }
    // A single path may still be too long.
    plan.paths.back().vpl_count = std::min(plan.paths.back().vpl_count, settings.count);
    plan.vpl_count = vpls_of(plan.paths);
    for (const gpu::Path& path : plan.paths) {
        plan.max_bounces = std::max(plan.max_bounces, path.vpl_count);
    }
    plan.weights = make_weights(plan, share_paths(lights, count));
    return plan;
}

ValueHandle<PathPlan> add_vpl_paths(FrameGraph& graph, ValueHandle<SceneMetrics> metrics,
                                    ValueHandle<LightTable> lights,
                                    std::optional<ValueHandle<Refinement>> refinement,
                                    const VplSettings& settings) {
    return graph.add("vpl-paths", [&](Pass& pass) {
        pass.read(lights);
        pass.read(metrics);
        if (refinement) pass.read(*refinement);
        pass.parameter(settings);
        const auto paths = pass.write(graph.value<PathPlan>("vpl paths"));
        pass.run([=](Execution& run) {
            VplSettings of_set = settings;
            of_set.seed += refinement ? run.value(*refinement).set : 0;
            run.set(paths, plan_paths(run.value(lights), run.value(metrics).mean_albedo, of_set));
        });
        return paths;
    });
}

}  // namespace candela
