#include "sandbox/panels/vpl_dots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <imgui.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "sandbox/panels/controls.hpp"
#include "sandbox/panels/vpl_details.hpp"

namespace candela::sandbox {

namespace {

float brightness(const VplDot& dot) {
    return std::max({dot.flux.r, dot.flux.g, dot.flux.b});
}

/// The hue of the flux; VPLs without flux are grey.
ImU32 dot_colour(const VplDot& dot) {
    const float most = brightness(dot);
    if (most <= 0.0F) return IM_COL32(90, 90, 90, 255);
    const glm::vec3 hue = glm::pow(dot.flux / most, glm::vec3(1.0F / 2.2F));
    return ImGui::ColorConvertFloat4ToU32({hue.r, hue.g, hue.b, 1.0F});
}

std::optional<ImVec2> on_screen(const Viewport& viewport, const glm::vec3& point) {
    const std::optional<glm::vec2> at = project(viewport, point);
    return at ? std::optional(ImVec2(at->x, at->y)) : std::nullopt;
}

/// A disc with the area of the VPL's cell, and its normal, as long as the disc's radius.
void draw_cell(ImDrawList& list, const VplDot& dot, const Viewport& viewport) {
    constexpr int corners = 32;
    const float radius = std::sqrt(std::max(dot.area, 0.0F) / glm::pi<float>());
    const glm::vec3 other =
        std::abs(dot.normal.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 x = glm::normalize(glm::cross(other, dot.normal)) * radius;
    const glm::vec3 y = glm::cross(dot.normal, x);
    for (int i = 0; i <= corners; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / corners;
        const auto at = on_screen(viewport, dot.position + std::cos(angle) * x + std::sin(angle) * y);
        if (!at) {
            list.PathClear();
            return;
        }
        list.PathLineTo(*at);
    }
    list.PathStroke(IM_COL32_WHITE, 0, 1.5F);
    const auto from = on_screen(viewport, dot.position);
    const auto to = on_screen(viewport, dot.position + dot.normal * (radius > 0.0F ? radius : 0.1F));
    if (from && to) list.AddLine(*from, *to, IM_COL32(255, 220, 60, 255), 2.0F);
}

void tell_values(const VplDot& dot, std::size_t index) {
    ImGui::SetTooltip(
        "VPL %zu\nflux %.4g %.4g %.4g lm\nnormal %.2f %.2f %.2f\nat %.3f %.3f %.3f m\ncell %.4g m²", index,
        static_cast<double>(dot.flux.r), static_cast<double>(dot.flux.g), static_cast<double>(dot.flux.b),
        static_cast<double>(dot.normal.x), static_cast<double>(dot.normal.y),
        static_cast<double>(dot.normal.z), static_cast<double>(dot.position.x),
        static_cast<double>(dot.position.y), static_cast<double>(dot.position.z),
        static_cast<double>(dot.area));
}

void draw_neighbours(ImDrawList& list, const std::vector<VplDot>& dots, std::size_t chosen,
                     const Viewport& viewport) {
    constexpr std::size_t most = 6;
    draw_cell(list, dots[chosen], viewport);
    const auto from = on_screen(viewport, dots[chosen].position);
    for (const NearVpl& other : nearest_vpls(dots, chosen, most)) {
        const auto to = on_screen(viewport, dots[other.index].position);
        if (from && to) list.AddLine(*from, *to, IM_COL32(110, 190, 255, 200), 1.5F);
    }
}

}  // namespace

void draw_vpl_dots(const std::vector<VplDot>& dots, const Viewport& viewport, const IsVisible& is_visible,
                   std::optional<glm::vec3>& chosen) {
    constexpr float lift =
        1e-3F;  // metres above the surface, so that the surface itself does not hide the dot
    const float unit = ImGui::GetFontSize() / 14.0F;
    float most = 0.0F;
    for (const VplDot& dot : dots) most = std::max(most, brightness(dot));
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    float nearest = 10.0F * unit;
    const VplDot* hovered = nullptr;
    for (const VplDot& dot : dots) {
        const auto at = on_screen(viewport, dot.position);
        if (!at || !is_visible(dot.position + lift * dot.normal)) continue;
        const float share = most > 0.0F ? brightness(dot) / most : 0.0F;
        const float radius = (2.0F + 4.0F * std::sqrt(share)) * unit;
        list.AddCircleFilled(*at, radius + unit, IM_COL32(0, 0, 0, 160), 12);
        list.AddCircleFilled(*at, radius, dot_colour(dot), 12);
        const float distance = std::hypot(at->x - pointer.x, at->y - pointer.y);
        if (distance >= nearest) continue;
        nearest = distance;
        hovered = &dot;
    }
    if (chosen && !dots.empty()) draw_neighbours(list, dots, *vpl_at(dots, *chosen), viewport);
    if (hovered == nullptr || ImGui::GetIO().WantCaptureMouse) return;
    draw_cell(list, *hovered, viewport);
    const auto index = static_cast<std::size_t>(hovered - dots.data());
    tell_values(*hovered, index);
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) chosen = hovered->position;
}

void draw_vpl_details(std::size_t index, const std::string& words, std::optional<glm::vec3>& chosen,
                      const Rectangle& scene) {
    const float inset = 0.6F * ImGui::GetFontSize();
    ImGui::SetNextWindowPos({scene.corner.x + inset, scene.corner.y + inset}, ImGuiCond_Appearing);
    ImGui::SetNextWindowBgAlpha(0.85F);
    bool stays = true;
    constexpr ImGuiWindowFlags fitted = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoFocusOnAppearing;
    const std::string title = fmt::format("VPL {}###vpl", index);
    if (ImGui::Begin(title.c_str(), &stays, fitted)) text(words);
    ImGui::End();
    if (!stays) chosen.reset();
}

}  // namespace candela::sandbox
