#include "renderer/tools/canvas.hpp"

namespace candela::tools {

Canvas::Canvas(gl::Device& device, glm::uvec2 size, Format format)
    : colour(device, "canvas", {.size = size, .format = format}), framebuffer(device, "canvas") {
    framebuffer.attach_colour(0, colour.name());
    framebuffer.draw_buffers(1);
    framebuffer.check();
}

}  // namespace candela::tools
