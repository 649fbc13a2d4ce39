#include "sandbox/headless/report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>

#include <candela/tools/picture_error.hpp>
#include <candela/tools/run_report.hpp>

namespace candela::sandbox {

namespace {

std::string pass_table(const FrameReport& frame) {
    std::string table = fmt::format("{:<16} {:>4} {:>10} {:>10}\n", "pass", "ran", "CPU ms", "GPU ms");
    for (const PassReport& pass : frame.passes) {
        table += fmt::format("{:<16} {:>4} {:>10.3f} {:>10.3f}\n", pass.name, pass.ran ? "yes" : "-",
                             pass.cpu_ms, pass.gpu_ms);
    }
    return table + fmt::format("{:<21} {:>10.3f} {:>10.3f}\n", "frame", frame.cpu_ms, frame.gpu_ms);
}

std::string light_table(const LightReport& lights) {
    std::string table = fmt::format("lights           {}, {} with a shadow map, {} shadowed by rays alone\n",
                                    lights.count, lights.with_map, lights.without_map);
    if (lights.tile_max == 0) return table;
    return table + fmt::format("  in a list      {:.1f} in the mean, {} at most; {} in every one\n",
                               lights.tile_mean, lights.tile_max, lights.global);
}

std::string vpl_table(const VplReport& vpls) {
    std::string table = fmt::format("VPLs             {} alive of {} requested", vpls.alive, vpls.requested);
    table += vpls.paths > 0 ? fmt::format(", on {} paths\n", vpls.paths) : "\n";
    if (vpls.waiting > 0) table += fmt::format("  waiting        {} to be traced\n", vpls.waiting);
    if (vpls.interleave > 1) {
        table += fmt::format("  of which       a pixel asks one in {}; {} pixels asked more\n",
                             vpls.interleave * vpls.interleave, vpls.filled_pixels);
    }
    if (vpls.estimated_error) {
        table += fmt::format("  error          relMSE {:.2g}, estimated\n", *vpls.estimated_error);
    }
    for (const tools::EnergyLine& line : tools::energy_lines(vpls.flux)) {
        table += fmt::format("  {:<14} {:>12.6g} {:>12.6g} {:>12.6g}\n", line.name, line.value.r,
                             line.value.g, line.value.b);
    }
    return table +
           fmt::format("  unaccounted for {:.2e} of the emitted flux\n", relative_residual(vpls.flux));
}

}  // namespace

std::string to_table(const FrameReport& frame, const Report& state) {
    std::string table = pass_table(frame);
    table += fmt::format("triangles        {}\n", state.triangles);
    if (state.refined > 0) table += fmt::format("refined          {} frames in the mean\n", state.refined);
    table += light_table(state.lights);
    return state.vpls ? table + vpl_table(*state.vpls) : table;
}

double relative_residual(const EnergyAccount& flux) {
    const glm::dvec3 rest = flux.emitted - flux.absorbed - flux.escaped - flux.truncated - flux.roulette;
    double largest = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
        if (!std::isfinite(rest[channel])) return std::numeric_limits<double>::infinity();
        if (flux.emitted[channel] > 0.0) {
            largest = std::max(largest, glm::abs(rest[channel]) / flux.emitted[channel]);
        }
    }
    return largest;
}

void check_finite(const tools::Picture& picture, int frame) {
    const auto is_finite = [](const glm::vec3& pixel) {
        return std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b);
    };
    const auto wrong = std::ranges::count_if(picture.pixels, std::not_fn(is_finite));
    if (wrong == 0) return;
    const glm::ivec2 first = *tools::first_not_finite(picture);
    throw PictureError(fmt::format("frame {}: {} pixels are not finite, the first in column {} of row {}",
                                   frame, wrong, first.x, first.y));
}

void check_energy(const std::string& scene, const Report& state) {
    // The account of surfels is only as accurate as they are dense: a residual with few surfels is not an
    // error.
    const bool is_traced = state.vpls && state.vpls->paths > 0;
    const double most = is_traced ? 0.01 : std::numeric_limits<double>::max();
    const double residual = state.vpls ? relative_residual(state.vpls->flux) : 0.0;
    if (residual > most) {
        throw PictureError(
            fmt::format("{}: {:.3g} % of the emitted flux is unaccounted for: the picture is wrong", scene,
                        100.0 * residual));
    }
}

}  // namespace candela::sandbox
