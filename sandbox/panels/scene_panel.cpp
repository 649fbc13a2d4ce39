#include "sandbox/panels/scene_panel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <candela/scene/components.hpp>
#include <candela/tools/run_report.hpp>
#include "sandbox/headless/report.hpp"
#include "sandbox/panels/controls.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/scene/studio.hpp"

namespace candela::sandbox {

namespace {

constexpr float any = std::numeric_limits<float>::max();

void draw_files(std::vector<Action>& wanted) {
    if (button("open", "Ctrl+O: another scene; or drop a file on the window")) {
        wanted.push_back(Action::open_scene);
    }
    ImGui::SameLine();
    if (button("save", "Ctrl+S: the scene as glTF, in the current folder")) {
        wanted.push_back(Action::save_scene);
    }
    ImGui::SameLine();
    if (button("screenshot", "F12: the picture as PNG, in the current folder")) {
        wanted.push_back(Action::screenshot);
    }
}

void draw_history(Interaction& interaction) {
    const auto offer = [&](const char* label, std::optional<std::string_view> name, Action action) {
        ImGui::BeginDisabled(!name);
        const std::string tip = name ? fmt::format("{} \"{}\"", label, *name) : std::string(label);
        if (button(label, tip.c_str())) interaction.carry_out(action);
        ImGui::EndDisabled();
        ImGui::SameLine();
    };
    offer("undo", interaction.history().undo_name(), Action::undo);
    offer("redo", interaction.history().redo_name(), Action::redo);
    if (button("frame", "F: look at the selection, or at the whole scene")) {
        interaction.carry_out(Action::frame_selected);
    }
    ImGui::SameLine();
    if (button("reset view", "Home: back to the scene's camera")) interaction.carry_out(Action::reset_view);
}

void draw_cameras(const World& world, Interaction& interaction) {
    const bool open = ImGui::BeginCombo("camera", name_of(world, interaction.camera()).c_str());
    note_control("camera", "the scene's camera that the view starts from");
    if (!open) return;
    for (const Entity camera : cameras(world)) {
        if (camera == interaction.viewer()) continue;
        ImGui::PushID(static_cast<int>(camera.index));
        if (ImGui::Selectable(name_of(world, camera).c_str(), camera == interaction.camera())) {
            interaction.look_from_camera(camera);
        }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

std::size_t selected_count(const Interaction& interaction) {
    return interaction.all_selected().size();
}

void draw_row(const ObjectRow& row, Interaction& interaction, std::span<const Entity> selected) {
    ImGui::PushID(static_cast<int>(row.entity.index));
    const float indent = static_cast<float>(row.depth) * ImGui::GetFontSize();
    if (indent > 0.0F) ImGui::Indent(indent);
    const bool is_selected = std::ranges::count(selected, row.entity) > 0;
    // A name may have the signs that separate labels from what only identifies them.
    if (ImGui::Selectable("##row", is_selected)) {
        if (ImGui::GetIO().KeyCtrl) {
            interaction.toggle(row.entity);
        } else {
            interaction.selected = row.entity;
        }
    }
    note_control(row.name, nullptr);
    ImGui::SameLine(0.0F, 0.0F);
    text(row.name);
    ImGui::SameLine();
    ImGui::TextDisabled("%s", std::string(row.kind).c_str());
    if (indent > 0.0F) ImGui::Unindent(indent);
    ImGui::PopID();
}

void draw_objects(Document& document) {
    if (!header("Objects", true)) return;
    Interaction& interaction = document.interaction;
    ImGui::SetNextItemWidth(-4.0F * ImGui::GetFontSize());
    ImGui::InputText("find", &document.objects.find);
    note_control(
        "find",
        "lights and objects whose names have this; a click on one selects it, as in the picture, with "
        "Ctrl besides the others");
    constexpr int most_lines = 9;
    const std::vector<ObjectRow>& rows = document.objects.rows(document.scene.world);
    const int lines = std::clamp(static_cast<int>(rows.size()), 1, most_lines);
    const float height = ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(lines) +
                         2.0F * ImGui::GetStyle().WindowPadding.y;
    if (ImGui::BeginChild("objects", {0.0F, height}, true)) {
        if (rows.empty()) ImGui::TextDisabled("nothing of this name");
        const std::vector<Entity> selected = interaction.all_selected();
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(rows.size()));
        while (clipper.Step()) {
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                draw_row(rows[static_cast<std::size_t>(i)], interaction, selected);
            }
        }
    }
    ImGui::EndChild();
    note_control("objects", "a click selects, also in the picture; with Ctrl, besides the others");
    if (selected_count(interaction) > 1) {
        text(fmt::format("{} are selected, and moved, copied and deleted together",
                         selected_count(interaction)));
    }
}

void draw_lights_to_add(Interaction& interaction) {
    text("add a light:");
    const auto offer = [&](const char* label, Action action, const char* tip) {
        ImGui::SameLine();
        if (button(label, tip)) interaction.carry_out(action);
    };
    offer("point", Action::add_point_light, "L: a point light over the surface in the middle of the picture");
    offer("spot", Action::add_spot_light, "Shift+L: a spot light that shines on that surface");
    offer("sun", Action::add_directional_light, "Ctrl+L: a directional light");
}

void draw_tools(Interaction& interaction) {
    const auto offer = [&](const char* label, Tool tool, const char* tip) {
        if (choice(label, interaction.tool == tool, tip)) interaction.tool = tool;
        ImGui::SameLine();
    };
    offer("move", Tool::move, "G: drag it in the plane of the screen, or along an axis (X, Y, Z)");
    offer("over surfaces", Tool::surface, "V: it follows the surface under the pointer");
    offer("turn", Tool::turn, "R: around an axis; a spot light aims at what is under the pointer");
    offer("scale", Tool::scale, "T");
    ImGui::NewLine();
    if (button("copy", "Ctrl+D")) interaction.carry_out(Action::copy);
    ImGui::SameLine();
    if (button("delete", "Delete")) interaction.carry_out(Action::remove);
}

/// Angles around x, y and z, in degrees.
void draw_rotation(glm::quat& rotation) {
    glm::vec3 degrees = glm::degrees(glm::eulerAngles(rotation));
    if (drag("rotation, °", degrees, 0.5F, -360.0F, 360.0F, "degrees around x, then y, then z")) {
        rotation = glm::normalize(glm::quat(glm::radians(degrees)));
    }
}

void draw_transform(World& world, Entity entity) {
    if (!world.has<Transform>(entity)) return;
    world.edit<Transform>(entity, [&](Transform& transform) {
        drag("position, m", transform.translation, 0.01F, -any, any, "metres, relative to the parent");
        draw_rotation(transform.rotation);
        if (world.has<MeshInstance>(entity)) {
            drag("scale", transform.scale, 0.01F, -any, any, "along the object's own axes");
        }
    });
}

/// Metres; a light without a limit has an infinite range.
void draw_range(float& range) {
    bool limited = std::isfinite(range);
    if (checkbox("limited range", limited, "whether the light falls to zero at a distance")) {
        range = limited ? 10.0F : std::numeric_limits<float>::infinity();
    }
    if (limited) drag("range, m", range, 0.02F, 1e-3F, any, "metres; the light is zero from there on");
}

/// What only this kind of light has.
template <class Light>
void draw_shape(Light& /*light*/) {}

void draw_shape(SpotLight& light) {
    constexpr float widest = 90.0F;
    constexpr float narrowest = 0.1F;
    float inner = glm::degrees(light.inner_cone);
    float outer = glm::degrees(light.outer_cone);
    const bool changed_inner =
        slide("inner cone, °", inner, 0.0F, widest, "degrees from the axis; full intensity inside");
    const bool changed_outer =
        slide("outer cone, °", outer, narrowest, widest, "degrees from the axis; dark outside");
    if (!changed_inner && !changed_outer) return;
    // The cone that is changed pushes the other one.
    if (changed_outer) inner = std::min(inner, 0.99F * outer);
    if (changed_inner) outer = std::max(outer, std::min(inner / 0.99F, widest));
    light.inner_cone = glm::radians(std::min(inner, 0.99F * outer));
    light.outer_cone = glm::radians(outer);
}

template <class Light>
void draw_light(Light& light) {
    const LightTraits<Light>& kind = light_traits<Light>;
    float& strength = strength_of(light);
    drag(kind.unit, strength, 0.05F + 0.01F * strength, 0.0F, any, "of the light, in the middle of its cone");
    colour("colour", light.colour, "linear RGB; multiplies the strength");
    checkbox("casts shadow", light.casts_shadow, "whether surfaces block its light");
    if (kind.range != nullptr) draw_range(light.*kind.range);
    draw_shape(light);
}

void draw_name(World& world, Entity entity) {
    std::string name = world.has<Name>(entity) ? world.get<Name>(entity).value : "";
    if (ImGui::InputText("name", &name)) world.set(entity, Name{name});
    note_control("name", "scripts find a node by its name");
}

/// The fields change the world directly; the history takes note of it afterwards.
void draw_fields(Document& document, Entity entity) {
    World& world = document.scene.world;
    EntityStates before = states_of(world, {entity});
    draw_name(world, entity);
    draw_transform(world, entity);
    edit_lights_of(world, entity, [](auto& light) { draw_light(light); });
    History& history = document.interaction.history();
    history.record(world, fmt::format("change {}", name_of(world, entity)), std::move(before));
    if (!ImGui::IsAnyItemActive()) history.end_of_gesture();
}

/// Returns whether the user has changed anything.
bool draw_material(Material& material) {
    glm::vec3 base_colour(material.base_colour);
    bool changed = colour("base colour", base_colour, "linear RGB; multiplies the texture, if there is one");
    base_colour = glm::clamp(base_colour, 0.0F, 1.0F);
    material.base_colour = glm::vec4(base_colour, material.base_colour.a);
    changed |= slide("metalness", material.metalness, 0.0F, 1.0F,
                     "the share that is metal; multiplies the texture, if there is one");
    changed |= slide("roughness", material.roughness, 0.0F, 1.0F,
                     "0: a mirror, 1: matt; multiplies the texture, if there is one");
    changed |= slide("specular", material.specular, 0.0F, 1.0F,
                     "what is not metal reflects in the mirror direction: 0: nothing, 1: as varnish does");
    const float strongest = std::max({material.emissive.r, material.emissive.g, material.emissive.b});
    changed |= drag("emission, cd/m²", material.emissive, 0.05F + 0.01F * strongest, 0.0F, any,
                    "radiance that it emits, linear RGB; multiplies the texture, if there is one");
    return changed;
}

/// The materials of the entity's mesh. They are shared: what changes, changes on all objects.
void draw_materials(Document& document, Entity entity) {
    const auto* const instance = document.scene.world.find<MeshInstance>(entity);
    if (instance == nullptr) return;
    const auto materials = materials_of(*instance->mesh);
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const std::string& name = materials[i]->name;
        const std::string label = name.empty() ? fmt::format("material {}", i + 1) : name;
        ImGui::PushID(static_cast<int>(i));
        if (header((label + "###material").c_str(), materials.size() == 1)) {
            Material material = document.material_edit.shown(materials[i]);
            if (draw_material(material)) document.material_edit.change(materials[i], std::move(material));
        }
        ImGui::PopID();
    }
}

void draw_selected(Document& document, std::vector<Action>& wanted) {
    Interaction& interaction = document.interaction;
    if (!interaction.selected) return;
    draw_tools(interaction);
    ImGui::SameLine();
    if (button(document.recorder ? "end recording###record" : "record###record",
               "Ctrl+R: records how it moves, as a script for --animate, in the current folder")) {
        wanted.push_back(Action::record_drag);
    }
    draw_fields(document, *interaction.selected);
    draw_materials(document, *interaction.selected);
}

void draw_studio(Document& document) {
    Scene& scene = document.scene;
    bool on = has_studio(scene);
    if (!checkbox(
            "studio", on,
            "a sky that is brighter above than below, in place of the scene's, and a light with a shadow")) {
        return;
    }
    EntityStates before = states_of(scene.world, touched_by_studio(scene));
    if (on) {
        add_studio(scene);
    } else {
        remove_studio(scene);
    }
    document.interaction.history().record(scene.world, on ? "add the studio" : "remove the studio",
                                          std::move(before));
    document.interaction.history().end_of_gesture();
}

void draw_sky(Document& document) {
    World& world = document.scene.world;
    const Entity entity = environment_entity(world);
    if (entity == Entity{}) {
        if (button("add a sky",
                   "the same radiance from all directions; or drop a .hdr or .exr file on the window")) {
            set_environment(world, {.radiance = default_sky, .picture = nullptr});
        }
        return;
    }
    EntityStates before = states_of(world, {entity});
    world.edit<Environment>(entity, [](Environment& environment) {
        drag("sky", environment.radiance, 0.01F, 0.0F, any,
             "radiance of the sky, cd/m²; multiplies its picture, if it has one");
        float degrees = glm::degrees(environment.rotation);
        if (environment.picture &&
            slide("rotation of the sky, °", degrees, -180.0F, 180.0F, "degrees around the vertical")) {
            environment.rotation = glm::radians(degrees);
        }
    });
    document.interaction.history().record(world, "change the sky", std::move(before));
}

void draw_playback(Playback& playback) {
    int frame = playback.frame();
    if (slide("frame", frame, 0, playback.frames() - 1, "of the script")) playback.seek(frame);
    if (button(playback.playing() ? "pause" : "play", "space")) playback.toggle();
    ImGui::SameLine();
    if (button("step", "period")) playback.step();
}

void draw_clip(World& world, Entity entity, ClipPlayback& clips) {
    AnimationPlayer player = world.get<AnimationPlayer>(entity);
    if (!played_clip(player)) return;
    ImGui::PushID(static_cast<int>(entity.index));
    if (ImGui::BeginCombo("clip", clip_name(player, player.clip).c_str())) {
        for (std::size_t clip = 0; clip < clips_of(player).size(); ++clip) {
            ImGui::PushID(static_cast<int>(clip));
            if (ImGui::Selectable(clip_name(player, clip).c_str(), clip == player.clip)) {
                player.clip = clip;
                player.time = 0.0;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    note_control("clip", "an animation of the scene's file");
    auto speed = static_cast<float>(player.speed);
    if (slide("speed", speed, -2.0F, 2.0F, "1: as in the file; negative: backwards")) {
        player.speed = static_cast<double>(speed);
    }
    if (player != world.get<AnimationPlayer>(entity)) {
        world.set(entity, player);
        clips.seek(world, entity, player.time);
    }
    auto time = static_cast<float>(player.time);
    if (slide("time, s", time, 0.0F, played_clip(player)->duration, "in the clip")) {
        clips.seek(world, entity, static_cast<double>(time));
    }
    ImGui::PopID();
}

void draw_clips(Document& document) {
    World& world = document.scene.world;
    for (const Entity player : animation_players(world)) draw_clip(world, player, document.clips);
    if (button(plays_clips(world) ? "pause" : "play", "space")) toggle_clips(world);
    ImGui::SameLine();
    if (button("step", "period")) document.clips.step(world);
    for (const std::string& fault : document.clips.faults()) text(fault);
}

void draw_light_counts(const LightReport& lights) {
    text(fmt::format("shadow maps: {}, by rays alone: {}", lights.with_map, lights.without_map));
    if (lights.tile_max == 0) return;
    text(fmt::format("a list: {:.1f} in the mean, {} at most", lights.tile_mean, lights.tile_max));
    text(fmt::format("in all lists: {}", lights.global));
}

void draw_vpls(const VplReport& vpls) {
    text(fmt::format("{} of {} VPLs alive", vpls.alive, vpls.requested));
    for (const tools::EnergyLine& line : tools::energy_lines(vpls.flux)) {
        text(fmt::format("{:<10}{:>9.3g}{:>9.3g}{:>9.3g}", line.name, line.value.r, line.value.g,
                         line.value.b));
    }
    text(fmt::format("unaccounted for: {:.1e}", relative_residual(vpls.flux)));
}

void draw_warnings(const std::vector<std::string>& warnings) {
    if (warnings.empty()) return;
    if (!header("About this scene", true)) return;
    for (const std::string& warning : warnings) text(warning);
}

void draw_account(const Report& report) {
    text(fmt::format("{} triangles, {} lights", report.triangles, report.lights.count));
    draw_light_counts(report.lights);
    if (report.vpls) draw_vpls(*report.vpls);
}

}  // namespace

std::vector<Action> draw_scene_panel(Document& document, const AppState& state, const Report* report) {
    std::vector<Action> wanted;
    const World& world = document.scene.world;
    draw_files(wanted);
    draw_history(document.interaction);
    draw_cameras(world, document.interaction);
    ImGui::Separator();
    draw_lights_to_add(document.interaction);
    draw_objects(document);
    draw_selected(document, wanted);
    document.material_edit.apply(document.scene.world, document.interaction.history(),
                                 !ImGui::IsAnyItemActive());
    ImGui::Separator();
    draw_studio(document);
    draw_sky(document);
    if (document.playback && header("Script", true)) draw_playback(*document.playback);
    if (!document.playback && world.count<AnimationPlayer>() > 0 && header("Animation", true)) {
        draw_clips(document);
    }
    if (report != nullptr && header("Energy: lights in, surfaces out", false)) draw_account(*report);
    draw_warnings(state.warnings);
    return wanted;
}

}  // namespace candela::sandbox
