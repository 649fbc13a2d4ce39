#include "renderer/facade/target_check.hpp"

#include <fmt/format.h>

#include "renderer/gl/objects.hpp"

namespace candela {

void require_possible(const gl::Device& device, const Target& target) {
    const std::uint32_t most = device.limits().texture_size;
    if (target.size.x == 0 || target.size.y == 0 || target.size.x > most || target.size.y > most) {
        throw gl::GlError(
            fmt::format("a target of {} × {} pixels is not possible; this driver allows 1 to {}",
                        target.size.x, target.size.y, most));
    }
    gl::require_complete(device.gl(), target.framebuffer,
                         fmt::format("the target, framebuffer {},", target.framebuffer));
}

void require_texture(const gl::Device& device, std::uint32_t texture, std::string_view what) {
    if (device.gl().IsTexture(texture) == GL_FALSE) {
        throw gl::GlError(fmt::format("{}, texture {}, does not exist", what, texture));
    }
}

void require_texture(const gl::Device& device, std::uint32_t texture, glm::uvec2 size,
                     std::string_view what) {
    require_texture(device, texture, what);
    glm::ivec2 found(0);
    device.gl().GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &found.x);
    device.gl().GetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &found.y);
    if (glm::uvec2(found) != size) {
        throw gl::GlError(fmt::format("{}, texture {}, has {} × {} pixels instead of {} × {}", what, texture,
                                      found.x, found.y, size.x, size.y));
    }
}

}  // namespace candela
