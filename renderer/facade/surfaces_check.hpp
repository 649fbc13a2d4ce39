#pragma once

#include <candela/view.hpp>
#include "renderer/gl/device.hpp"

namespace candela {

/// Throws gl::GlError, with the reason, if one of the textures does not exist, is not 2D, has another size
/// than the others or a format that cannot hold what it is said to. Binds textures: while the state of the
/// host is saved.
void require_readable(const gl::Device& device, const HostSurfaces& surfaces);

}  // namespace candela
