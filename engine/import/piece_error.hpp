#pragma once

#include <candela/scene/scene_error.hpp>

namespace candela::gltf {

/// A fault of one piece, such as an image, without which the rest of the file may still be of use. Who reads
/// the piece decides that; elsewhere this is a SceneError like any other.
class PieceError : public SceneError {
 public:
    using SceneError::SceneError;
};

}  // namespace candela::gltf
