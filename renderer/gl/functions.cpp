#include "renderer/gl/functions.hpp"

#include <fmt/format.h>

#include <candela/gl_error.hpp>

namespace candela::gl {
namespace {

template <class Function>
void load(const GetProc& get_proc, const char* name, Function& function) {
    function = reinterpret_cast<Function>(get_proc(name));
    if (!function) throw GlError(fmt::format("the OpenGL driver offers no function {}", name));
}

}  // namespace

GLuint get_unsigned(const Functions& gl, GLenum what) {
    GLint value = 0;
    gl.GetIntegerv(what, &value);
    return static_cast<GLuint>(value);
}

void set_enabled(const Functions& gl, GLenum capability, bool enabled) {
    if (enabled) {
        gl.Enable(capability);
    } else {
        gl.Disable(capability);
    }
}

Functions load_functions(const GetProc& get_proc) {
    Functions functions;
#define CANDELA_GL_LOAD(name, capitals) load(get_proc, "gl" #name, functions.name);
    CANDELA_GL_FUNCTIONS(CANDELA_GL_LOAD)
#undef CANDELA_GL_LOAD
    return functions;
}

}  // namespace candela::gl
