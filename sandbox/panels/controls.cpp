#include "sandbox/panels/controls.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace candela::sandbox {

namespace {

ControlPlaces& places() {
    static ControlPlaces drawn;
    return drawn;
}

/// What Dear ImGui shows beside a control of this width: the label, or nothing if there is no room for it. It
/// then stands above the control.
std::string label_beside(const char* label, float width = ImGui::CalcItemWidth()) {
    const float needed = width + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(label).x;
    if (needed <= ImGui::GetContentRegionAvail().x) return label;
    text(label);
    return fmt::format("##{}", label);
}

void note_place(std::string_view label) {
    if (!ImGui::IsItemVisible()) return;
    const ImVec2 from = ImGui::GetItemRectMin();
    const ImVec2 to = ImGui::GetItemRectMax();
    const std::string_view shown = label.substr(0, label.find("##"));
    places()[std::string(shown)] = {{from.x, from.y}, {to.x - from.x, to.y - from.y}};
}

/// In lines of at most this width.
void draw_tip(const char* tip, float width) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(width);
    ImGui::TextUnformatted(tip);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

float tip_width() {
    constexpr float letters = 24.0F;  // letters' heights
    return letters * ImGui::GetFontSize();
}

}  // namespace

ControlPlaces take_control_places() {
    return std::exchange(places(), {});
}

void note_control(std::string_view label, const char* tip) {
    note_place(label);
    if (tip != nullptr && ImGui::IsItemHovered()) draw_tip(tip, tip_width());
}

bool begin_tab(const char* label, const char* tip) {
    const bool open = ImGui::BeginTabItem(label);
    note_place(label);
    if (!ImGui::IsItemHovered()) return open;
    const float edge = ImGui::GetWindowPos().x;
    const float padding = ImGui::GetStyle().WindowPadding.x;
    const float width = std::min(tip_width(), std::max(edge - 4.0F * padding, 1.0F));
    // Its size is only known a frame after it is first drawn, and no other frame may follow.
    const float needed = ImGui::CalcTextSize(tip, nullptr, false, width).x + 2.0F * padding;
    ImGui::SetNextWindowPos({edge - needed - padding, ImGui::GetItemRectMin().y});
    draw_tip(tip, width);
    return open;
}

void text(std::string_view line) {
    ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

bool button(const std::string& label, const char* tip) {
    const bool pressed = ImGui::Button(label.c_str());
    note_control(label, tip);
    return pressed;
}

bool checkbox(const char* label, bool& value, const char* tip) {
    const bool changed = ImGui::Checkbox(label_beside(label, ImGui::GetFrameHeight()).c_str(), &value);
    note_control(label, tip);
    return changed;
}

bool choice(const std::string& label, bool chosen, const char* tip) {
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = ImGui::Button(label.c_str());
    if (chosen) ImGui::PopStyleColor();
    note_control(label, tip);
    return pressed;
}

void same_line_if_it_fits(const std::string& label) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(label.c_str()).x + 2.0F * style.FramePadding.x;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width < right) ImGui::SameLine();
}

std::size_t choose(std::span<const Choice> choices, std::size_t chosen, const char* tip) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const std::string name(choices[i].name);
        const std::string help(choices[i].help);
        if (i > 0) same_line_if_it_fits(name);
        if (choice(name, i == chosen, help.empty() ? tip : help.c_str())) chosen = i;
    }
    return chosen;
}

bool drag(const char* label, std::uint32_t& value, float speed, std::uint32_t least, std::uint32_t most,
          const char* tip) {
    const bool changed = ImGui::DragScalar(label_beside(label).c_str(), ImGuiDataType_U32, &value, speed,
                                           &least, &most, nullptr, ImGuiSliderFlags_AlwaysClamp);
    note_control(label, tip);
    return changed;
}

bool drag(const char* label, float& value, float speed, float least, float most, const char* tip) {
    const bool changed = ImGui::DragFloat(label_beside(label).c_str(), &value, speed, least, most, "%.4g",
                                          ImGuiSliderFlags_AlwaysClamp);
    note_control(label, tip);
    return changed;
}

bool drag(const char* label, glm::vec3& value, float speed, float least, float most, const char* tip) {
    const bool changed = ImGui::DragFloat3(label_beside(label).c_str(), &value.x, speed, least, most, "%.4g",
                                           ImGuiSliderFlags_AlwaysClamp);
    note_control(label, tip);
    return changed;
}

bool slide(const char* label, float& value, float least, float most, const char* tip) {
    const bool changed = ImGui::SliderFloat(label_beside(label).c_str(), &value, least, most, "%.3g",
                                            ImGuiSliderFlags_AlwaysClamp);
    note_control(label, tip);
    return changed;
}

bool slide(const char* label, int& value, int least, int most, const char* tip) {
    const bool changed = ImGui::SliderInt(label_beside(label).c_str(), &value, least, most, "%d",
                                          ImGuiSliderFlags_AlwaysClamp);
    note_control(label, tip);
    return changed;
}

bool colour(const char* label, glm::vec3& value, const char* tip) {
    const bool changed = ImGui::ColorEdit3(label_beside(label).c_str(), &value.r, ImGuiColorEditFlags_Float);
    note_control(label, tip);
    return changed;
}

bool header(const char* label, bool open) {
    const bool shown = ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note_control(label, nullptr);
    return shown;
}

}  // namespace candela::sandbox
