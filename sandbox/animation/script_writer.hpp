#pragma once

#include <filesystem>
#include <string>

#include "sandbox/animation/animation.hpp"

namespace candela::sandbox {

/// The script as JSON (see animation_script.hpp) that read_script reads back with every bit of its numbers,
/// except Script::path. Throws std::runtime_error if a number is not finite or a name is not UTF-8, which
/// JSON cannot hold.
[[nodiscard]] std::string write_script(const Script& script);

/// Writes the script to a file, for this scene: by its name if it is shipped, else relative to the script.
/// Throws std::runtime_error that names the file and the error; the file is then as it was.
void save_script(Script script, const std::filesystem::path& scene, const std::filesystem::path& file);

}  // namespace candela::sandbox
