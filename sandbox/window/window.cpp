#include "sandbox/window/window.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include <candela/headless_context.hpp>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string_view action) {
    const char* words = nullptr;
    const int code = glfwGetError(&words);
    throw ContextError(fmt::format("GLFW {}: {}", action, code == GLFW_NO_ERROR ? "no reason given" : words));
}

void hint_context() {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    // The renderer writes the finished picture: the window needs no depth buffer and no alpha channel.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_ALPHA_BITS, 0);
}

}  // namespace

SharedContext::SharedContext(GLFWwindow* window) {
    hint_context();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    handle_ = glfwCreateWindow(1, 1, "", nullptr, window);
    glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
    if (handle_ == nullptr) fail("shares no context");
}

SharedContext::~SharedContext() {
    glfwDestroyWindow(handle_);
}

void SharedContext::make_current() {
    glfwMakeContextCurrent(handle_);
}

void SharedContext::release() {
    glfwMakeContextCurrent(nullptr);
}

gl::GetProc SharedContext::functions() const {
    return Window::functions();
}

Window::Library::Library() {
    if (glfwInit() != GLFW_TRUE) fail("does not start");
}

Window::Library::~Library() {
    glfwTerminate();
}

Window::Window(glm::ivec2 size, const std::string& title) {
    hint_context();
    handle_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (handle_ == nullptr) fail("opens no window with OpenGL 4.5");
    glfwMakeContextCurrent(handle_);
    glfwSwapInterval(1);
    glfwGetWindowSize(handle_, &size_.x, &size_.y);
    glfwGetFramebufferSize(handle_, &framebuffer_size_.x, &framebuffer_size_.y);
    listen();
}

Window::~Window() {
    glfwDestroyWindow(handle_);
}

Window& Window::of(GLFWwindow* handle) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(handle));
}

void Window::record(InputEvent event) {
    event.position = pointer_;
    event.time = std::chrono::steady_clock::now();
    events_.push_back(event);
}

void Window::listen() {
    using Kind = InputEvent::Kind;
    glfwSetWindowUserPointer(handle_, this);
    glfwSetMouseButtonCallback(handle_, [](GLFWwindow* handle, int button, int action, int modifiers) {
        of(handle).record({.kind = action == GLFW_PRESS ? Kind::press : Kind::release,
                           .code = button,
                           .modifiers = modifiers});
    });
    glfwSetCursorPosCallback(handle_, [](GLFWwindow* handle, double x, double y) {
        of(handle).pointer_ = glm::vec2(x, y);
        of(handle).record({.kind = Kind::move});
    });
    glfwSetScrollCallback(handle_, [](GLFWwindow* handle, double /*x*/, double y) {
        of(handle).record({.kind = Kind::scroll, .scrolled = static_cast<float>(y)});
    });
    glfwSetKeyCallback(handle_, [](GLFWwindow* handle, int key, int scancode, int action, int modifiers) {
        of(handle).record({.kind = action == GLFW_RELEASE ? Kind::key_release : Kind::key,
                           .code = key,
                           .scancode = scancode,
                           .modifiers = modifiers,
                           .repeated = action == GLFW_REPEAT});
    });
    glfwSetCharCallback(handle_, [](GLFWwindow* handle, unsigned code_point) {
        of(handle).record({.kind = Kind::character, .code = static_cast<int>(code_point)});
    });
    glfwSetWindowFocusCallback(handle_, [](GLFWwindow* handle, int focused) {
        of(handle).record({.kind = focused == GLFW_FALSE ? Kind::focus_lost : Kind::focus_gained});
    });
    glfwSetDropCallback(handle_, [](GLFWwindow* handle, int count, const char** paths) {
        of(handle).dropped_.insert(of(handle).dropped_.end(), paths, paths + count);
    });
    const auto expose = [](GLFWwindow* handle) { of(handle).exposed_ = true; };
    glfwSetWindowRefreshCallback(handle_, expose);
    glfwSetWindowSizeCallback(handle_, [](GLFWwindow* handle, int width, int height) {
        of(handle).size_ = {width, height};
    });
    glfwSetFramebufferSizeCallback(handle_, [](GLFWwindow* handle, int width, int height) {
        of(handle).framebuffer_size_ = {width, height};
        of(handle).exposed_ = true;
    });
    glfwSetWindowIconifyCallback(handle_, [](GLFWwindow* handle, int) { of(handle).exposed_ = true; });
    glfwSetWindowContentScaleCallback(handle_,
                                      [](GLFWwindow* handle, float, float) { of(handle).exposed_ = true; });
}

gl::GetProc Window::functions() {
    return glfwGetProcAddress;
}

glm::ivec2 Window::framebuffer_size() const {
    return glfwGetWindowAttrib(handle_, GLFW_ICONIFIED) == GLFW_TRUE ? glm::ivec2(0) : framebuffer_size_;
}

float Window::content_scale() const {
    float content = 1.0F;
    glfwGetWindowContentScale(handle_, &content, nullptr);
    if (framebuffer_size_.x < 1) return 1.0F;
    return std::max(content * static_cast<float>(size_.x) / static_cast<float>(framebuffer_size_.x), 1.0F);
}

bool Window::should_close() const {
    return glfwWindowShouldClose(handle_) == GLFW_TRUE;
}

void Window::close() {
    glfwSetWindowShouldClose(handle_, GLFW_TRUE);
}

void Window::hide() {
    glfwHideWindow(handle_);
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(handle_, title.c_str());
}

void Window::toggle_full_screen() {
    if (glfwGetWindowMonitor(handle_) != nullptr) {
        glfwSetWindowMonitor(handle_, nullptr, windowed_.x, windowed_.y, windowed_.z, windowed_.w,
                             GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(handle_, &windowed_.x, &windowed_.y);
    glfwGetWindowSize(handle_, &windowed_.z, &windowed_.w);
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    glfwSetWindowMonitor(handle_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::vector<fs::path> Window::take_dropped_files() {
    return std::exchange(dropped_, {});
}

bool Window::take_exposed() {
    return std::exchange(exposed_, false);
}

void Window::wake() {
    glfwPostEmptyEvent();
}

std::vector<InputEvent> Window::take_events(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
    return std::exchange(events_, {});
}

void Window::swap() {
    glfwSwapBuffers(handle_);
}

}  // namespace candela::sandbox
