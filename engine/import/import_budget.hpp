#pragma once

#include <cstdint>

#include <candela/scene/gltf.hpp>

namespace candela::gltf {

/// What an import has used so far of its limits. Everything is counted before memory is allocated for it. All
/// functions throw SceneError that names the limit.
class ImportBudget {
 public:
    explicit ImportBudget(const ImportLimits& limits) : limits_(limits) {}

    /// Bytes of a file, before it is read.
    void add_file(std::uint64_t bytes);
    /// Memory in bytes for what is decoded, other than pixels.
    void add_memory(std::uint64_t bytes);
    /// Pixels of a picture, before it is decoded.
    void add_picture(std::uint64_t width, std::uint64_t height);
    void add_triangles(std::uint64_t count);
    void check_nodes(std::uint64_t count) const;
    void check_depth(std::uint64_t depth) const;

    /// Of all files so far.
    [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }

 private:
    ImportLimits limits_;
    std::uint64_t file_bytes_ = 0;
    std::uint64_t memory_ = 0;
    std::uint64_t pixels_ = 0;
    std::uint64_t triangles_ = 0;
};

}  // namespace candela::gltf
