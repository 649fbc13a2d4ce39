#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

#include <candela/configuration.hpp>

namespace candela {

/// The values of a setting that is a number, from `least` to `most`.
struct Range {
    double least = 0.0;
    double most = 0.0;
    std::uint32_t step = 1;  ///< whole numbers are multiples of it
};

/// A setting of a Configuration. The strings have static storage duration.
struct Setting {
    std::string_view path;   ///< in JSON: "count" in the object "vpls" is "vpls.count"
    std::string_view flag;   ///< on the app's command line; empty: none
    Range range;             ///< of a number
    std::string_view help;   ///< what it does, with its unit
    bool has_effect = true;  ///< beside the other values of the visited configuration

    /// The object of `path`; empty: the outermost one.
    [[nodiscard]] constexpr std::string_view group() const {
        return path.substr(0, path.size() - std::min(name().size() + 1, path.size()));
    }
    /// The member of `path`.
    [[nodiscard]] constexpr std::string_view name() const { return path.substr(path.rfind('.') + 1); }
};

/// Calls `visit(setting, value)` for all settings of a configuration, with a reference to the value: a bool,
/// std::uint32_t, float, std::optional<float> ("auto" without a value), or an enumeration with `choices_of`.
/// JSON, the app's command line and its panel are made from this table: a new setting is a member of
/// Configuration and a row here.
template <class Config, class Visitor>
void for_each_setting(Config& c, const Visitor& visit) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr auto most_seeds = std::numeric_limits<std::uint32_t>::max();
    const auto row = [&](std::string_view path, std::string_view flag, auto& value, Range range,
                         std::string_view help, bool has_effect = true) {
        visit(Setting{path, flag, range, help, has_effect}, value);
    };
    const LightList lists = info_of(c.path).lights;
    const bool has_maps = c.indirect && c.visibility.method == VplVisibility::maps;
    const bool has_paths = c.indirect && c.vpls.placement == VplPlacement::paths;
    row("path", "--path", c.path, {},
        "how visible surfaces are found, and which lights they evaluate; all give the same picture");
    row("show", "--show", c.show, {}, "what the picture shows");
    row("indirect", "--indirect", c.indirect, {}, "light that surfaces reflect onto others, by VPLs");

    row("vpls.placement", "--vpl-placement", c.vpls.placement, {},
        "surfels: VPLs on all surfaces, which stay while lights move; paths: where paths from the "
        "lights hit surfaces, traced again after every move. A scene with a sky or surfaces that emit light "
        "always has surfels",
        c.indirect);
    row("vpls.count", "--vpls", c.vpls.count, {0, 1 << 20},
        "number of VPLs: about so many surfels, or at most so many on paths", c.indirect);
    row("vpls.bounces", "--bounces", c.vpls.bounces, {0, all_bounces},
        "most reflections of light; 0: direct light only; 1: light, surface, visible surface; 64: all of "
        "them, with surfels",
        c.indirect);
    row("vpls.seed", "--seed", c.vpls.seed, {0, most_seeds}, "of the random places of VPLs", c.indirect);
    row("vpls.updates", "--vpl-updates", c.vpls.updates, {0, 1 << 20},
        "most surfels whose shadows are traced in a frame; others follow in the next ones, so that a frame "
        "in "
        "which much moves does not take longer; 0: all at once",
        c.indirect && c.vpls.placement == VplPlacement::surfels);
    row("vpls.guided", "--vpl-guided", c.vpls.guided, {},
        "more surfels where the light comes from that is seen; others then when a view or a light moves",
        c.indirect && c.vpls.placement == VplPlacement::surfels);
    row("vpls.interleave", "--interleave", c.interleave, {},
        "with n, a pixel evaluates one in n² VPLs; the rest of their light comes from neighbours on the "
        "same surface",
        c.indirect);
    row("vpls.visibility", "--vpl-visibility", c.visibility.method, {},
        "how walls block the light of VPLs: not at all, by a depth map for each VPL, or exactly, by rays "
        "(slow without a GPU)",
        c.indirect);
    row("vpls.map_resolution", "", c.visibility.map_resolution, {8, 1024},
        "texels along a side of a VPL's depth map", has_maps);
    row("vpls.geometry_bound", "", c.geometry_bound, {1e-6, infinity},
        "factor on the upper bound of the light of VPLs on near surfaces, if VPLs are on paths", has_paths);

    row("lists.tile_size", "", c.lists.tile_size, {16, 64, 16},
        "pixels along an edge of a tile of the picture, which has a list of its lights",
        lists != LightList::all);
    row("lists.slices", "", c.lists.slices, {2, 256},
        "slices of depth that a tile is cut into, each with a list of its lights",
        lists == LightList::cluster);

    row("shadows.enabled", "", c.shadows.enabled, {},
        "whether surfaces block the light of lights that cast shadows");
    row("shadows.cube_resolution", "", c.shadows.cube_resolution, {16, 8192},
        "texels along an edge of the shadow maps of nearby point and wide spot lights", c.shadows.enabled);
    row("shadows.map_resolution", "", c.shadows.map_resolution, {16, 8192},
        "texels along an edge of the shadow maps of other lights", c.shadows.enabled);
    row("shadows.budget_mib", "", c.shadows.budget_mib, {0, 1 << 16}, "MiB for all shadow maps together",
        c.shadows.enabled);

    row("refinement.enabled", "", c.refinement.enabled, {},
        "while nothing moves, frames with different samples are averaged; the default in a window");
    row("refinement.frames", "", c.refinement.frames, {1, 1 << 20},
        "number of frames that are averaged; without VPLs at most 64", c.refinement.enabled);

    row("tone_map.enabled", "", c.tone_map.enabled, {}, "off: linear radiance times the exposure");
    row("tone_map.curve", "--tone-curve", c.tone_map.curve, {}, "from exposed light to colours",
        c.tone_map.enabled);
    row("tone_map.automatic_exposure", "--automatic-exposure", c.tone_map.automatic_exposure, {},
        "radiance is multiplied so that its log-average in the picture becomes 18 % grey; the app's default",
        c.tone_map.enabled);
    row("tone_map.exposure_ev", "--exposure", c.tone_map.exposure_ev, {-32, 32},
        "in stops: radiance is multiplied by 2 to this power, beside an automatic exposure");

    row("frame_budget_ms", "", c.frame_budget_ms, {0, 1e6},
        "milliseconds for a frame while something moves: to keep to it, fewer pixels are rendered, and each "
        "evaluates fewer VPLs; 0: no budget; auto, the default in a window: 16 on a GPU, 60 without one");
}

}  // namespace candela
