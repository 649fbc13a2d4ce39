#include "tests/study/bench.hpp"

#include <fmt/ranges.h>
#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "renderer/facade/device_of.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::study {

Entity first_camera(const World& world) {
    const std::vector<Entity> cameras = sandbox::cameras(world);
    if (cameras.empty()) throw std::invalid_argument("the scene has no camera");
    return cameras.front();
}

Bench::Bench(const gl::GetProc& get_proc, const World& world, glm::uvec2 size)
    : world_(&world),
      camera_(first_camera(world)),
      renderer_(get_proc, {.keeps_gl_state = false}),
      target_(device_of(renderer_), "radiance", {size, Format::rgba32f}),
      framebuffer_(device_of(renderer_), "radiance") {
    framebuffer_.attach_colour(0, target_.name());
    framebuffer_.draw_buffers(1);
}

void Bench::configure(Configuration configuration) {
    configuration.tone_map.enabled = false;
    const std::vector<std::string> errors = renderer_.configure(configuration);
    if (!errors.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(errors, "; ")));
}

double Bench::frame(glm::vec2 jitter) {
    const auto start = std::chrono::steady_clock::now();
    renderer_.render(*world_, camera_, {framebuffer_.name(), target_.desc().size}, jitter);
    device_of(renderer_).gl().Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::optional<double> Bench::estimate_error() {
    const RenderView view{
        .camera = camera_, .target = {framebuffer_.name(), target_.desc().size}, .estimate_error = true};
    renderer_.render(*world_, {&view, 1});
    const std::optional<VplReport> vpls = renderer_.report().vpls;
    return vpls ? vpls->estimated_error : std::nullopt;
}

tools::Picture Bench::picture() const {
    const glm::uvec2 size = target_.desc().size;
    const std::vector<float> rgba = target_.read_floats();
    tools::Picture picture{glm::ivec2(size), {}};
    picture.pixels.reserve(rgba.size() / 4);
    // Row 0 of the GL is at the bottom.
    for (std::size_t row = size.y; row-- > 0;) {
        for (std::size_t i = 4 * row * size.x; i < 4 * (row + 1) * size.x; i += 4) {
            picture.pixels.emplace_back(rgba[i], rgba[i + 1], rgba[i + 2]);
        }
    }
    return picture;
}

std::size_t Bench::covered_pixels() const {
    const std::vector<float> rgba = target_.read_floats();
    std::size_t count = 0;
    for (std::size_t alpha = 3; alpha < rgba.size(); alpha += 4) {
        count += rgba[alpha] > 0.0F ? 1 : 0;
    }
    return count;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Errors mean(std::span<const Errors> errors) {
    const auto count = static_cast<double>(errors.size());
    Errors mean;
    for (const Errors& each : errors) {
        mean.rel_mse += each.rel_mse / count;
        mean.rmse += each.rmse / count;
        mean.bias += each.bias / count;
        mean.spikes += each.spikes / count;
        mean.blotch += each.blotch / count;
    }
    return mean;
}

}  // namespace candela::study
