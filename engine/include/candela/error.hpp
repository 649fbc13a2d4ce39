#pragma once

#include <stdexcept>

#include <candela/api.hpp>

namespace candela {

/// Base class of all exceptions that the library throws, except std::bad_alloc: ContextError, EntityError,
/// GraphError, ImportCancelled, SceneError, UndeclaredAccess, gl::GlError, gl::MemoryError, gl::ProgramError
/// and tools::ToolError. `what()` names the object and the problem. Exceptions of functions that the host
/// passes in, its component types and graph passes included, propagate as they are.
class CANDELA_API Error : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

}  // namespace candela
