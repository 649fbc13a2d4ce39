#pragma once

#include <cstdint>

#include <candela/graph/backend.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// Draws depth into layers of textures that the running pass writes with Usage::layer_target. Ends with its
/// scope. Only one at a time.
class LayerTarget {
 public:
    explicit LayerTarget(Gpu& gpu) : gpu_(gpu) {}
    LayerTarget(const LayerTarget&) = delete;
    LayerTarget& operator=(const LayerTarget&) = delete;
    ~LayerTarget();

    /// Draws to one layer of a square texture, `side` texels across.
    void set_layer(ObjectId texture, std::uint32_t layer, std::uint32_t side);
    /// Clears it to 0: infinitely far. Raster states that write no depth prevent it.
    void clear() const;

 private:
    Gpu& gpu_;
};

}  // namespace candela
