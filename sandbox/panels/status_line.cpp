#include "sandbox/panels/status_line.hpp"

#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace candela::sandbox {

namespace {

constexpr ImGuiWindowFlags bar = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                 ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav |
                                 ImGuiWindowFlags_NoInputs;

/// Three quarters of a circle that turns once per second.
void draw_spinner(double seconds) {
    constexpr float turn = 6.2831853F;
    constexpr int segments = 24;
    const float radius = 0.4F * ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 centre(corner.x + radius, corner.y + 0.5F * ImGui::GetFontSize());
    const auto start = turn * static_cast<float>(seconds - std::floor(seconds));
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PathArcTo(centre, radius, start, start + 0.75F * turn, segments);
    list->PathStroke(IM_COL32(255, 200, 80, 255), 0, 0.15F * ImGui::GetFontSize());
    ImGui::Dummy({2.0F * radius, ImGui::GetFontSize()});
    ImGui::SameLine();
}

}  // namespace

std::string to_words(const Status& status) {
    std::string words = fmt::format("{:.1f} ms (mean {:.1f})", status.frame_ms, status.mean_ms);
    if (status.vpls > 0) words += fmt::format(" · {} VPLs", status.vpls);
    if (status.quality != Quality{} && !status.settled && status.quality.scale < 1.0F) {
        words += fmt::format(" · {:.0f} % of the sides while moving", 100.0F * status.quality.scale);
    }
    if (status.to_refine > 0) words += fmt::format(" · refined {}/{}", status.refined, status.to_refine);
    if (status.to_refine > 0 && status.noise)
        words += fmt::format(" · noise {:.2g} %", 100.0 * *status.noise);
    if (status.settled) words += " · done";
    return words;
}

void draw_status_line(const Status& status, const Rectangle& at, double seconds) {
    ImGui::SetNextWindowPos({at.corner.x, at.corner.y});
    ImGui::SetNextWindowSize({at.size.x, at.size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        {ImGui::GetStyle().ItemSpacing.x, 0.2F * ImGui::GetFontSize()});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0F, 1.0F});
    if (ImGui::Begin("status", nullptr, bar)) {
        if (!status.busy.empty()) {
            draw_spinner(seconds);
            ImGui::TextColored({1.0F, 0.8F, 0.3F, 1.0F}, "%s · ", status.busy.c_str());
            ImGui::SameLine(0.0F, 0.0F);
        }
        ImGui::TextUnformatted(to_words(status).c_str());
        if (!status.warning.empty()) {
            ImGui::SameLine(0.0F, 0.0F);
            ImGui::TextColored({1.0F, 0.5F, 0.4F, 1.0F}, " · %s", status.warning.c_str());
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
}

}  // namespace candela::sandbox
