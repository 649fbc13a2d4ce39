#pragma once

#include <memory>
#include <string_view>

#include <candela/scene/components.hpp>

namespace candela::gltf {

/// What takes the place of an image that cannot be read.
enum class StandIn {
    checker,  ///< a pattern that shows plainly that something is missing, for colours
    black,    ///< for emission: a lamp that is not in the file would light the scene
    nothing   ///< for textures without which the factor holds, such as normals
};

/// Images that take the place of those that cannot be read, each made once.
class StandIns {
 public:
    /// Null for nothing.
    [[nodiscard]] std::shared_ptr<const Image> image(StandIn kind);

 private:
    std::shared_ptr<const Image> checker_;
    std::shared_ptr<const Image> black_;
};

/// What a warning says becomes of the image.
[[nodiscard]] std::string_view consequence(StandIn kind);

}  // namespace candela::gltf
