#include "engine/import/output_files.hpp"

#include <cerrno>
#include <fstream>
#include <random>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/file_names.hpp"

namespace candela {

namespace {

namespace fs = std::filesystem;

/// Why the last function failed. Streams need not say why.
std::error_code last_error() {
    return errno != 0 ? std::error_code(errno, std::generic_category())
                      : std::make_error_code(std::errc::io_error);
}

/// Removes the new files that have not been renamed.
class FreshFiles {
 public:
    FreshFiles() = default;
    FreshFiles(const FreshFiles&) = delete;
    FreshFiles& operator=(const FreshFiles&) = delete;
    ~FreshFiles() {
        std::error_code ignored;
        for (const fs::path& path : paths_) {
            fs::remove(path, ignored);
        }
    }

    const fs::path& add(const fs::path& target) {
        // Not made from the target's name, which may be as long as names can be.
        paths_.push_back(target.parent_path() /
                         fmt::format(".candela-{:08x}-{}.part", number_, paths_.size()));
        return paths_.back();
    }
    [[nodiscard]] const fs::path& operator[](std::size_t i) const { return paths_[i]; }

 private:
    std::vector<fs::path> paths_;
    unsigned int number_ = std::random_device{}();  // others may save the same files at the same time
};

void check(const std::error_code& error, const fs::path& path) {
    if (error) {
        throw SceneError(fmt::format("{}: cannot be written: {}", gltf::utf8_of(path), error.message()));
    }
}

/// An error if a file cannot take the place of what is at the path.
std::error_code error_of_place(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) ? std::make_error_code(std::errc::is_a_directory)
                                           : std::error_code{};
}

}  // namespace

std::error_code write_bytes(const fs::path& path, std::span<const std::byte> bytes) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();  // writes buffered bytes: only now a full disk is sure to be noticed
    return file ? std::error_code{} : last_error();
}

void write_files(std::span<const OutputFile> files) {
    FreshFiles fresh;
    for (const OutputFile& file : files) {
        check(error_of_place(file.path), file.path);
        check(write_bytes(fresh.add(file.path), file.bytes), file.path);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::error_code error;
        fs::rename(fresh[i], files[i].path, error);
        check(error, files[i].path);
    }
}

}  // namespace candela
