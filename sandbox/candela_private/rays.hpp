#pragma once

// The private headers of the engine with which the app finds what the pointer is on: boxes and ray-tracing
// hierarchies.

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/traverse.hpp"
#include "engine/bvh/two_level.hpp"
