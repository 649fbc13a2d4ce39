#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <candela/view.hpp>
#include "renderer/gl/device.hpp"
#include "renderer/gl/texture.hpp"

namespace candela::tools {

/// A picture on the GPU: a texture, and a framebuffer that draws into it.
struct Canvas {
    gl::Texture colour;  ///< the bottom row first
    gl::Framebuffer framebuffer;

    Canvas() = default;
    /// Undefined content. Throws gl::GlError if the driver does not support the size, in pixels.
    Canvas(gl::Device& device, glm::uvec2 size, Format format);

    [[nodiscard]] glm::uvec2 size() const { return colour.desc().size; }
    /// Reads the picture back, the bottom row first; waits for the GPU.
    [[nodiscard]] std::vector<glm::vec4> texels(const gl::Device& device) const {
        return gl::read_texels(device.gl(), colour.name(), size());
    }
    [[nodiscard]] Target target() const { return {framebuffer.name(), size()}; }
};

}  // namespace candela::tools
