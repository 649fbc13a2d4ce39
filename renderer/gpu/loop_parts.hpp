#pragma once

#include <cstdint>
#include <vector>

#include "renderer/gl/uniforms.hpp"

namespace candela {

/// Cuts a loop of `count` iterations into dispatches or draws with at most `most` each: the uniforms of
/// shaders/loop_part.glsl for each of them; at least one. Software drivers silently stop all loops of an
/// invocation after 65,535 iterations in total.
[[nodiscard]] std::vector<gl::Uniforms> loop_parts(std::uint32_t count, std::uint32_t most);

}  // namespace candela
