#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <candela/api.hpp>

namespace candela {

/// What the picture shows: light, or what the surfaces are.
enum class Show : std::uint8_t {
    total,
    direct,    ///< includes the light of the sky and of surfaces that emit it, and the view of these
    indirect,  ///< light that surfaces reflect onto others
    /// The irradiance E of the visible surfaces, as the radiance E/π of white ones; without the view of the
    /// sky and of what surfaces emit.
    irradiance,
    albedo,   ///< linear, from 0 to 1; displayed without exposure and tone curve
    normals,  ///< (0.5 n + 0.5) in world space; displayed as they are
    /// Material::roughness × its texture, displayed as it is, without what bumps too small to be seen add to
    /// it; 1 in a scene without glossy surfaces.
    roughness,
    metalness  ///< the same of Material::metalness; 0 in a scene without glossy surfaces
};
inline constexpr std::array all_shows{Show::total,  Show::direct,  Show::indirect,  Show::irradiance,
                                      Show::albedo, Show::normals, Show::roughness, Show::metalness};

/// Whether lights and VPLs are evaluated for the picture at all.
[[nodiscard]] constexpr bool shows_light(Show show) {
    return show <= Show::irradiance;
}

/// How VPLs are placed.
enum class VplPlacement : std::uint8_t {
    /// Where light paths from the lights hit surfaces: Keller, "Instant Radiosity" (1997). Paths start
    /// neither at surfaces that emit light nor in the sky: a world with one of these always has surfels.
    paths,
    surfels  ///< on all surfaces, independent of the lights; they gather their light
};

/// Largest VplSettings::count with VplPlacement::surfels. The form factors between them then take 256 MiB.
inline constexpr std::uint32_t most_surfels = 65536;

/// Largest VplSettings::bounces. Surfels then gather all bounces.
inline constexpr std::uint32_t all_bounces = 64;

/// Number and placement of VPLs.
struct VplSettings {
    VplPlacement placement = VplPlacement::surfels;
    std::uint32_t count = 512;  ///< with paths: most VPLs, up to 2^20; with surfels: about so many
    /// Most bounces. 1: light → surface → visible surface; 0: no indirect light. Surfels stop when
    /// a bounce adds less than 0.02 % to the light of each, and at `all_bounces` extrapolate to those to
    /// come.
    std::uint32_t bounces = all_bounces;
    std::uint32_t seed = 0;  ///< of the pseudo-random placement
    /// Most surfels for which rays are traced in a frame, to other surfels and in their depth maps. 0: no
    /// limit. With one, a frame takes no longer however much moves. Light follows over the next frames, first
    /// where it matters most, and Renderer::settled tells when all has. Likewise in the first frames:
    /// surfels that were not traced yet send no light.
    std::uint32_t updates = 0;
    /// Surfels are many where most of the light comes from that the views see, so that there are others when
    /// a view or a light moves. Off: by area and distance alone, for pictures in tiles that must fit
    /// together, or for a host that shows nothing of its own views. No effect where some surfels stand for
    /// several objects.
    bool guided = true;
    bool operator==(const VplSettings&) const = default;
};

/// Interleaved sampling with factor n: pixels fall into n × n classes by their coordinates modulo n. Each
/// class evaluates its share, 1/n², of the VPLs; add_vpl_reconstruct combines the results of neighbouring
/// pixels.
enum class Interleave : std::uint8_t { automatic, one, two, four, eight };

/// How the visibility between a VPL and a surface is determined.
enum class VplVisibility : std::uint8_t {
    none,  ///< everything is visible: light of VPLs passes through walls
    maps,  ///< by a depth map of the hemisphere of each VPL
    rays   ///< by a shadow ray through the BVH: exact, but slow on software drivers
};

/// Visibility of VPLs.
struct VplVisibilitySettings {
    VplVisibility method = VplVisibility::maps;
    std::uint32_t map_resolution = 48;  ///< texels along a side of a VPL's map
    bool operator==(const VplVisibilitySettings&) const = default;
};

/// How the view is divided into cells that have a light list each: tiles of pixels, and for clusters also
/// depth slices.
struct ListSettings {
    std::uint32_t tile_size = 16;  ///< pixels along an edge
    std::uint32_t slices = 24;     ///< depth slices of a cluster grid
    bool operator==(const ListSettings&) const = default;
};

/// Resolutions of shadow maps, in texels along an edge, and their memory budget.
struct ShadowSettings {
    bool enabled = true;
    std::uint32_t cube_resolution = 512;  ///< cube faces: point lights, and spots of more than 60° half angle
    std::uint32_t map_resolution = 1024;  ///< flat maps: other spot lights, and directional lights
    std::uint32_t budget_mib = 256;       ///< MiB for all maps together; lights without one take more rays
    bool operator==(const ShadowSettings&) const = default;
};

/// Refinement: while nothing moves, frames are averaged. Each has its own sample position in the pixels and
/// its own VPLs on paths; surfels change every frames_a_surfel_set frames, or with VplSettings::updates when
/// the next set, which is then made a part at a time, is complete.
struct RefinementSettings {
    bool enabled = false;
    std::uint32_t frames = 1024;  ///< frames to average; without VPLs at most 64 are averaged
    bool operator==(const RefinementSettings&) const = default;
};

/// The curve from exposed light to colours that a display can show.
enum class ToneCurve : std::uint8_t {
    /// Narkowicz, "ACES Filmic Tone Mapping Curve" (2015): each channel by itself.
    filmic,
    /// Khronos PBR Neutral, github.com/KhronosGroup/ToneMapping (2024): base colours in white light stay as
    /// they are, and only highlights are compressed.
    neutral,
    /// The fit to the ACES transforms by Hill, "ACES.hlsl" in github.com/TheRealMJP/BakingLab (2016), of
    /// light / 0.6, the factor that glTF viewers apply (three.js; Khronos' sample viewer with its exposure
    /// boost).
    aces
};

/// How radiance becomes the colours of the target.
struct ToneMapSettings {
    /// Off: linear radiance times 2^exposure_ev, whatever automatic_exposure; alpha 1 where there is a
    /// surface.
    bool enabled = true;
    float exposure_ev = 0.0F;  ///< in stops: radiance is multiplied by 2^exposure_ev
    ToneCurve curve = ToneCurve::filmic;
    /// Radiance is also multiplied by 0.18 / the log-average luminance of the picture (Reinhard et al.,
    /// "Photographic Tone Reproduction for Digital Images", 2002), within 2^-10 to 2^10, so that exposure_ev
    /// compensates it. The luminance L of a pixel counts L / (L + 2^-16), so that what is black, or nearly,
    /// does not, nor do values that are not finite. It depends on the picture alone, not on earlier ones.
    bool automatic_exposure = false;
    bool operator==(const ToneMapSettings&) const = default;
};

/// How visible surfaces are found, and which lights each of them evaluates: see shading_paths. All paths give
/// the same picture.
enum class ShadingPath : std::uint8_t {
    forward,
    tiled_forward,
    forward_plus,
    deferred,
    tiled_deferred,
    clustered_forward,
    clustered_deferred
};

/// How a shading path finds the surfaces that it shades.
enum class SurfaceStage : std::uint8_t { forward, forward_after_prepass, gbuffer };

/// Which lights a pixel evaluates: all, those of its screen tile, or those of its cluster, a tile cut into
/// slices of depth. Tiles are bounded in depth where depth is known before shading.
enum class LightList : std::uint8_t { all, tile, cluster };

/// A shading path: two independent choices, with a name in JSON and on the command line.
struct ShadingPathInfo {
    ShadingPath path;
    std::string_view name;
    SurfaceStage surfaces;
    LightList lights;
    std::string_view description;
};

/// In the order of ShadingPath.
inline constexpr std::array<ShadingPathInfo, 7> shading_paths{{
    {ShadingPath::forward, "forward", SurfaceStage::forward, LightList::all,
     "surfaces shaded as they are rasterised, by all lights"},
    {ShadingPath::tiled_forward, "tiled-forward", SurfaceStage::forward, LightList::tile,
     "the same, by the lights of their screen tile"},
    {ShadingPath::forward_plus, "forward+", SurfaceStage::forward_after_prepass, LightList::tile,
     "the same after a depth pre-pass, which bounds the tiles in depth"},
    {ShadingPath::deferred, "deferred", SurfaceStage::gbuffer, LightList::all,
     "G-buffer, then one dispatch over all lights"},
    {ShadingPath::tiled_deferred, "tiled-deferred", SurfaceStage::gbuffer, LightList::tile,
     "the same, by the lights of each tile, bounded in depth"},
    {ShadingPath::clustered_forward, "clustered-forward", SurfaceStage::forward, LightList::cluster,
     "forward, by the lights of each cluster: a tile cut into slices of depth"},
    {ShadingPath::clustered_deferred, "clustered-deferred", SurfaceStage::gbuffer, LightList::cluster,
     "deferred, by the lights of each cluster"},
}};

inline constexpr auto all_shading_paths = [] {
    std::array<ShadingPath, shading_paths.size()> paths{};
    for (std::size_t i = 0; i < paths.size(); ++i) {
        paths[i] = shading_paths[i].path;
    }
    return paths;
}();

[[nodiscard]] constexpr const ShadingPathInfo& info_of(ShadingPath path) {
    return shading_paths[static_cast<std::size_t>(path)];
}

/// All settings of a frame; <candela/settings.hpp> lists them with the ranges of their values. The defaults
/// are those of the app when it renders a single frame without a window; with a window, the app also turns on
/// refinement and the automatic frame budget.
struct Configuration {
    ShadingPath path = ShadingPath::deferred;
    Show show = Show::total;
    bool indirect = true;  ///< off: no VPLs are placed
    VplSettings vpls;
    Interleave interleave = Interleave::automatic;
    VplVisibilitySettings visibility;
    /// Factor on the upper bound of the geometry term of VPLs that are placed by paths; infinity removes the
    /// bound. See vpl_radius2.
    float geometry_bound = 1.0F;
    ListSettings lists;
    ShadowSettings shadows;
    RefinementSettings refinement;
    ToneMapSettings tone_map;
    /// Time budget of a frame in milliseconds while something moves. To keep to it, fewer pixels are rendered
    /// (and scaled up along the edges of surfaces), and each pixel evaluates fewer VPLs. 0: no budget.
    /// Without a value ("auto" in JSON): 16 on a GPU, 60 with a software driver.
    std::optional<float> frame_budget_ms = 0.0F;
    bool operator==(const Configuration&) const = default;
};

/// A configuration, or the errors that prevent it, one per string. There is a configuration exactly if
/// `errors` is empty.
struct ConfigurationResult {
    std::optional<Configuration> configuration;
    std::vector<std::string> errors;
};

/// Reads a JSON object. Members that are left out keep the values of `base`. Unknown members, wrong types and
/// values out of range are errors; each message starts with the member's path: "vpls.count: ...". The message
/// for text that is not JSON names line and column.
[[nodiscard]] CANDELA_API ConfigurationResult read_configuration(std::string_view json,
                                                                 const Configuration& base = {});

/// All members as a JSON object; `read_configuration` reads the same value back.
[[nodiscard]] CANDELA_API std::string write_configuration(const Configuration& configuration);

/// The errors in a configuration's values, one per string; empty if it is valid.
[[nodiscard]] CANDELA_API std::vector<std::string> validate(const Configuration& configuration);

/// What a named configuration is for.
enum class NamedFor : std::uint8_t {
    purpose,  ///< a compromise between speed and accuracy
    path      ///< the default with one of the shading paths
};

/// A configuration that the app offers by name. The strings have static storage duration.
struct NamedConfiguration {
    NamedFor kind = NamedFor::path;
    std::string_view name;
    std::string_view description;
    Configuration configuration;
};
/// Those for purposes come first: draft, balanced, best, report.
[[nodiscard]] CANDELA_API std::span<const NamedConfiguration> named_configurations();

/// A value of a setting that is chosen by its name, in JSON and on the command line. The strings have static
/// storage duration.
struct Choice {
    std::string_view name;
    std::string_view help;  ///< empty if that of the setting explains it
};
/// The values of an enumeration, in its order; which value is given makes no difference.
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(ShadingPath type);
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(Show type);
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(VplPlacement type);
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(VplVisibility type);
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(Interleave type);
[[nodiscard]] CANDELA_API std::span<const Choice> choices_of(ToneCurve type);

/// The name of a value of such an enumeration.
template <class Enum>
requires requires(Enum value) {
    choices_of(value);
}
[[nodiscard]] std::string_view to_string(Enum value) {
    return choices_of(value)[static_cast<std::size_t>(value)].name;
}

}  // namespace candela
