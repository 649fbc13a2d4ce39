#pragma once

#include <memory>
#include <vector>

#include <candela/scene/components.hpp>

namespace candela {

/// Vertices in place of those of the entity's mesh, for example of cloth, or of a figure with a skeleton. The
/// indices and materials stay those of the mesh. To deform the mesh further, set the component again, with
/// other vertices; the mesh itself should stay the same, because surfels stay on its triangles then.
struct DeformedMesh {
    /// A list per primitive of the mesh, with as many vertices as the primitive has.
    using Vertices = std::vector<std::vector<Vertex>>;
    std::shared_ptr<const Vertices> vertices;  ///< never null; must not be changed
    bool operator==(const DeformedMesh&) const = default;
};

}  // namespace candela
