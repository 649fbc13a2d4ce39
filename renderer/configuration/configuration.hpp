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

/// How visible surfaces are found, and which lights each of them evaluates. All paths give the same picture.
/// Names in JSON and on the command line, in this order: forward, tiled-forward, forward+, deferred,
/// tiled-deferred, clustered-forward, clustered-deferred.
enum class ShadingPath : std::uint8_t {
    forward,            ///< shaded while rasterised; all lights
    tiled_forward,      ///< forward; the lights of the screen tile, not bounded in depth
    forward_plus,       ///< depth pre-pass, then forward; the lights of the tile, bounded in depth
    deferred,           ///< G-buffer, then shaded in a compute pass; all lights
    tiled_deferred,     ///< deferred; the lights of the tile, bounded in depth
    clustered_forward,  ///< forward; the lights of the cluster (tile × depth slice)
    clustered_deferred  ///< deferred; the lights of the cluster
};
inline constexpr std::array all_shading_paths{ShadingPath::forward,           ShadingPath::tiled_forward,
                                              ShadingPath::forward_plus,      ShadingPath::deferred,
                                              ShadingPath::tiled_deferred,    ShadingPath::clustered_forward,
                                              ShadingPath::clustered_deferred};

/// How a shading path finds the surfaces that it shades.
enum class SurfaceStage : std::uint8_t { forward, forward_after_prepass, gbuffer };

/// The two independent choices that make up a shading path.
struct PathParts {
    SurfaceStage surface;
    LightList list;
};
[[nodiscard]] PathParts parts_of(ShadingPath path);

/// All settings of a frame. The defaults are those of the app when it renders a single frame without a
/// window; with a window, the app also turns on refinement and the automatic frame budget. `validate` checks
/// the ranges of the values.
struct Configuration {
    ShadingPath path = ShadingPath::deferred;
    Show show = Show::total;
    bool indirect = true;  ///< off: no VPLs are placed
    VplSettings vpls;
    Interleave interleave = Interleave::automatic;
    VplVisibilitySettings visibility;
    /// Factor on the upper bound of the geometry term of VPLs that are placed by paths, at least 1e-6;
    /// infinity removes the bound. See vpl_radius2.
    float geometry_bound = 1.0F;
    ListSettings lists;
    ShadowSettings shadows;
    RefinementSettings refinement;
    ToneMapSettings tone_map;
    /// Time budget of a frame in milliseconds while something moves. To keep to it, fewer pixels are rendered
    /// (and scaled up), and each pixel evaluates fewer VPLs. 0: no budget. Without a value ("auto" in JSON):
    /// 16 on a GPU, 100 with a software driver.
    std::optional<float> frame_budget_ms = 0.0F;
    bool operator==(const Configuration&) const = default;
};

/// A configuration, or the errors that prevent it, one per string. There is a configuration exactly if
/// `faults` is empty.
struct ConfigurationResult {
    std::optional<Configuration> configuration;
    std::vector<std::string> faults;
};

/// Reads a JSON object. Members that are left out keep the values of `base`. Unknown members, wrong types and
/// values out of range are errors; each message starts with the member's path: "vpls.count: ...".
[[nodiscard]] ConfigurationResult read_configuration(std::string_view json, const Configuration& base = {});

/// All members as a JSON object; `read_configuration` reads the same value back.
[[nodiscard]] std::string write_configuration(const Configuration& configuration);

/// The errors in a configuration's values, one per string; empty if it is valid.
[[nodiscard]] std::vector<std::string> validate(const Configuration& configuration);

/// A configuration that the app offers by name. The strings have static storage duration.
struct NamedConfiguration {
    std::string_view name;
    std::string_view description;
    Configuration configuration;
};
[[nodiscard]] std::span<const NamedConfiguration> named_configurations();

/// Names as in JSON and on the command line; static storage duration.
[[nodiscard]] std::string_view to_string(ShadingPath path);
[[nodiscard]] std::string_view to_string(Show show);
[[nodiscard]] std::string_view to_string(VplVisibility visibility);
[[nodiscard]] std::string_view to_string(VplPlacement placement);
[[nodiscard]] std::string_view to_string(Interleave interleave);

}  // namespace candela
