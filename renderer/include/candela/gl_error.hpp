#pragma once

#include <candela/api.hpp>
#include <candela/error.hpp>

namespace candela::gl {

/// Something that the driver lacks or refuses. The message names the object and the error.
struct CANDELA_API GlError : Error {
    using Error::Error;
};

/// The driver has no memory for an object, which the message names.
struct CANDELA_API MemoryError : GlError {
    using GlError::GlError;
};

/// A shader that cannot be found, assembled, compiled or linked. Lines of the message that refer to a known
/// source line start with "shaders/FILE:LINE: ".
struct CANDELA_API ProgramError : GlError {
    using GlError::GlError;
};

}  // namespace candela::gl
