#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/tools/scene_rays.hpp>
#include "sandbox/window/frame_request.hpp"

namespace candela::sandbox {

/// What a light sends to a VPL without bounces.
struct LightOfVpl {
    Entity light;
    float illuminance = 0.0F;  ///< lux, of the strongest channel
};

/// The lights that shine on the VPL's surface without anything in between, the strongest first: those whose
/// light it reflects. `surfaces`: of the world.
[[nodiscard]] std::vector<LightOfVpl> lights_of(const World& world, const tools::SceneRays& surfaces,
                                                const VplDot& vpl);

/// Another VPL.
struct NearVpl {
    std::size_t index = 0;
    float distance = 0.0F;  ///< metres
};

/// The `most` VPLs next to that with this index, the nearest first.
[[nodiscard]] std::vector<NearVpl> nearest_vpls(const std::vector<VplDot>& vpls, std::size_t index,
                                                std::size_t most);

/// The VPL that is nearest to a place; nullopt if there are none.
[[nodiscard]] std::optional<std::size_t> vpl_at(const std::vector<VplDot>& vpls, const glm::vec3& place);

/// Where it is, what it sends, which lights it has that from, and which VPLs are next to it; one thing a
/// line.
[[nodiscard]] std::string details_of(const World& world, const tools::SceneRays& surfaces,
                                     const std::vector<VplDot>& vpls, std::size_t index);

}  // namespace candela::sandbox
