#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// What the driver said, and how often it said exactly that.
struct DebugMessage {
    GLenum type = 0;      ///< GL_DEBUG_TYPE_...
    GLenum severity = 0;  ///< GL_DEBUG_SEVERITY_...
    GLuint id = 0;
    std::string text;
    std::uint64_t times = 1;

    /// An error, undefined behaviour or anything of high severity: never in a correct program.
    [[nodiscard]] bool is_fault() const;
};

/// Listens to the debug output of the current context for as long as it lives, synchronously. A callback that
/// was there before still receives everything, and is put back together with the enables of debug output at
/// the end. Several logs may listen to one context, and may end in any order.
class DebugLog {
 public:
    /// `gl` outlives the log. The context is current here and at destruction.
    explicit DebugLog(const Functions& gl);
    ~DebugLog();
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;

    /// Since the last call, oldest first. Notifications are left out, and so are a shader compiler's words:
    /// they come with ProgramError.
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
    DebugLog* self_ = this;  ///< what the driver is given: it hands back only const pointers
    Listener previous_;
    std::vector<DebugMessage> messages_;
};

}  // namespace candela::gl
