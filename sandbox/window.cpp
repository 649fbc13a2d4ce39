#include "sandbox/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include <candela/headless_context.hpp>

namespace candela::sandbox {

namespace {

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
    glfwSetKeyCallback(handle_, [](GLFWwindow* handle, int key, int /*scancode*/, int action, int modifiers) {
        if (action != GLFW_RELEASE)
            of(handle).record({.kind = Kind::key, .code = key, .modifiers = modifiers});
    });
}

gl::GetProc Window::get_proc() {
    return glfwGetProcAddress;
}

glm::ivec2 Window::size() const {
    glm::ivec2 size(0);
    glfwGetWindowSize(handle_, &size.x, &size.y);
    return size;
}

glm::ivec2 Window::framebuffer_size() const {
    glm::ivec2 size(0);
    glfwGetFramebufferSize(handle_, &size.x, &size.y);
    return glfwGetWindowAttrib(handle_, GLFW_ICONIFIED) == GLFW_TRUE ? glm::ivec2(0) : size;
}

bool Window::should_close() const {
    return glfwWindowShouldClose(handle_) == GLFW_TRUE;
}

void Window::close() {
    glfwSetWindowShouldClose(handle_, GLFW_TRUE);
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
