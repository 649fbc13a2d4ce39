// What Renderer::report tells, read back from the last frame.

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vector_relational.hpp>
#include <numeric>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "renderer/facade/renderer_state.hpp"

namespace candela {
namespace {

/// Standard error of the sum of independent terms, per channel.
glm::dvec3 standard_error(const std::vector<glm::dvec3>& terms) {
    if (terms.size() < 2) return glm::dvec3(0.0);
    const auto n = static_cast<double>(terms.size());
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& term : terms) {
        sum += term;
    }
    glm::dvec3 squares(0.0);
    for (const glm::dvec3& term : terms) {
        squares += (term - sum / n) * (term - sum / n);
    }
    return glm::sqrt(squares * n / (n - 1.0));
}

/// VPLs that send light.
template <class Vpl>
std::uint32_t count_alive(const std::vector<Vpl>& vpls) {
    const auto sends = [](const Vpl& vpl) { return vpl.flux != glm::vec3(0.0F); };
    return static_cast<std::uint32_t>(std::ranges::count_if(vpls, sends));
}

/// A path traces one ray per hit, and one more if it leaves the scene.
std::uint32_t count_rays(const std::vector<gpu::Path>& paths, const std::vector<gpu::TracedVpl>& vpls) {
    std::uint32_t rays = 0;
    for (const gpu::Path& path : paths) {
        const auto first = vpls.begin() + path.first_vpl;
        const auto hits = static_cast<std::uint32_t>(std::count_if(
            first, first + path.vpl_count, [](const auto& vpl) { return vpl.state == VPL_PLACED; }));
        rays += std::min(hits + 1, path.vpl_count);
    }
    return rays;
}

EnergyAccount sum_up(const std::vector<gpu::FluxAccount>& accounts) {
    EnergyAccount total;
    std::vector<glm::dvec3> roulette;
    for (const gpu::FluxAccount& account : accounts) {
        total.emitted += account.emitted;
        total.absorbed += account.absorbed;
        total.escaped += account.escaped;
        total.truncated += account.truncated;
        total.roulette += account.roulette;
        roulette.emplace_back(account.roulette);
    }
    total.roulette_error = standard_error(roulette);
    return total;
}

void warn_of_few_vpls(Log& log, const VplReport& vpls) {
    // A pixel is then off by about a third, and blotches of light are mistaken for shadows.
    constexpr double most = 0.1;
    if (*vpls.estimated_error > most) {
        log.warn(
            fmt::format("{0} VPLs are too few for this view: its indirect light is off by about a third or "
                        "more; set \"vpls\": {{\"count\": {1}}} or more",
                        vpls.requested, 4 * std::max(vpls.requested, 64U)));
    }
}

/// Where next to nothing is absorbed, the light of a closed room is what rounding and bounds make of it.
void warn_of_white_rooms(Log& log, std::span<const gpu::LitSurfel> lit, const EnergyAccount& flux) {
    constexpr double most = 1100.0;  // an albedo of 0.999 has 1,000
    glm::dvec3 reflected(0.0);
    for (const gpu::LitSurfel& surfel : lit) reflected += glm::dvec3(surfel.flux);
    if (glm::any(glm::greaterThan(reflected, most * flux.emitted))) {
        log.warn(
            "the surfaces reflect the light more than 1,100 times, as in a closed room that absorbs "
            "next to nothing: an albedo above 0.9992 counts as 0.9992");
    }
}

}  // namespace

VplReport Renderer::State::report_vpls(const Vpls& vpls, const ViewHandles& view) {
    const auto read = [&]<class T>(BufferHandle<T> buffer, std::size_t count) {
        return backend_.buffer(runtime_.object(buffer)).template download<T>(count);
    };
    const VplCounts& counts = runtime_.value(vpls.counts);
    VplReport report{.requested = configuration_.vpls.count,
                     .waiting = schedule_.waiting(),
                     .interleave = view.interleave,
                     .filled_pixels = count_filled(view),
                     .flux = sum_up(read(vpls.flux, counts.accounts)),
                     .estimated_error = estimate_error(view)};
    if (const auto* const traced = std::get_if<TracedVpls>(&vpls.records)) {
        const PathPlan& plan = runtime_.value(traced->plan);
        const std::vector<gpu::TracedVpl> placed = read(traced->vpls, counts.traced);
        report.alive = count_alive(placed);
        report.paths = static_cast<std::uint32_t>(plan.paths.size());
        report.rays = count_rays(plan.paths, placed);
        return report;
    }
    const auto& lit = std::get<LitSurfels>(vpls.records);
    const std::vector<gpu::LitSurfel> surfels = read(lit.surfels, counts.surfels);
    warn_of_white_rooms(gpu_.log(), surfels, report.flux);
    report.alive = count_alive(surfels);
    if (lit.emitters) report.alive += count_alive(read(*lit.emitters, counts.emitters));
    return report;
}

std::uint32_t Renderer::State::count_filled(const ViewHandles& view) const {
    if (!view.indirect) return 0;
    return backend_.buffer(runtime_.object(view.indirect->fill_list)).download<std::uint32_t>(4).at(3);
}

std::optional<double> Renderer::State::estimate_error(const ViewHandles& view) const {
    if (!view.samples) return std::nullopt;
    const auto read = [&](VplSamples samples) {
        return backend_.buffer(runtime_.object(samples)).download<glm::vec4>();
    };
    return estimated_error(read(view.samples->shown), read(view.samples->other));
}

LightReport Renderer::State::report_lights(const ViewHandles& view) const {
    LightReport report{.count =
                           static_cast<std::uint32_t>(runtime_.value(frame_.lights.table).entries.size())};
    if (!shows_light(configuration_.show)) {
        return report;  // shadow maps are culled
    }
    const ShadowPlan& shadows = runtime_.value(frame_.lights.shadows.plan);
    report.with_map = shadows.cubes + shadows.maps;
    report.shadow_views = runtime_.value(frame_.lights.shadows.drawn).newly_drawn;
    report.without_map = shadows.by_rays;
    if (!view.lists) return report;
    const LightBins& bins = runtime_.value(view.lists->bins);
    const auto counts =
        backend_.buffer(runtime_.object(view.lists->count)).download<std::uint32_t>(bins.grid.cells());
    report.global = bins.global_count;
    report.tile_max = bins.global_count + *std::ranges::max_element(counts);
    report.tile_mean =
        bins.global_count + std::accumulate(counts.begin(), counts.end(), 0.0) / bins.grid.cells();
    return report;
}

Report Renderer::State::report(std::size_t index) {
    const ViewHandles& view = view_handles(index);
    Report report{.gl_renderer = gpu_.device().renderer(),
                  .triangles = runtime_.value(frame_.metrics).triangles,
                  .vpls = std::nullopt,
                  .refined = view.averaged ? runtime_.value(*view.averaged) + 1 : 0,
                  .rendered_size = view.parts.size,
                  .lights = report_lights(view),
                  .memory = runtime_.memory()};
    if (frame_.vpls && configuration_.show != Show::direct) {
        report.vpls = report_vpls(*frame_.vpls, view);
        if (report.vpls->estimated_error) warn_of_few_vpls(gpu_.log(), *report.vpls);
    }
    return report;
}

}  // namespace candela
