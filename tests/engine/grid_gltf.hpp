#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/engine/gltf_builder.hpp"

namespace candela::test {

/// A bumpy square of triangles that share vertices, for files with compressed geometry.
struct Grid {
    static constexpr std::size_t side = 9;  ///< vertices of an edge
    std::vector<float> positions;           ///< within [-1, 1]
    std::vector<float> normals;             ///< of unit length
    std::vector<float> coordinates;
    std::vector<std::uint16_t> indices;

    Grid() {
        for (std::size_t i = 0; i < side * side; ++i) {
            const float u = static_cast<float>(i % side) / static_cast<float>(side - 1);
            const float v = static_cast<float>(i / side) / static_cast<float>(side - 1);
            const glm::vec3 normal = glm::normalize(glm::vec3(u - 0.5F, v - 0.3F, 1.0F));
            positions.insert(positions.end(),
                             {2.0F * u - 1.0F, 2.0F * v - 1.0F, 0.3F * std::sin(9.0F * u * v)});
            normals.insert(normals.end(), {normal.x, normal.y, normal.z});
            coordinates.insert(coordinates.end(), {u, v});
        }
        for (std::size_t y = 0; y + 1 < side; ++y) {
            for (std::size_t x = 0; x + 1 < side; ++x) {
                const std::size_t a = y * side + x;
                for (const std::size_t corner : {a, a + 1, a + side, a + side, a + 1, a + side + 1}) {
                    indices.push_back(static_cast<std::uint16_t>(corner));
                }
            }
        }
    }

    /// The file without compression: accessor and buffer view 0 are the positions, 1 the normals, 2 the
    /// texture coordinates, 3 the indices.
    [[nodiscard]] GltfBuilder file() const {
        GltfBuilder file;
        file.add_primitive(positions);
        Json& attributes = file.primitive()["attributes"];
        attributes["NORMAL"] = file.add_vectors(normals);
        attributes["TEXCOORD_0"] = file.add_accessor(coordinates, 5126, "VEC2", 2);
        file.primitive()["indices"] = file.add_indices(indices);
        return file;
    }
};

/// A corner's position, normal and texture coordinates.
using CornerValues = std::array<float, 8>;

/// The triangles of the first primitive in an order of their own, each beginning with its lowest corner: so
/// that neither the order of triangles nor which corner is the first makes a difference.
inline std::vector<std::array<CornerValues, 3>> sorted_triangles(const Imported& imported) {
    std::vector<std::array<CornerValues, 3>> triangles;
    const std::vector<Vertex> corners = imported.corners();
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::array<CornerValues, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vertex& corner = corners[i + k];
            triangle[k] = {corner.position.x, corner.position.y, corner.position.z, corner.normal.x,
                           corner.normal.y,   corner.normal.z,   corner.uv.x,       corner.uv.y};
        }
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        triangles.push_back(triangle);
    }
    std::ranges::sort(triangles);
    return triangles;
}

}  // namespace candela::test
