#include <fmt/ranges.h>
#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "engine/scene/components.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

Entity first_camera(const World& world) {
    for (const auto& [entity, camera] : world.view<Camera>()) {
        return entity;
    }
    throw std::invalid_argument("the scene has no camera");
}

}  // namespace

Bench::Bench(const gl::GetProc& get_proc, const World& world, glm::uvec2 size)
    : world_(&world),
      camera_(first_camera(world)),
      renderer_(get_proc),
      target_(renderer_.device(), "radiance", {size, Format::rgba32f}),
      framebuffer_(renderer_.device(), "radiance") {
    framebuffer_.attach_colour(0, target_.name());
    framebuffer_.draw_buffers(1);
}

void Bench::configure(Configuration configuration) {
    configuration.tone_map.enabled = false;
    const std::vector<std::string> faults = renderer_.configure(configuration);
    if (!faults.empty()) {
        throw std::invalid_argument(fmt::format("{}", fmt::join(faults, "; ")));
    }
}

double Bench::frame(glm::vec2 jitter) {
    const auto start = std::chrono::steady_clock::now();
    renderer_.render(*world_, camera_, {framebuffer_.name(), target_.desc().size}, jitter);
    renderer_.device().gl().Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace candela::study
