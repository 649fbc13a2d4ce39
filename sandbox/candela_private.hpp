#pragma once

// The private headers of the libraries that the app uses, in this file alone.

// Files are written, and quoted in messages, as the importer and the exporter do it.
#include "engine/import/exr.hpp"
#include "engine/import/output_files.hpp"
#include "engine/import/shortest.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/json/json.hpp"
#include "engine/readable.hpp"

// What the pointer is on.
#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/traverse.hpp"
#include "engine/bvh/two_level.hpp"
#include "engine/bvh/wide.hpp"

// GL objects, which the app makes and reads as the renderer does, and the VPLs that it draws as dots.
#include "renderer/facade/device_of.hpp"
#include "renderer/gl/device.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gpu/gpu_types.hpp"
