#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// A message of the driver, and how often it occurred with the same id and text.
struct DebugMessage {
    GLenum type = 0;      ///< GL_DEBUG_TYPE_...
    GLenum severity = 0;  ///< GL_DEBUG_SEVERITY_...
    GLuint id = 0;
    std::string text;
    std::uint64_t times = 1;

    /// Whether it is an error, undefined behaviour or of high severity: never expected in a correct program.
    [[nodiscard]] bool is_error() const;
};

/// Called with a message that is_error. It must not call GL.
using DebugReceiver = std::function<void(const DebugMessage&)>;

/// Collects the debug output of the current context, synchronously, as long as it lives. A callback that was
/// installed before still receives every message. The destructor reinstalls it, together with the enable
/// states of debug output. Several logs may listen to one context, and may be destroyed in any order.
class DebugLog {
 public:
    /// `gl` must outlive the log. The context must be current here and in the destructor. `receiver`, if any,
    /// is told of each error at once, the first time since `take`.
    DebugLog(const Functions& gl, DebugReceiver receiver);
    ~DebugLog();
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;

    /// Messages since the last call, oldest first. Notifications and the messages of the shader compiler are
    /// left out; the latter are part of ProgramError.
    [[nodiscard]] std::vector<DebugMessage> take();

 private:
    struct Listener {
        GLDEBUGPROC function = nullptr;
        void* user = nullptr;
        bool enabled = false;
        bool synchronous = false;
    };

    static void APIENTRY receive(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* text, const void* user);
    [[nodiscard]] static DebugLog* as_log(const Listener& listener);
    [[nodiscard]] Listener current() const;
    void install(const Listener& listener) const;
    void record(GLenum type, GLuint id, GLenum severity, std::string text);

    const Functions* gl_;
    DebugLog* self_ = this;  ///< user pointer given to the driver, which returns it as const
    Listener previous_;
    DebugReceiver receiver_;
    std::vector<DebugMessage> messages_;
};

}  // namespace candela::gl
