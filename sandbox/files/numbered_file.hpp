#pragma once

#include <filesystem>
#include <string_view>

namespace candela::sandbox {

/// The name for the next file of a kind in a folder: "candela-001.png", or one above the highest number that
/// is there. `ending` is what follows the number. Without a folder, the current one.
[[nodiscard]] std::filesystem::path next_numbered_file(std::string_view ending,
                                                       const std::filesystem::path& folder = ".");

}  // namespace candela::sandbox
