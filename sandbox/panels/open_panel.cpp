#include "sandbox/panels/open_panel.hpp"

#include <algorithm>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace fs = std::filesystem;

void OpenPanel::show(std::vector<SceneList> lists) {
    lists_ = std::move(lists);
    typed_.clear();
    shown_ = true;
    appearing_ = true;
}

std::optional<fs::path> OpenPanel::draw() {
    if (!shown_) return std::nullopt;
    std::optional<fs::path> chosen;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float unit = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({0.5F * display.x, 0.5F * display.y}, ImGuiCond_Appearing, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({std::min(40.0F * unit, display.x), std::min(28.0F * unit, display.y)},
                             ImGuiCond_Appearing);
    if (ImGui::Begin("Open a scene", &shown_,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        if (std::exchange(appearing_, false)) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-8.0F * unit);
        const bool entered = ImGui::InputText("##file", &typed_, ImGuiInputTextFlags_EnterReturnsTrue);
        note_control("file name", "of a .gltf or .glb file; or drop a file on the window");
        ImGui::SameLine();
        if ((button("open file", "opens the file of this name") || entered) && !typed_.empty()) {
            chosen = typed_;
        }
        for (const SceneList& list : lists_) {
            if (list.files.empty()) continue;
            ImGui::Separator();
            ImGui::TextDisabled("%s", list.heading.c_str());
            for (const fs::path& file : list.files) {
                ImGui::PushID(&file);
                if (ImGui::Selectable(file.filename().string().c_str())) chosen = file;
                note_control(file.filename().string(), file.string().c_str());
                ImGui::PopID();
            }
        }
    }
    ImGui::End();
    if (chosen) shown_ = false;
    return chosen;
}

}  // namespace candela::sandbox
