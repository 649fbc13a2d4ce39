#pragma once

#include <candela/renderer.hpp>

#include "renderer/gl/device.hpp"

namespace candela {

/// The limits, debug messages and object counts of a renderer's GL context, for tests and the study. Lives as
/// long as the renderer.
[[nodiscard]] gl::Device& device_of(Renderer& renderer);

}  // namespace candela
