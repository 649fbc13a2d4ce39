#include "sandbox/panels/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

constexpr ImU32 dark = IM_COL32(0, 0, 0, 200);

bool has_axis(DragKind kind) {
    return kind == DragKind::move_along_axis || kind == DragKind::turn_around_axis ||
           kind == DragKind::scale_along_axis;
}

bool is_turn(DragKind kind) {
    return kind == DragKind::turn_around_axis || kind == DragKind::turn_around_view;
}

/// The light's hue at full brightness.
ImU32 marker_colour(glm::vec3 linear, float alpha) {
    const float brightest = std::max({linear.r, linear.g, linear.b, 1e-6F});
    const auto encode = [&](float channel) { return std::pow(channel / brightest, 1.0F / 2.2F); };
    return ImGui::ColorConvertFloat4ToU32({encode(linear.r), encode(linear.g), encode(linear.b), alpha});
}

/// A white ring between two dark ones, so that it is seen on every colour.
void draw_ring(ImDrawList& list, ImVec2 centre, float radius, float thickness) {
    list.AddCircle(centre, radius, dark, 0, 3.0F * thickness);
    list.AddCircle(centre, radius, IM_COL32_WHITE, 0, thickness);
}

void draw_label(ImDrawList& list, ImVec2 at, const std::string& words) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    list.AddRectFilled({at.x - 3.0F, at.y - 1.0F}, {at.x + size.x + 3.0F, at.y + size.y + 1.0F}, dark, 3.0F);
    list.AddText(at, IM_COL32_WHITE, words.c_str());
}

constexpr ImGuiWindowFlags floating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

/// Draws the line between the two sides.
void draw_line_to_drag(Comparison& comparison, const Rectangle& scene) {
    const float grip = 0.5F * ImGui::GetFontSize();
    const float x = scene.corner.x + comparison.divider * scene.size.x;
    ImGui::SetNextWindowPos({x - grip, scene.corner.y});
    ImGui::SetNextWindowSize({2.0F * grip, scene.size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0F, 1.0F});
    if (ImGui::Begin("comparison", nullptr,
                     (floating & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoBackground)) {
        ImGui::InvisibleButton("dividing line", {2.0F * grip, scene.size.y});
        if (ImGui::IsItemActive()) {
            comparison.divider =
                std::clamp((ImGui::GetIO().MousePos.x - scene.corner.x) / scene.size.x, 0.0F, 1.0F);
        }
        if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        note_control("dividing line", "A left, B right");
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddLine({x, scene.corner.y}, {x, scene.corner.y + scene.size.y}, dark, 4.0F);
    list.AddLine({x, scene.corner.y}, {x, scene.corner.y + scene.size.y}, IM_COL32_WHITE, 1.5F);
}

}  // namespace

void draw_lights(const std::vector<LightLabel>& lights) {
    const float unit = ImGui::GetFontSize() / 14.0F;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const LightLabel& light : lights) {
        const ImVec2 centre(light.position.x, light.position.y);
        const float radius = (light.selected ? 9.0F : 6.0F) * unit;
        constexpr float hidden_alpha = 0.35F;
        list.AddCircleFilled(centre, radius, marker_colour(light.colour, light.hidden ? hidden_alpha : 1.0F));
        if (light.selected || light.hovered) {
            draw_ring(list, centre, radius + 2.0F * unit, 1.5F * unit);
        } else {
            list.AddCircle(centre, radius, light.hidden ? IM_COL32(0, 0, 0, 80) : dark, 0, 2.0F * unit);
        }
        if (!light.name.empty()) {
            draw_label(list, {centre.x + radius, centre.y + radius + 4.0F * unit}, light.name);
        }
    }
}

void draw_rings(const std::vector<glm::vec2>& positions) {
    const float unit = ImGui::GetFontSize() / 14.0F;
    for (const glm::vec2& at : positions) {
        draw_ring(*ImGui::GetBackgroundDrawList(), {at.x, at.y}, 9.0F * unit, 1.5F * unit);
    }
}

