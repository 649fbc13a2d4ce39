#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "renderer/gl/compiling_program.hpp"

namespace candela::gl {

/// Linked programs in the driver's own form, a file for each, in a directory that several processes may
/// share. Files are written under another name first, so that there are only whole ones.
class ProgramCache {
 public:
    /// The directory is made when the first program is stored. `warn` is called once if that is not possible.
    /// The device must outlive the object.
    ProgramCache(const Device& device, std::filesystem::path directory,
                 std::function<void(std::string)> warn);

    /// Loads a program, which has not been linked, if there is a whole file of this source and driver. The
    /// driver may still refuse it: then the program is not linked afterwards.
    [[nodiscard]] bool load(GLuint program, const ProgramSource& source) const;
    /// Stores a linked program; replaces the file if there is one. Does nothing if the driver gives no
    /// programs away, or once a file could not be written.
    void store(GLuint program, const ProgramSource& source);

 private:
    /// A hash of all that a binary depends on.
    using Key = std::array<std::uint64_t, 2>;

    [[nodiscard]] Key key_of(const ProgramSource& source) const;
    [[nodiscard]] std::filesystem::path path_of(const Key& key) const;
    void write(const Key& key, GLenum format, std::span<const char> binary) const;

    const Device* device_;
    std::filesystem::path directory_;
    std::function<void(std::string)> warn_;
    std::vector<GLenum> formats_;  ///< that the driver takes
    bool writes_;
};

}  // namespace candela::gl
