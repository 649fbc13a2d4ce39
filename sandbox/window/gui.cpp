#include "sandbox/window/gui.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <type_traits>

#include "sandbox/files/shipped_file.hpp"

namespace candela::sandbox {

namespace {

constexpr float text_size = 14.0F;  // pixels at a scale of 1

/// The letters that panels use: Latin, Greek, punctuation, superscripts, arrows, mathematical signs, shapes.
constexpr std::array<ImWchar, 15> letters{0x20,   0xFF,   0x370,  0x3FF,  0x2010, 0x2027, 0x2070, 0x209F,
                                          0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};

/// Fonts are drawn at the size in which they are shown, so that they are sharp at every scale.
void load_font(float pixels) {
    ImFontAtlas* fonts = ImGui::GetIO().Fonts;
    fonts->Clear();
    std::error_code ignored;
    const std::filesystem::path font = shipped_file("", "DejaVuSans.ttf");
    if (std::filesystem::exists(font, ignored) &&
        fonts->AddFontFromFileTTF(font.c_str(), pixels, nullptr, letters.data()) != nullptr) {
        return;
    }
    ImFontConfig config;
    config.SizePixels = pixels;
    fonts->AddFontDefault(&config);
}

/// A pointer in older versions of Dear ImGui, a number in newer ones.
template <class Id>
Id texture_id(std::uint32_t texture) {
    if constexpr (std::is_pointer_v<Id>) {
        return reinterpret_cast<Id>(static_cast<std::uintptr_t>(texture));
    } else {
        return static_cast<Id>(texture);
    }
}

}  // namespace

Gui::Gui(const Window& window) : window_(window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    // Without its callbacks: it is told of events when their turn comes.
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), false);
    glfwSetCursorEnterCallback(window.handle(), ImGui_ImplGlfw_CursorEnterCallback);
    ImGui_ImplOpenGL3_Init("#version 450");
    set_scale(window.content_scale());
}

Gui::~Gui() {
    glfwSetCursorEnterCallback(window_.handle(), nullptr);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::set_scale(float scale) {
    scale_ = scale;
    ImGui::GetStyle() = ImGuiStyle();
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale);
    load_font(std::round(text_size * scale));
    ImGui_ImplOpenGL3_DestroyDeviceObjects();  // the next frame makes them, with the new font
}

void Gui::begin_frame() {
    if (const float scale = window_.content_scale(); scale != scale_) set_scale(scale);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    place_pointer();
    ImGui::NewFrame();
}

/// Older versions of Dear ImGui look where the pointer is now, and not where it was at the last event.
void Gui::place_pointer() const {
#if IMGUI_VERSION_NUM < 18700
    ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMousePosValid(&io.MousePos)) io.MousePos = {pointer_.x, pointer_.y};
    for (std::size_t button = 0; button < std::size(io.MouseDown); ++button) {
        io.MouseDown[button] = down_.at(button);
    }
#endif
}

void Gui::tell(const InputEvent& event) {
    using Kind = InputEvent::Kind;
    GLFWwindow* const window = window_.handle();
    pace_.tell(event);
    pointer_ = event.position;
    switch (event.kind) {
        case Kind::press:
        case Kind::release: {
            const bool down = event.kind == Kind::press;
            down_.at(static_cast<std::size_t>(event.code)) = down;
            return ImGui_ImplGlfw_MouseButtonCallback(window, event.code, down ? GLFW_PRESS : GLFW_RELEASE,
                                                      event.modifiers);
        }
        case Kind::move:
#if IMGUI_VERSION_NUM >= 18700
            ImGui_ImplGlfw_CursorPosCallback(window, event.position.x, event.position.y);
#endif
            return;
        case Kind::scroll:
            return ImGui_ImplGlfw_ScrollCallback(window, 0.0, event.scrolled);
        case Kind::key:
            return ImGui_ImplGlfw_KeyCallback(window, event.code, event.scancode,
                                              event.repeated ? GLFW_REPEAT : GLFW_PRESS, event.modifiers);
        case Kind::key_release:
            return ImGui_ImplGlfw_KeyCallback(window, event.code, event.scancode, GLFW_RELEASE,
                                              event.modifiers);
        case Kind::character:
            return ImGui_ImplGlfw_CharCallback(window, static_cast<unsigned>(event.code));
        case Kind::focus_lost:
        case Kind::focus_gained:
            return ImGui_ImplGlfw_WindowFocusCallback(
                window, event.kind == Kind::focus_gained ? GLFW_TRUE : GLFW_FALSE);
    }
}

void Gui::end_frame() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    pace_.draw();
}

bool Gui::wants(InputEvent::Kind kind) {
    const ImGuiIO& io = ImGui::GetIO();
    switch (kind) {
        case InputEvent::Kind::press:
        case InputEvent::Kind::scroll:
            return io.WantCaptureMouse;
        case InputEvent::Kind::key:
        case InputEvent::Kind::character:
            return io.WantCaptureKeyboard;
        case InputEvent::Kind::move:
        case InputEvent::Kind::release:
        case InputEvent::Kind::key_release:
        case InputEvent::Kind::focus_lost:
        case InputEvent::Kind::focus_gained:
            break;
    }
    return false;
}

ImTextureID image_of(std::uint32_t texture) {
    return texture_id<ImTextureID>(texture);
}

void draw_picture(std::uint32_t texture, const Rectangle& at, float from, float to) {
    const float left = at.corner.x + from * at.size.x;
    const float right = at.corner.x + to * at.size.x;
    // The bottom row of a GL texture is its first.
    ImGui::GetBackgroundDrawList()->AddImage(image_of(texture), {left, at.corner.y},
                                             {right, at.corner.y + at.size.y}, {from, 1.0F}, {to, 0.0F});
}

}  // namespace candela::sandbox
