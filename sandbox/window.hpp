#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "renderer/gl/functions.hpp"

struct GLFWwindow;

namespace candela::sandbox {

/// An input event. Events are queued in order, so that a slow frame loses none of them. Positions are in
/// window coordinates: the origin is the upper left corner, and the unit is that of the desktop, which may be
/// more than one pixel.
struct InputEvent {
    enum class Kind : std::uint8_t { press, release, move, scroll, key };
    Kind kind = Kind::move;
    int code = 0;              ///< GLFW_MOUSE_BUTTON_... or GLFW_KEY_...
    int modifiers = 0;         ///< GLFW_MOD_...
    glm::vec2 position{0.0F};  ///< of the pointer
    float scrolled = 0.0F;     ///< notches; positive away from the user
};

/// A window with a current OpenGL 4.5 core context.
class Window {
 public:
    /// `size` is in window coordinates. Throws ContextError with the message of GLFW if there is no display
    /// or no driver.
    Window(glm::ivec2 size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] static gl::GetProc get_proc();
    [[nodiscard]] GLFWwindow* handle() const { return handle_; }

    [[nodiscard]] glm::ivec2 size() const;              ///< window coordinates; 0x0 while minimised
    [[nodiscard]] glm::ivec2 framebuffer_size() const;  ///< pixels
    [[nodiscard]] bool should_close() const;
    void close();

    /// Input since the last call. Waits up to `seconds` if there is none.
    [[nodiscard]] std::vector<InputEvent> take_events(double seconds);
    /// Presents the frame.
    void swap();

 private:
    /// Initialises GLFW and terminates it with the window.
    struct Library {
        Library();
        ~Library();
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    };

    void listen();
    [[nodiscard]] static Window& of(GLFWwindow* handle);
    void record(InputEvent event);

    Library library_;
    GLFWwindow* handle_ = nullptr;
    /// At the last event. The current position does not tell where a button was pressed.
    glm::vec2 pointer_{0.0F};
    std::vector<InputEvent> events_;
};

}  // namespace candela::sandbox
