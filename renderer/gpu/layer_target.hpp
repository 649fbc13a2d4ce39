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
    /// The same to all layers: a geometry shader chooses one.
    void set_layers(ObjectId texture, std::uint32_t side);
    /// Clears them to 0: infinitely far. Raster states that write no depth prevent it.
    void clear() const;

 private:
    void begin(std::uint32_t side);

    Gpu& gpu_;
};

}  // namespace candela
