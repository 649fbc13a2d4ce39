#pragma once

#include <functional>

namespace candela::gl {

/// Looks up a GL function by name ("glDrawArrays"); returns null if there is none. Called with the context
/// current. glfwGetProcAddress, eglGetProcAddress and OSMesaGetProcAddress have this form.
using GetProc = std::function<void (*(const char* name))()>;

}  // namespace candela::gl
