#include "renderer/facade/target_check.hpp"

#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "renderer/gl/objects.hpp"
#include "renderer/gl/texture.hpp"

namespace candela {
namespace {

void require_drawable(const gl::Functions& gl, const Target& target) {
    const std::string called = fmt::format("the target, framebuffer {},", target.framebuffer);
    gl::require_complete(gl, target.framebuffer, called);
    if (target.framebuffer == 0) return;  // GL does not tell the size of a window
    const std::optional<gl::DrawnAttachment> drawn = gl::drawn_attachment(gl, target.framebuffer);
    if (!drawn) throw gl::GlError(fmt::format("{} draws colour into no attachment", called));
    if (drawn->holds_integers) {
        throw gl::GlError(fmt::format("{} holds integers, which are no colours", called));
    }
    const auto fits = [](std::uint32_t origin, std::uint32_t size, std::uint32_t all) {
        return size <= all && origin <= all - size;
    };
    if (!fits(target.origin.x, target.size.x, drawn->size.x) ||
        !fits(target.origin.y, target.size.y, drawn->size.y)) {
        throw gl::GlError(fmt::format("{} has {} × {} pixels, too few for {} × {} from ({}, {})", called,
                                      drawn->size.x, drawn->size.y, target.size.x, target.size.y,
                                      target.origin.x, target.origin.y));
    }
}

}  // namespace

void require_possible(const gl::Device& device, const Target& target) {
    const std::uint32_t most = device.limits().texture_size;
    if (target.size.x == 0 || target.size.y == 0 || target.size.x > most || target.size.y > most) {
        throw gl::GlError(
            fmt::format("a target of {} × {} pixels is not possible; this driver allows 1 to {}",
                        target.size.x, target.size.y, most));
    }
    require_drawable(device.gl(), target);
}

void require_texture(const gl::Device& device, std::uint32_t texture, std::string_view what) {
    if (device.gl().IsTexture(texture) == GL_FALSE) {
        throw gl::GlError(fmt::format("{}, texture {}, does not exist", what, texture));
    }
}

void require_texture(const gl::Device& device, std::uint32_t texture, glm::uvec2 size,
                     std::string_view what) {
    require_texture(device, texture, what);
    const glm::uvec2 found = gl::texture_size(device.gl(), texture);
    if (found != size) {
        throw gl::GlError(fmt::format("{}, texture {}, has {} × {} pixels instead of {} × {}", what, texture,
                                      found.x, found.y, size.x, size.y));
    }
}

}  // namespace candela
