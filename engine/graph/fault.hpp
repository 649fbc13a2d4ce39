#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace candela {

enum class FaultCode : std::uint8_t {
    foreign_handle,       ///< a handle of another graph, or of none
    stale_handle,         ///< a read of a version that another pass has overwritten
    two_writers,          ///< two passes write one version, and `after` does not order them
    unwritten_read,       ///< a read of what nobody writes
    wrong_usage,          ///< a usage that the resource or the direction does not allow
    feedback,             ///< a pass reads the version that it overwrites
    attachment_mismatch,  ///< attachments of different sizes, or two depth targets
    duplicate_pass,       ///< two passes of one name
    duplicate_resource,   ///< two kept or imported resources of one kind and name
    unknown_pass,         ///< `after` names no pass
    nested_pass,          ///< a pass declared while another was being declared
    cycle                 ///< passes that wait for each other
};

/// Why a graph does not compile: one line that names the passes and the resources concerned.
struct Fault {
    FaultCode code;
    std::string message;
    bool operator==(const Fault&) const = default;
};

/// Misuse of a compiled graph while it runs, or taking a graph that did not compile.
class GraphError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

}  // namespace candela
