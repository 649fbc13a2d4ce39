#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "renderer/passes/scene/scene_layout.hpp"

namespace candela {

/// The ids of the triangles that rays may hit: see gpu::TraceTriangle. They increase from object to object in
/// the order of the objects' keys, so that of two triangles at the same distance the same one is hit,
/// whatever has come and gone before. There is room for other entities, so that few ids change.
class TriangleIds {
 public:
    /// Gives ids to the triangles of an object. Returns the first one; nullopt if there was no room between
    /// its neighbours, and all objects have other ids now.
    /// Objects that come at a time should be inserted in the order of their keys.
    [[nodiscard]] std::optional<std::uint32_t> insert(PrimitiveKey key, std::uint32_t count);
    void remove(PrimitiveKey key) { ranges_.erase(key); }
    /// The id of the first triangle of an object.
    [[nodiscard]] std::uint32_t first(PrimitiveKey key) const { return ranges_.at(key).first; }

 private:
    struct Range {
        std::uint32_t first;
        std::uint32_t count;
    };
    void distribute();

    std::map<PrimitiveKey, Range> ranges_;
    std::uint64_t room_ = 1024;  // ids for an entity, besides those that it needs
};

}  // namespace candela
