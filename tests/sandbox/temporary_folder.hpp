#pragma once

#include <cstddef>
#include <filesystem>
#include <iterator>

#include "tests/new_folder.hpp"

namespace candela::sandbox {

/// An empty folder that is removed with the object.
class TemporaryFolder {
 public:
    TemporaryFolder() = default;
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }

    [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }
    [[nodiscard]] std::ptrdiff_t file_count() const {
        return std::distance(std::filesystem::directory_iterator(path_),
                             std::filesystem::directory_iterator());
    }

 private:
    std::filesystem::path path_ = test::new_folder();
};

}  // namespace candela::sandbox
