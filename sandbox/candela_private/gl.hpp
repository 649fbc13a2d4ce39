#pragma once

// The private headers of the renderer that the app uses, in this file alone: GL objects, which the app makes
// as the renderer does, and the layout of the buffers of VPLs that it draws as dots.

#include "renderer/facade/device_of.hpp"
#include "renderer/gl/device.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gpu/gpu_types.hpp"
