#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/passes/light_lists.hpp"
#include "renderer/passes/lighting.hpp"
#include "renderer/passes/refinement.hpp"
#include "renderer/passes/shadow_maps.hpp"
#include "renderer/passes/tone_map.hpp"
#include "renderer/passes/vpl_constants.hpp"
#include "renderer/passes/vpl_gather.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// How surfaces are found, and which lights each visits. Names as in JSON and on the command line, in this
/// order: forward, tiled-forward, forward+, deferred, tiled-deferred, clustered-forward, clustered-deferred.
enum class ShadingPath : std::uint8_t {
    forward,            ///< rasterised and shaded at once; all lights
    tiled_forward,      ///< the same with lists of tiles, unbounded in depth
    forward_plus,       ///< depth pre-pass, then the same with lists bound by depth
    deferred,           ///< G-buffer, then one dispatch over all lights
    tiled_deferred,     ///< the same with lists of tiles, bound by depth
    clustered_forward,  ///< forward with lists of clusters
    clustered_deferred  ///< deferred with lists of clusters
};
inline constexpr std::array all_shading_paths{ShadingPath::forward,           ShadingPath::tiled_forward,
                                              ShadingPath::forward_plus,      ShadingPath::deferred,
                                              ShadingPath::tiled_deferred,    ShadingPath::clustered_forward,
                                              ShadingPath::clustered_deferred};

/// How a path finds the surfaces that it shades.
enum class SurfaceStage : std::uint8_t { forward, forward_after_prepass, gbuffer };

/// The two axes of a path.
struct PathParts {
    SurfaceStage surface;
    LightList list;
};
[[nodiscard]] PathParts parts_of(ShadingPath path);

/// Everything that a user chooses about a frame. The defaults are what the app uses when nothing else is
/// asked for.
struct Configuration {
    ShadingPath path = ShadingPath::deferred;
    Show show = Show::total;
    bool indirect = true;
    VplSettings vpls;
    Interleave interleave = Interleave::automatic;
    VplVisibilitySettings visibility;
    float geometry_bound = 1.0F;  ///< factor on the bound of a traced VPL's geometry term: see vpl_radius2
    ListSettings lists;
    ShadowSettings shadows;
    RefinementSettings refinement;
    ToneMapSettings tone_map;
    /// Milliseconds that a frame may take while something moves; then fewer pixels are rendered and scaled
    /// up, and each asks fewer VPLs. 0: no bound; none: 16 where a GPU draws, 100 where software does.
    std::optional<float> frame_budget_ms = 0.0F;
    bool operator==(const Configuration&) const = default;
};

/// A configuration, or all that is wrong with it, one line a fault.
struct ConfigurationResult {
    std::optional<Configuration> configuration;
    std::vector<std::string> faults;
};

/// Reads a JSON object; members that are left out keep the values of `base`. Unknown members, wrong types and
/// values out of range are faults, each named by its place: "vpls.count: ...".
[[nodiscard]] ConfigurationResult read_configuration(std::string_view json, const Configuration& base = {});

/// All members as JSON; `read_configuration` gives the same value back.
[[nodiscard]] std::string write_configuration(const Configuration& configuration);

/// What is wrong with the values, one line a fault; empty if nothing is.
[[nodiscard]] std::vector<std::string> validate(const Configuration& configuration);

/// A configuration that the app offers by name.
struct NamedConfiguration {
    std::string_view name;
    std::string_view description;
    Configuration configuration;
};
[[nodiscard]] std::span<const NamedConfiguration> named_configurations();

[[nodiscard]] std::string_view to_string(ShadingPath path);
[[nodiscard]] std::string_view to_string(Show show);
[[nodiscard]] std::string_view to_string(VplVisibility visibility);
[[nodiscard]] std::string_view to_string(VplPlacement placement);
[[nodiscard]] std::string_view to_string(Interleave interleave);

}  // namespace candela
