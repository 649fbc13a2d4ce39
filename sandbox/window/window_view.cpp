#include "sandbox/window/window_view.hpp"

#include <glm/common.hpp>

#include <candela/scene/hierarchy.hpp>
#include "sandbox/panels/controls.hpp"
#include "sandbox/panels/overlay.hpp"
#include "sandbox/panels/quality_panel.hpp"
#include "sandbox/panels/resource_view.hpp"
#include "sandbox/panels/scene_panel.hpp"
#include "sandbox/panels/view_panel.hpp"
#include "sandbox/panels/vpl_details.hpp"
#include "sandbox/panels/vpl_dots.hpp"
#include "sandbox/window/gui.hpp"

namespace candela::sandbox {

namespace {

void draw_pictures(const RenderedFrame& shown, const Comparison& comparison, const Rectangle& scene) {
    const bool is_difference = shown.difference && comparison.mode == CompareMode::difference;
    draw_picture(is_difference ? shown.difference->texture : shown.picture.texture, scene);
    if (shown.other && comparison.mode == CompareMode::divider) {
        draw_picture(shown.other->texture, scene, comparison.divider, 1.0F);
    }
}

void draw_overlay(SessionState& state) {
    const Interaction& interaction = state.document->interaction;
    const World& world = state.document->scene.world;
    const Rectangle& scene = state.layout.scene;
    const Viewport viewport = make_viewport(world, interaction.viewer(), scene.size, scene.corner);
    const glm::vec3 eye(world_matrix(world, interaction.viewer())[3]);
    if (state.app.vpls) {
        draw_vpl_dots(
            state.shown->vpls, viewport,
            [&](const glm::vec3& point) { return !interaction.surfaces().blocked(eye, point); },
            state.app.chosen_vpl);
    }
    if (state.app.vpls && state.app.chosen_vpl && !state.shown->vpls.empty()) {
        const std::size_t index = *vpl_at(state.shown->vpls, *state.app.chosen_vpl);
        draw_vpl_details(index, details_of(world, interaction.surfaces(), state.shown->vpls, index),
                         state.app.chosen_vpl, scene);
    }
    const Overlay overlay = interaction.overlay(viewport, !ImGui::GetIO().WantCaptureMouse);
    draw_lights(overlay.lights);
    draw_rings(overlay.others);
    if (overlay.gizmo) draw_gizmo(*overlay.gizmo, overlay.active);
}

/// The pixel under the pointer is asked for, and told when its values are there.
void draw_probed(SessionState& state) {
    const Rectangle& scene = state.layout.scene;
    const glm::vec2 pointer(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y);
    if (!state.app.probe || ImGui::GetIO().WantCaptureMouse || !scene.contains(pointer)) return;
    const glm::vec2 size(state.shown->picture.size);
    glm::vec2 share = (pointer - scene.corner) / scene.size;
    share.y = 1.0F - share.y;  // the bottom row is the first
    state.app.probed = glm::uvec2(glm::clamp(share * size, glm::vec2(0.0F), size - 1.0F));
    if (state.shown->probed) draw_probe(words_of(*state.shown->probed), scene);
}

/// What shows where there is no picture. Pictures cover it: without a GPU, filling the window takes as long
/// as drawing one.
void draw_ground(glm::vec2 window) {
    ImGui::GetBackgroundDrawList()->AddRectFilled({0.0F, 0.0F}, {window.x, window.y},
                                                  IM_COL32(24, 24, 26, 255));
}

/// A tab, whose content `draw` draws while it is open.
template <class F>
void tab(const char* name, const char* tip, const F& draw) {
    if (!begin_tab(name, tip)) return;
    draw();
    ImGui::EndTabItem();
}

void draw_tabs(SessionState& state, std::vector<Action>& wanted) {
    tab("Scene", "cameras, lights, objects, animation", [&] {
        if (!state.document) return;
        for (const Action action : draw_scene_panel(*state.document, state.app, state.report())) {
            wanted.push_back(action);
        }
    });
    tab("Quality", "how a frame is computed", [&] {
        draw_quality_panel(state.app.configuration, state.app.noise_limit,
                           state.shown ? state.shown->quality : Quality{});
    });
    tab("Light", "what of the light is shown; comparisons",
        [&] { draw_view_panel(state.app, state.report(), state.reference, state.costs.frame().mean_ms); });
    tab("Graph", "what the frame graph does, and what it costs",
        [&] { draw_graph_panel(state.selection, state.graph, state.costs); });
}

/// At the right end of the status line. Whether it was clicked.
bool draw_panel_button(bool panel, const Rectangle& at) {
    ImGui::SetNextWindowPos({at.corner.x, at.corner.y});
    ImGui::SetNextWindowSize({at.size.x, at.size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0F, 1.0F});
    bool clicked = false;
    if (ImGui::Begin("panel button", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing)) {
        clicked = ImGui::Button(panel ? ">" : "<", {at.size.x, at.size.y});
        note_control("panel", panel ? "hides the panel: F1" : "shows the panel: F1");
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
    return clicked;
}

}  // namespace

void draw_scene(SessionState& state, glm::vec2 window) {
    if (!state.shown || !state.document) return draw_ground(window);
    const RenderedFrame& shown = *state.shown;
    if (state.selection.resource && shown.inspection) {
        draw_ground(window);
        return draw_resource(*state.selection.resource, state.selection.inspection, *shown.inspection,
                             shown.elements, state.layout.scene);
    }
    draw_pictures(shown, state.app.comparison, state.layout.scene);
    draw_overlay(state);
    draw_probed(state);
    draw_comparison(state.app.comparison, side_labels(state.app, state.reference), state.layout.scene);
}

std::vector<Action> draw_panel(SessionState& state) {
    const Rectangle& panel = state.layout.panel;
    std::vector<Action> wanted;
    if (draw_panel_button(state.app.panel, state.layout.panel_button)) wanted.push_back(Action::panel);
    if (panel.size.x < 1.0F) return wanted;
    ImGui::SetNextWindowPos({panel.corner.x, panel.corner.y});
    ImGui::SetNextWindowSize({panel.size.x, panel.size.y});
    constexpr ImGuiWindowFlags docked = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoBringToFrontOnFocus;
    if (ImGui::Begin("panel", nullptr, docked) && ImGui::BeginTabBar("tabs")) {
        ImGui::PushItemWidth(0.45F * ImGui::GetContentRegionAvail().x);
        ImGui::PushTextWrapPos(0.0F);
        draw_tabs(state, wanted);
        ImGui::PopTextWrapPos();
        ImGui::PopItemWidth();
        ImGui::EndTabBar();
    }
    ImGui::End();
    return wanted;
}

}  // namespace candela::sandbox
