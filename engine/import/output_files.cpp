#include "engine/import/output_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>

namespace candela {

namespace {

namespace fs = std::filesystem;

std::error_code last_error() {
    return {errno, std::generic_category()};
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
        paths_.push_back(target);
        return paths_.back() += fmt::format(".{}.part", ::getpid());
    }
    [[nodiscard]] const fs::path& operator[](std::size_t i) const { return paths_[i]; }

 private:
    std::vector<fs::path> paths_;
};

void check(const std::error_code& error, const fs::path& path) {
    if (error) throw SceneError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

/// An error if a file cannot take the place of what is at the path.
std::error_code error_of_place(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) ? std::make_error_code(std::errc::is_a_directory)
                                           : std::error_code{};
}

}  // namespace

std::error_code write_bytes(const fs::path& path, const char* mode, std::span<const std::byte> bytes) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), mode), &std::fclose);
    if (!file) return last_error();
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) return last_error();
    // Buffered bytes are written on close, so only fclose reports that the disk is full.
    return std::fclose(file.release()) == 0 ? std::error_code{} : last_error();
}

void write_files(std::span<const OutputFile> files) {
    FreshFiles fresh;
    for (const OutputFile& file : files) {
        check(error_of_place(file.path), file.path);
        check(write_bytes(fresh.add(file.path), "wb", file.bytes), file.path);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::error_code error;
        fs::rename(fresh[i], files[i].path, error);
        check(error, files[i].path);
    }
}

}  // namespace candela
