#include "sandbox/panels/quality_panel.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

/// Buttons side by side, which wrap at the edge of the panel.
void same_line_if_it_fits(const std::string& next) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(next.c_str()).x + 2.0F * style.FramePadding.x;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width < right) ImGui::SameLine();
}

void draw_presets(Configuration& value) {
    bool first = true;
    for (const NamedConfiguration& named : named_configurations()) {
        if (named.kind != NamedFor::purpose) continue;
        const std::string name(named.name);
        if (!first) same_line_if_it_fits(name);
        first = false;
        const bool chosen = choose_named(value, named) == value;
        if (choice(name, chosen, std::string(named.description).c_str())) value = choose_named(value, named);
    }
}

/// How visible surfaces are found, and which lights each of them evaluates; all give the same picture.
void draw_paths(ShadingPath& path) {
    bool first = true;
    for (const ShadingPathInfo& info : shading_paths) {
        const std::string name(info.name);
        if (!first) same_line_if_it_fits(name);
        first = false;
        if (choice(name, path == info.path, std::string(info.description).c_str())) path = info.path;
    }
}

/// The settings of the path's light lists; draws nothing if it has none.
void draw_list_settings(LightList list, ListSettings& settings) {
    if (list == LightList::all) return;
    for (const std::uint32_t size : {16U, 32U, 64U}) {
        if (ImGui::RadioButton(fmt::format("{}", size).c_str(), settings.tile_size == size))
            settings.tile_size = size;
        ImGui::SameLine();
    }
    text("tile size, pixels");
    if (list == LightList::cluster)
        drag("slices", settings.slices, 0.2F, "slices of depth that a tile is cut into, 2 to 256");
}

void draw_vpls(Configuration& value) {
    checkbox("indirect light", value.indirect, "light that surfaces reflect onto others, by VPLs");
    if (!value.indirect) return;
    combo<VplPlacement>(
        "placement", value.vpls.placement, std::array{VplPlacement::surfels, VplPlacement::paths},
        "surfels: VPLs evenly on all surfaces, which stay while lights move; paths: where paths "
        "from the lights hit surfaces");
    drag("VPLs", value.vpls.count, 1.0F, "number of virtual point lights");
    drag("bounces", value.vpls.bounces, 0.05F,
         "most reflections of light; 1: light, surface, visible surface");
    drag("seed", value.vpls.seed, 0.05F, "of the random places of VPLs");
    combo<VplVisibility>(
        "VPL visibility", value.visibility.method,
        std::array{VplVisibility::none, VplVisibility::maps, VplVisibility::rays},
        "how walls block the light of VPLs: not at all, by a depth map for each VPL, or exactly, "
        "by rays (slow without a GPU)");
    if (value.visibility.method == VplVisibility::maps)
        drag("VPL map", value.visibility.map_resolution, 0.2F,
             "texels along a side of a VPL's depth map, 8 to 1024");
    combo<Interleave>(
        "interleave", value.interleave,
        std::array{Interleave::automatic, Interleave::one, Interleave::two, Interleave::four,
                   Interleave::eight},
        "with n, a pixel evaluates one in n² VPLs; the rest of their light comes from neighbours on "
        "the same surface");
    if (value.vpls.placement == VplPlacement::paths) {
        drag("geometry bound", value.geometry_bound, 0.01F, 1e-6F, std::numeric_limits<float>::max(),
             "factor on the upper bound of the light of a VPL on near surfaces");
    }
}

void draw_refinement(RefinementSettings& settings) {
    checkbox("refine while still", settings.enabled,
             "while nothing moves, frames with different samples are averaged");
    if (settings.enabled) drag("frames", settings.frames, 1.0F, "number of frames that are averaged");
}

void draw_frame_budget(std::optional<float>& budget_ms, const Quality& present) {
    bool automatic = !budget_ms;
    if (checkbox("automatic frame time", automatic,
                 "while something moves, the quality is reduced so that a frame takes 16 ms on a GPU, 60 ms "
                 "without one")) {
        budget_ms = automatic ? std::nullopt : std::optional(0.0F);
    }
    if (budget_ms) {
        drag("frame time, ms", *budget_ms, 0.5F, 0.0F, 1e6F,
             "while something moves, fewer pixels are rendered, and each evaluates fewer VPLs, to keep to "
             "this "
             "time; 0: always in full");
    }
    text(fmt::format("now: {:.0f} % of the sides, one in {} VPLs a pixel", 100.0F * present.scale,
                     present.interleave * present.interleave));
}

}  // namespace

void draw_quality_panel(Configuration& configuration, const Quality& present) {
    draw_presets(configuration);
    ImGui::Separator();
    draw_paths(configuration.path);
    draw_list_settings(info_of(configuration.path).lights, configuration.lists);
    draw_vpls(configuration);
    checkbox("shadows", configuration.shadows.enabled, "of lights that cast shadows");
    ImGui::Separator();
    draw_refinement(configuration.refinement);
    draw_frame_budget(configuration.frame_budget_ms, present);
    drag("exposure, EV", configuration.tone_map.exposure_ev, 0.02F, -32.0F, 32.0F,
         "in stops: radiance is multiplied by 2 to this power");
}

}  // namespace candela::sandbox
