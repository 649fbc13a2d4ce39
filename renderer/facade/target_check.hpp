#pragma once

#include <cstdint>
#include <string_view>

#include <glm/vec2.hpp>

#include <candela/view.hpp>
#include "renderer/gl/device.hpp"

namespace candela {

// These throw gl::GlError, with the reason: if a target cannot be drawn into, is larger than its framebuffer
// or holds integers, or if there is no such texture. `what` names the texture in the message.
void require_possible(const gl::Device& device, const Target& target);
void require_texture(const gl::Device& device, std::uint32_t texture, std::string_view what);
/// Also if the texture has another size.
void require_texture(const gl::Device& device, std::uint32_t texture, glm::uvec2 size, std::string_view what);

}  // namespace candela
