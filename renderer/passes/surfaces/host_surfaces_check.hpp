#pragma once

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfaces/host_surfaces.hpp"

namespace candela {

/// Adds node `host-surfaces-check` (CPU), for RendererOptions::checked: looks whether the surfaces that the
/// host has drawn are those of the scene, at a few hundred pixels. It throws SceneError if at three of four
/// of them the scene has no surface near the one that depth tells, or if most of the surfaces that it has
/// there face another way than the host's normals. So it finds depth and normals in other conventions than
/// HostSurfaces says, and worlds without the meshes, but no details that only the host draws. Waits for the
/// GPU. Depends on the host's textures, the camera and the scene.
[[nodiscard]] ValueHandle<CheckedSurfaces> add_host_surfaces_check(FrameGraph& graph, Gpu& gpu,
                                                                   const HostSurfaceInputs& inputs,
                                                                   ValueHandle<CameraView> camera,
                                                                   const SceneData& scene,
                                                                   const Tracing& tracing);

}  // namespace candela
