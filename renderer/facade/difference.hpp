#pragma once

#include <cstdint>

#include <candela/renderer.hpp>

namespace candela {

/// Draws how far two pictures are apart: |a - b| times `factor`, clamped to [0, 1], alpha 1. `a` and `b` are
/// GL names of 2D textures of the size of the target. What they store is compared as it is: of tone-mapped
/// pictures in rgba8, the sRGB-encoded values. Context and state of OpenGL as in Renderer::render. Throws
/// gl::GlError where Renderer::tone_map does, and if a texture has another size than the target.
void draw_difference(Renderer& renderer, std::uint32_t a, std::uint32_t b, float factor,
                     const Target& target);

}  // namespace candela
