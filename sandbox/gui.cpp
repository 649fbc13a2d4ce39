#include "sandbox/gui.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace candela::sandbox {

namespace {

/// The scale of panels on dense displays where a window coordinate is a pixel; >= 1.
float panel_scale(const Window& window) {
    float content = 1.0F;
    glfwGetWindowContentScale(window.handle(), &content, nullptr);
    const auto pixels = static_cast<float>(window.framebuffer_size().x);
    const auto units = static_cast<float>(window.size().x);
    return pixels > 0.0F ? std::max(content * units / pixels, 1.0F) : 1.0F;
}

/// The light's hue at full brightness.
ImU32 marker_colour(glm::vec3 linear) {
    const float brightest = std::max({linear.r, linear.g, linear.b, 1e-6F});
    const auto encode = [&](float channel) { return std::pow(channel / brightest, 1.0F / 2.2F); };
    return ImGui::ColorConvertFloat4ToU32({encode(linear.r), encode(linear.g), encode(linear.b), 1.0F});
}

}  // namespace

Gui::Gui(const Window& window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    const float scale = panel_scale(window);
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetIO().FontGlobalScale = scale;
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
    ImGui_ImplOpenGL3_Init("#version 450");
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Gui::end_frame() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::wants(InputEvent::Kind kind) const {
    const ImGuiIO& io = ImGui::GetIO();
    switch (kind) {
        case InputEvent::Kind::press:
        case InputEvent::Kind::scroll:
            return io.WantCaptureMouse;
        case InputEvent::Kind::key:
            return io.WantCaptureKeyboard;
        case InputEvent::Kind::move:
        case InputEvent::Kind::release:
            break;
    }
    return false;
}

void show_words(Gui& gui, Window& window, const std::string& words) {
    gui.begin_frame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const ImVec2 extent = ImGui::CalcTextSize(words.c_str());
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddRectFilled({0.0F, 0.0F}, size, IM_COL32(0, 0, 0, 255));
    list->AddText({0.5F * (size.x - extent.x), 0.5F * (size.y - extent.y)}, IM_COL32(255, 255, 255, 255),
                  words.c_str());
    gui.end_frame();
    window.swap();
}

void draw_markers(const std::vector<LightMarker>& markers, const Viewport& viewport,
                  std::optional<Entity> selected) {
    constexpr ImU32 black = IM_COL32(0, 0, 0, 200);
    constexpr ImU32 white = IM_COL32(255, 255, 255, 255);
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    for (const LightMarker& marker : markers) {
        const std::optional<glm::vec2> seen_at = project(viewport, marker.position);
        if (!seen_at) continue;
        const ImVec2 centre(seen_at->x, seen_at->y);
        const bool is_selected = marker.entity == selected;
        const float radius = is_selected ? 9.0F : 6.0F;
        list->AddCircleFilled(centre, radius, marker_colour(marker.colour));
        list->AddCircle(centre, radius, is_selected ? white : black, 0, 2.0F);
        const ImVec2 text(centre.x + radius + 4.0F, centre.y - ImGui::GetFontSize() * 0.5F);
        list->AddText({text.x + 1.0F, text.y + 1.0F}, black, marker.name.c_str());
        list->AddText(text, white, marker.name.c_str());
    }
}

}  // namespace candela::sandbox
