#pragma once

#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// GL names of two 2D textures of the same size.
struct ComparedPictures {
    GLuint first = 0;
    GLuint second = 0;
};

/// Draws |first - second| times `factor` to a target of their size. Changes the draw framebuffer, the
/// viewport and texture units.
void draw_difference(Gpu& gpu, const ComparedPictures& pictures, float factor, const Target& target);

}  // namespace candela
