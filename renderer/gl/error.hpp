#pragma once

#include <stdexcept>

namespace candela::gl {

/// What the driver lacks or refuses; the message names the object and the fault.
struct GlError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A shader that cannot be found, assembled, compiled or linked. Each line of the message starts with
/// "shaders/FILE:LINE: " where the line is known.
struct ProgramError : GlError {
    using GlError::GlError;
};

}  // namespace candela::gl
