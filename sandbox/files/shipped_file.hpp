#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace candela::sandbox {

/// A file of those that programs read when they run. They are in the folder `shipped` beside the program or
/// beside its folder: links in a build folder, the files themselves in a kit, which can be anywhere: no path
/// is compiled in. Without /proc the folder is in the current one.
/// @param folder  "scenes", "animations" or "shaders"; empty for files that are in none
/// @param name    of the file; empty for the folder
[[nodiscard]] inline std::filesystem::path shipped_file(const std::string& folder, const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    const fs::path beside = program.parent_path() / "shipped";
    const fs::path around = program.parent_path().parent_path() / "shipped";
    const fs::path file = (fs::exists(beside, ignored) ? beside : around) / folder / name;
    std::error_code unreadable;
    fs::path resolved = fs::weakly_canonical(file, unreadable);  // users see the file that a link leads to
    return unreadable ? file : resolved;
}

}  // namespace candela::sandbox
