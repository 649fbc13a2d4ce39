#include "renderer/passes/inspect/difference.hpp"
#include <candela/inspection.hpp>
#include "renderer/facade/gpu_of.hpp"
#include "renderer/facade/target_check.hpp"
#include "renderer/gl/host_state.hpp"

namespace candela {

void draw_difference(Renderer& renderer, std::uint32_t a, std::uint32_t b, float factor,
                     const Target& target) {
    Gpu& gpu = gpu_of(renderer);
    gpu.require_context();
    require_possible(gpu.device(), target);
    require_texture(gpu.device(), a, target.size, "the first picture");
    require_texture(gpu.device(), b, target.size, "the second picture");
    const gl::HostState host_state(gpu.gl(), gpu.keeps_gl_state());
    draw_difference(gpu, {.first = a, .second = b}, factor, target);
}

}  // namespace candela
