#include "sandbox/panels/help_panel.hpp"

#include <string_view>

#include "sandbox/editing/key_bindings.hpp"
#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

void draw_row(std::string_view keys, std::string_view help) {
    ImGui::TableNextColumn();
    text(keys);
    ImGui::TableNextColumn();
    text(help);
}

}  // namespace

void draw_help(bool& shown, const Rectangle& scene) {
    if (!shown) return;
    const ImVec2 centre(scene.corner.x + 0.5F * scene.size.x, scene.corner.y + 0.5F * scene.size.y);
    ImGui::SetNextWindowPos(centre, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {scene.size.x, scene.size.y});
    ImGui::SetNextWindowBgAlpha(0.9F);
    constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                       ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("Keys", &shown, fixed) && ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const KeyBinding& binding : key_bindings()) {
            if (!binding.help.empty()) draw_row(binding.keys, binding.help);
        }
        for (const MouseHelp& mouse : mouse_help()) draw_row(mouse.buttons, mouse.help);
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace candela::sandbox
