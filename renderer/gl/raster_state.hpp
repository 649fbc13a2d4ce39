#pragma once

#include <cstdint>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// Depth is reversed: nearer is greater. Only with a test is depth written.
enum class DepthTest : std::uint8_t { off, nearer, equal, always };

enum class Blending : std::uint8_t {
    off,
    add,   ///< adds to colour and replaces alpha
    cover  ///< adds, after what is there was multiplied by 1 - the second output of the shader
};

enum class Culling : std::uint8_t { off, back, front };

/// How triangles are rasterised. The default is the state at the start of every pass.
struct RasterState {
    DepthTest depth_test = DepthTest::off;
    bool writes_depth = true;
    Blending blending = Blending::off;
    Culling culling = Culling::off;
    bool clockwise_front = false;  ///< winding of front faces
    bool operator==(const RasterState&) const = default;
};

/// The raster state of a context, changed with as few calls as possible.
class RasterStates {
 public:
    /// Sets the default state, whatever the state of the context.
    void reset(const Functions& gl);
    /// Sets a state, provided that no one else has changed it since `reset`.
    void set(const Functions& gl, const RasterState& state);

 private:
    RasterState now_;
};

}  // namespace candela::gl
