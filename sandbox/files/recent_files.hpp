#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace candela::sandbox {

// The scenes that were opened last, in a text file with one absolute path per line. None of these functions
// throws because of the file: the app works without it.

/// How many scenes are remembered.
inline constexpr std::size_t most_recent_files = 10;

/// $XDG_STATE_HOME/candela/recent, or ~/.local/state/candela/recent. Empty if neither folder is known; then
/// nothing is remembered.
[[nodiscard]] std::filesystem::path recent_files_list();

/// The newest first, without those that do not exist now. Lines of `list` that are no absolute paths are
/// ignored.
[[nodiscard]] std::vector<std::filesystem::path> recent_files(const std::filesystem::path& list);

/// Puts a scene at the top of the list, whose folder is created if needed. Nothing happens if the list cannot
/// be written.
void add_recent_file(const std::filesystem::path& list, const std::filesystem::path& scene);

}  // namespace candela::sandbox
