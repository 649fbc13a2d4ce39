#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <candela/configuration.hpp>
#include "sandbox/window/document.hpp"

namespace candela::sandbox {

// Commands that write a file with the next free number into the working folder. All throw std::runtime_error
// that names the file and the error.

struct SavedScene {
    std::filesystem::path path;
    std::vector<std::string> warnings;  ///< what glTF cannot hold, one per line
};
[[nodiscard]] SavedScene save_document(const Document& document);

/// Returns the file.
[[nodiscard]] std::filesystem::path save_configuration(const Configuration& configuration);

/// Begins to record the motion of the selection, or ends that and saves it as an animation script, if
/// anything has moved. Returns what to tell the user. Throws std::runtime_error if nothing is selected.
[[nodiscard]] std::string toggle_recording(Document& document);

/// What to tell the user of a written file.
[[nodiscard]] std::string written(const std::filesystem::path& path);

}  // namespace candela::sandbox
