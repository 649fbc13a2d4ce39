#pragma once

// The private headers of the libraries that the app uses, in this file alone.

// Numbers are written, and files quoted in messages, as the importer and the exporter do it.
#include "engine/import/shortest.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/read_json.hpp"
#include "engine/readable.hpp"

// Boxes around objects.
#include "engine/bvh/box.hpp"

// GL objects, which the app makes and reads as the renderer does, and the VPLs that it draws as dots.
#include "renderer/gl/device.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/tools/canvas.hpp"
