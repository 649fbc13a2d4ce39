#include "sandbox/panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <candela/scene/components.hpp>
#include "sandbox/environment.hpp"
#include "sandbox/report.hpp"

namespace candela::sandbox {

namespace {

void text(const std::string& line) {
    ImGui::TextUnformatted(line.c_str());
}

template <class Enum, std::size_t N>
void combo(const char* label, Enum& value, const std::array<Enum, N>& choices) {
    if (!ImGui::BeginCombo(label, std::string(to_string(value)).c_str())) return;
    for (const Enum choice : choices) {
        if (ImGui::Selectable(std::string(to_string(choice)).c_str(), choice == value)) value = choice;
    }
    ImGui::EndCombo();
}

void drag(const char* label, std::uint32_t& value, float speed) {
    ImGui::DragScalar(label, ImGuiDataType_U32, &value, speed);
}

/// A named configuration describes how a frame is rendered; refinement and the frame budget stay as they are.
Configuration paced_as(const Configuration& present, Configuration named) {
    named.refinement = present.refinement;
    named.frame_budget_ms = present.frame_budget_ms;
    return named;
}

/// A list of named configurations. Shows "custom" if the current one matches none of them.
void draw_named_configurations(Configuration& value) {
    const auto named = named_configurations();
    const auto is_value = [&](const NamedConfiguration& choice) {
        return paced_as(value, choice.configuration) == value;
    };
    const auto shown = std::find_if(named.begin(), named.end(), is_value);
    if (!ImGui::BeginCombo("configuration",
                           shown == named.end() ? "custom" : std::string(shown->name).c_str()))
        return;
    for (const NamedConfiguration& choice : named) {
        if (ImGui::Selectable(std::string(choice.name).c_str(), is_value(choice)))
            value = paced_as(value, choice.configuration);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(choice.description).c_str());
    }
    ImGui::EndCombo();
}

/// The settings of the path's light lists; draws nothing if it has none.
void draw_list_settings(LightList list, ListSettings& settings) {
    if (list == LightList::all) return;
    for (const std::uint32_t size : {16U, 32U, 64U}) {
        if (ImGui::RadioButton(fmt::format("{}", size).c_str(), settings.tile_size == size))
            settings.tile_size = size;
        ImGui::SameLine();
    }
    text("tile size");
    if (list == LightList::cluster) drag("slices", settings.slices, 0.2F);
}

void draw_visibility(VplVisibilitySettings& settings) {
    combo("VPL visibility", settings.method,
          std::array{VplVisibility::none, VplVisibility::maps, VplVisibility::rays});
    if (settings.method == VplVisibility::maps) drag("VPL map texels", settings.map_resolution, 0.2F);
}

void draw_refinement(RefinementSettings& settings) {
    ImGui::Checkbox("refine while still", &settings.enabled);
    if (settings.enabled) drag("frames to refine", settings.frames, 1.0F);
}

/// `present` is the quality of the last frame.
void draw_frame_budget(std::optional<float>& budget_ms, const Quality& present) {
    bool automatic = !budget_ms;
    if (ImGui::Checkbox("frame time: automatic", &automatic)) {
        if (automatic) {
            budget_ms.reset();
        } else {
            budget_ms = 0.0F;
        }
    }
    if (budget_ms) ImGui::DragFloat("frame time, ms", &*budget_ms, 0.5F, 0.0F, 1e6F, "%.3g");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "while something moves, fewer pixels are rendered, and each asks fewer VPLs; 0: always in full");
    text(fmt::format("rendered: {:.0f} % of the sides, one in {} VPLs a pixel", 100.0F * present.scale,
                     present.interleave * present.interleave));
}

void draw_playback(Playback& playback) {
    int frame = playback.frame();
    if (ImGui::SliderInt("frame", &frame, 0, playback.frames() - 1, "%d", ImGuiSliderFlags_AlwaysClamp))
        playback.seek(frame);
    if (ImGui::Button(playback.playing() ? "pause" : "play")) playback.toggle();
    ImGui::SameLine();
    if (ImGui::Button("step")) playback.step();
    ImGui::SameLine();
    text("(space, period)");
}

