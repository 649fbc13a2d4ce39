#pragma once

// All public headers.

#include <candela/configuration.hpp>
#include <candela/ecs/world_reader.hpp>
#include <candela/error.hpp>
#include <candela/gl_error.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/headless_context.hpp>
#include <candela/inspection.hpp>
#include <candela/renderer.hpp>
#include <candela/renderer_options.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/gltf.hpp>
#include <candela/scene/gltf_export.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/scene/sky_picture.hpp>
#include <candela/scene/tangents.hpp>
#include <candela/settings.hpp>
#include <candela/tools/capture.hpp>
#include <candela/tools/flip.hpp>
#include <candela/tools/live_reference.hpp>
#include <candela/tools/output_file.hpp>
#include <candela/tools/picture_error.hpp>
#include <candela/tools/run_report.hpp>
#include <candela/tools/scene_rays.hpp>
#include <candela/tools/tool_error.hpp>
#include <candela/workload.hpp>
