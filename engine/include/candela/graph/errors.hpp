#pragma once

#include <cstdint>
#include <string>

#include <candela/api.hpp>
#include <candela/error.hpp>

namespace candela {

enum class ErrorCode : std::uint8_t {
    foreign_handle,       ///< a null handle, or one of another graph or of another kind
    stale_handle,         ///< a read of a version that another pass has already overwritten
    two_writers,          ///< two passes write one version
    unwritten_read,       ///< a read before any write
    wrong_usage,          ///< an access that the resource's kind, format or lifetime does not allow
    feedback,             ///< a pass declares a read of the version that it overwrites
    attachment_mismatch,  ///< attachments of different sizes, or two depth targets
    shared_point,         ///< a pass has two resources at one binding point
    impossible_texture,   ///< a texture with a description that none can have
    duplicate_pass,       ///< two passes with the same name
    duplicate_resource,   ///< two persistent or imported resources with the same kind and name
    unknown_pass,         ///< a pass is to run after one that was not declared before it
    nested_pass           ///< a pass added while another pass is being declared
};

/// One reason why a graph does not compile. `message` is one line that names the passes and resources.
struct CompileError {
    ErrorCode code;
    std::string message;
    bool operator==(const CompileError&) const = default;
};

/// Thrown for misuse of a GraphRuntime or an Execution, for a failed verification, and by CompileResult::take
/// if the graph did not compile.
class CANDELA_API GraphError : public Error {
 public:
    using Error::Error;
};

}  // namespace candela