void draw_cameras(const World& world, Interaction& interaction) {
    if (!ImGui::BeginCombo("camera", name_of(world, interaction.camera()).c_str())) return;
    for (const Entity camera : cameras(world)) {
        if (camera == interaction.viewer()) continue;
        ImGui::PushID(static_cast<int>(camera.index));
        if (ImGui::Selectable(name_of(world, camera).c_str(), camera == interaction.camera()))
            interaction.look_from_camera(camera);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void draw_light_list(const World& world, std::optional<Entity>& selected) {
    const std::string shown = selected ? name_of(world, *selected) : "none";
    if (!ImGui::BeginCombo("light", shown.c_str())) return;
    const auto list = [&](Entity entity) {
        ImGui::PushID(static_cast<int>(entity.index));
        if (ImGui::Selectable(name_of(world, entity).c_str(), selected == entity)) selected = entity;
        ImGui::PopID();
    };
    for (auto [entity, light] : world.view<PointLight>()) list(entity);
    for (auto [entity, light] : world.view<SpotLight>()) list(entity);
    for (auto [entity, light] : world.view<DirectionalLight>()) list(entity);
    ImGui::EndCombo();
}

/// The colour and strength of a light component, if the entity has it.
template <class Light>
void draw_emission(World& world, Entity entity, float Light::*strength, const char* unit) {
    if (!world.has<Light>(entity)) return;
    world.edit<Light>(entity, [&](Light& light) {
        constexpr float any = std::numeric_limits<float>::max();
        ImGui::DragFloat(unit, &(light.*strength), 0.05F + 0.01F * light.*strength, 0.0F, any, "%.3g",
                         ImGuiSliderFlags_AlwaysClamp);
        ImGui::ColorEdit3("colour", &light.colour.r, ImGuiColorEditFlags_Float);
        ImGui::Checkbox("casts shadow", &light.casts_shadow);
    });
}

void draw_lights(World& world, std::optional<Entity>& selected) {
    draw_light_list(world, selected);
    if (!selected) return;
    draw_emission(world, *selected, &PointLight::intensity, "candela");
    draw_emission(world, *selected, &SpotLight::intensity, "candela");
    draw_emission(world, *selected, &DirectionalLight::illuminance, "lux");
}

void draw_sky(World& world) {
    const Entity entity = environment_entity(world);
    if (entity == Entity{}) {
        if (ImGui::Button("add a sky")) set_environment(world, {.radiance = default_sky, .picture = nullptr});
        return;
    }
    world.edit<Environment>(entity, [](Environment& environment) {
        constexpr float any = std::numeric_limits<float>::max();
        ImGui::DragFloat3("sky", &environment.radiance.r, 0.01F, 0.0F, any, "%.3g",
                          ImGuiSliderFlags_AlwaysClamp);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("radiance of the sky, cd/m²; multiplies its picture, if it has one");
        if (environment.picture) ImGui::SliderAngle("rotation", &environment.rotation, -180.0F, 180.0F);
    });
}

void draw_passes(const FrameReport& frame) {
    if (!ImGui::BeginTable("passes", 3, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("pass");
    ImGui::TableSetupColumn("CPU ms");
    ImGui::TableSetupColumn("GPU ms");
    ImGui::TableHeadersRow();
    const auto row = [](const std::string& name, double cpu_ms, double gpu_ms) {
        ImGui::TableNextColumn();
        text(name);
        ImGui::TableNextColumn();
        text(fmt::format("{:.3f}", cpu_ms));
        ImGui::TableNextColumn();
        text(fmt::format("{:.3f}", gpu_ms));
    };
    for (const PassReport& pass : frame.passes) {
        // Passes that did not run are dimmed.
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, pass.ran ? 1.0F : 0.4F);
        row(pass.name, pass.cpu_ms, pass.gpu_ms);
        ImGui::PopStyleVar();
    }
    row("frame", frame.cpu_ms, frame.gpu_ms);
    ImGui::EndTable();
}

void draw_light_counts(const LightReport& lights) {
    text(fmt::format("shadow maps: {}, no room for {}", lights.with_shadow, lights.without_shadow));
    if (lights.tile_max == 0) return;
    text(fmt::format("a list: {:.1f} in the mean, {} at most", lights.tile_mean, lights.tile_max));
    text(fmt::format("in all lists: {}", lights.global));
}

void draw_vpls(const VplReport& vpls) {
    text(fmt::format("{} of {} VPLs alive", vpls.alive, vpls.requested));
    for (const EnergyLine& line : energy_lines(vpls.flux)) {
        text(fmt::format("{:<10}{:>9.3g}{:>9.3g}{:>9.3g}", line.name, line.value.r, line.value.g,
                         line.value.b));
    }
    text(fmt::format("unaccounted for: {:.1e}", relative_residual(vpls.flux)));
}

void draw_warnings(const std::vector<std::string>& warnings) {
    if (warnings.empty()) return;
    if (!ImGui::CollapsingHeader("About this scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
    for (const std::string& warning : warnings) ImGui::TextWrapped("%s", warning.c_str());
}

}  // namespace

void Panel::draw(Renderer& renderer, World& world, Interaction& interaction, Playback* playback,
                 const FrameReport& frame) {
    if (!visible) return;
    Configuration wanted = renderer.configuration();
    const float scale = ImGui::GetIO().FontGlobalScale;
    ImGui::SetNextWindowPos({8.0F, 8.0F}, ImGuiCond_FirstUseEver);
    const bool open = ImGui::Begin("Candela (F1)", &visible, ImGuiWindowFlags_AlwaysAutoResize);
    if (open) {
        ImGui::PushItemWidth(150.0F * scale);
        draw_configuration(wanted, renderer.quality());
        ImGui::Separator();
        draw_cameras(world, interaction);
        draw_lights(world, interaction.selected);
        draw_sky(world);
        if (playback != nullptr && ImGui::CollapsingHeader("Animation", ImGuiTreeNodeFlags_DefaultOpen))
            draw_playback(*playback);
        if (ImGui::CollapsingHeader("Passes", ImGuiTreeNodeFlags_DefaultOpen)) draw_passes(frame);
        if (ImGui::CollapsingHeader("Energy: lights in, surfaces out")) draw_account(renderer);
        draw_warnings(warnings);
        ImGui::PopItemWidth();
    }
    ImGui::End();
    // After drawing the account, which describes the last frame and thus the old configuration.
    if (wanted != renderer.configuration()) errors = renderer.configure(wanted);
}

void Panel::draw_configuration(Configuration& wanted, const Quality& present) {
    draw_named_configurations(wanted);
    combo("path", wanted.path, all_shading_paths);
    draw_list_settings(info_of(wanted.path).lights, wanted.lists);
    combo("show", wanted.show, std::array{Show::total, Show::direct, Show::indirect});
    ImGui::Checkbox("indirect light", &wanted.indirect);
    combo("placement", wanted.vpls.placement, std::array{VplPlacement::paths, VplPlacement::surfels});
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("VPLs where paths from the lights meet surfaces, or evenly on all surfaces");
    drag("VPLs", wanted.vpls.count, 1.0F);
    drag("bounces", wanted.vpls.bounces, 0.05F);
    drag("seed", wanted.vpls.seed, 0.05F);
    draw_visibility(wanted.visibility);
    combo("interleave", wanted.interleave,
          std::array{Interleave::automatic, Interleave::one, Interleave::two, Interleave::four,
                     Interleave::eight});
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("with N, a pixel asks one in N² VPLs, and takes the rest from its neighbours");
    draw_refinement(wanted.refinement);
    draw_frame_budget(wanted.frame_budget_ms, present);
    ImGui::DragFloat("geometry bound", &wanted.geometry_bound, 0.01F);
    ImGui::Checkbox("shadows", &wanted.shadows.enabled);
    ImGui::DragFloat("exposure (EV)", &wanted.tone_map.exposure_ev, 0.02F);

    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 96, 96, 255));
    for (const std::string& error : errors) ImGui::TextWrapped("%s", error.c_str());
    ImGui::PopStyleColor();
}

/// Reading the account back waits for the GPU, so it is done only a few times per second, and only while it
/// is visible.
void Panel::draw_account(Renderer& renderer) {
    constexpr double refresh = 0.25;  // seconds
    if (!report_ || ImGui::GetTime() - report_time_ > refresh) {
        report_ = renderer.report();
        report_time_ = ImGui::GetTime();
    }
    text(fmt::format("{} triangles, {} lights", report_->triangles, report_->lights.count));
    draw_light_counts(report_->lights);
    if (report_->vpls) draw_vpls(*report_->vpls);
}

}  // namespace candela::sandbox
