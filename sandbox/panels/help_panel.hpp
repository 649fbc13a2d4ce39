#pragma once

#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Draws a list of all keys and of what the mouse does over the picture, while `shown`.
void draw_help(bool& shown, const Rectangle& scene);

}  // namespace candela::sandbox
