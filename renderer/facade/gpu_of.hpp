#pragma once

#include <candela/renderer.hpp>

#include "renderer/gpu/gpu.hpp"

namespace candela {

/// What the passes of a renderer share, for further passes in its context. Lives as long as the renderer.
[[nodiscard]] Gpu& gpu_of(Renderer& renderer);

}  // namespace candela
