#pragma once

#include <cstdint>
#include <vector>

#include "renderer/gl/device.hpp"
#include "renderer/gl/uniforms.hpp"

namespace candela {

/// Iterations of loops that a ray through the BVH takes, at most, in the largest scenes that were tried.
inline constexpr std::uint32_t iterations_a_ray = 2047;

/// Cuts a loop of `count` iterations, each with `inner` iterations of loops within it, itself included, into
/// as many dispatches or draws as the driver's limit of iterations demands: the uniforms of
/// shaders/loop_part.glsl for each of them; at least one.
[[nodiscard]] std::vector<gl::Uniforms> loop_parts(const gl::Limits& limits, std::uint32_t count,
                                                   std::uint32_t inner);

}  // namespace candela
