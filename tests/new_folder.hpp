#pragma once

#include <filesystem>
#include <random>

#include <fmt/format.h>

namespace candela::test {

/// Creates an empty folder, with a name that no other has, in the system's folder for temporary files.
inline std::filesystem::path new_folder() {
    std::random_device random;
    for (;;) {
        const std::filesystem::path path =
            std::filesystem::temp_directory_path() / fmt::format("candela-{:08x}", random());
        if (std::filesystem::create_directory(path)) return path;  // false: there is one already
    }
}

}  // namespace candela::test