void draw_gizmo(const Gizmo& gizmo, std::optional<std::size_t> active) {
    constexpr std::array axis_colours{IM_COL32(235, 80, 80, 255), IM_COL32(90, 200, 90, 255),
                                      IM_COL32(90, 140, 255, 255)};
    const float unit = ImGui::GetFontSize() / 14.0F;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (std::size_t i = 0; i < gizmo.handles.size(); ++i) {
        const Handle& handle = gizmo.handles[i];
        const bool along = has_axis(handle.mode.kind);
        const ImU32 own =
            along ? axis_colours.at(static_cast<std::size_t>(handle.mode.axis)) : IM_COL32_WHITE;
        const ImU32 colour = active == i ? IM_COL32(255, 230, 80, 255) : own;
        if (handle.line.size() == 1) {
            const ImVec2 at(handle.line[0].x, handle.line[0].y);
            list.AddCircleFilled(at, 5.0F * unit, dark);
            list.AddCircleFilled(at, 4.0F * unit, colour);
            continue;
        }
        for (const auto& [paint, thickness] : {std::pair(dark, 5.0F), std::pair(colour, 2.5F)}) {
            for (const glm::vec2& point : handle.line) list.PathLineTo({point.x, point.y});
            list.PathStroke(paint, 0, thickness * unit);
        }
        if (!is_turn(handle.mode.kind)) {
            list.AddCircleFilled({handle.line.back().x, handle.line.back().y}, 4.0F * unit, colour);
        }
    }
}

void draw_comparison(Comparison& comparison, const SideLabels& labels, const Rectangle& scene) {
    const float gap = 0.7F * ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 corner(scene.corner.x, scene.corner.y);
    const ImVec2 end(scene.corner.x + scene.size.x, scene.corner.y + scene.size.y);
    if (comparison.mode == CompareMode::difference) {
        const std::string words = fmt::format("|A - B| · {:.3g}\n{}\n{}",
                                              static_cast<double>(comparison.factor), labels.a, labels.b);
        return draw_label(list, {corner.x + gap, corner.y + gap}, words);
    }
    if (comparison.mode != CompareMode::divider) return;
    draw_line_to_drag(comparison, scene);
    const float x = corner.x + comparison.divider * scene.size.x;
    // Neither reaches into the other's side.
    list.PushClipRect(corner, {x, end.y}, true);
    const float a_width = ImGui::CalcTextSize(labels.a.c_str()).x;
    draw_label(list, {std::max(x - gap - a_width, corner.x + gap), corner.y + gap}, labels.a);
    list.PopClipRect();
    list.PushClipRect({x, corner.y}, end, true);
    draw_label(list, {x + gap, corner.y + gap}, labels.b);
    list.PopClipRect();
}

std::string words_of(const ProbedPixel& pixel) {
    const glm::vec3 bytes = glm::round(255.0F * pixel.colour);
    return fmt::format("pixel {}, {}: radiance {:.4g} {:.4g} {:.4g}, colour {:.0f} {:.0f} {:.0f}", pixel.at.x,
                       pixel.at.y, pixel.radiance.r, pixel.radiance.g, pixel.radiance.b, bytes.r, bytes.g,
                       bytes.b);
}

void draw_probe(const std::string& words, const Rectangle& scene) {
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    const float gap = ImGui::GetFontSize();
    const float edge = scene.corner.x + scene.size.x - ImGui::CalcTextSize(words.c_str()).x - gap;
    draw_label(*ImGui::GetBackgroundDrawList(), {std::min(pointer.x + gap, edge), pointer.y + gap}, words);
}

void draw_messages(const std::vector<std::string>& errors, const std::string& notice,
                   const Rectangle& scene) {
    if (errors.empty() && notice.empty()) return;
    const float inset = 0.6F * ImGui::GetFontSize();
    ImGui::SetNextWindowPos({scene.corner.x + inset, scene.corner.y + scene.size.y - inset}, ImGuiCond_Always,
                            {0.0F, 1.0F});
    ImGui::SetNextWindowBgAlpha(0.85F);
    if (ImGui::Begin("messages", nullptr, floating | ImGuiWindowFlags_NoInputs)) {
        ImGui::PushTextWrapPos(std::max(scene.size.x - 4.0F * inset, 1.0F));
        if (!notice.empty()) ImGui::TextUnformatted(notice.c_str());
        ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 110, 110, 255));
        for (const std::string& error : errors) ImGui::TextUnformatted(error.c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

}  // namespace candela::sandbox
