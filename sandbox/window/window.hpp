#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <candela/gl_loader.hpp>
#include "sandbox/window/thread_context.hpp"

struct GLFWwindow;

namespace candela::sandbox {

/// An input event. Events are queued in order, so that a slow frame loses none of them. Positions are in
/// window coordinates: the origin is the upper left corner, and the unit is that of the desktop, which may be
/// more than one pixel.
struct InputEvent {
    /// `press` and `release` are of mouse buttons, `key` and `key_release` of keys; a key that writes is
    /// followed by its `character`. When the window loses the focus, the releases of held keys may be
    /// missing.
    enum class Kind : std::uint8_t {
        press,
        release,
        move,
        scroll,
        key,
        key_release,
        character,
        focus_lost,
        focus_gained
    };
    Kind kind = Kind::move;
    int code = 0;              ///< GLFW_MOUSE_BUTTON_... or GLFW_KEY_..., or the character's code point
    int scancode = 0;          ///< of the key, by the system
    int modifiers = 0;         ///< GLFW_MOD_...
    glm::vec2 position{0.0F};  ///< of the pointer
    float scrolled = 0.0F;     ///< notches; positive away from the user
    bool repeated = false;     ///< the key was already held
    std::chrono::steady_clock::time_point time{};  ///< when it arrived
};

/// A GL context without a window, which shares textures and buffers with that of a window. For another
/// thread; made and destroyed in the thread of the window.
class SharedContext : public ThreadContext {
 public:
    explicit SharedContext(GLFWwindow* window);
    ~SharedContext() override;

    void make_current() override;
    void release() override;
    [[nodiscard]] gl::GetProc functions() const override;

 private:
    GLFWwindow* handle_ = nullptr;
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

    [[nodiscard]] GLFWwindow* handle() const { return handle_; }
    [[nodiscard]] static gl::GetProc functions();
    [[nodiscard]] std::unique_ptr<SharedContext> share() const {
        return std::make_unique<SharedContext>(handle_);
    }

    [[nodiscard]] glm::ivec2 size() const { return size_; }  ///< window coordinates
    [[nodiscard]] glm::ivec2 framebuffer_size() const;       ///< pixels; 0x0 while minimised
    /// Of text and controls on the display, in window coordinates; >= 1. Where a window coordinate is more
    /// than one pixel, 1.
    [[nodiscard]] float content_scale() const;
    [[nodiscard]] bool should_close() const;
    void close();
    void hide();
    void set_title(const std::string& title);
    void toggle_full_screen();

    /// Input since the last call. Waits up to `seconds` if there is none; less if the window has to be drawn
    /// again, or after `wake`.
    [[nodiscard]] std::vector<InputEvent> take_events(double seconds);
    /// Files that were dropped on the window since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_dropped_files();
    /// Whether the window was resized, covered or moved to another display since the last call.
    [[nodiscard]] bool take_exposed();
    /// Ends the wait of take_events; for other threads.
    static void wake();
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
    // Both at the last event: asked for one after the other, they may be those before and after a change.
    glm::ivec2 size_{0};
    glm::ivec2 framebuffer_size_{0};
    /// At the last event. The current position does not tell where a button was pressed.
    glm::vec2 pointer_{0.0F};
    std::vector<InputEvent> events_;
    std::vector<std::filesystem::path> dropped_;
    bool exposed_ = true;
    glm::ivec4 windowed_{0};  ///< position and size before full screen
};

}  // namespace candela::sandbox
