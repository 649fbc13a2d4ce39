#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/scene/components.hpp>

namespace candela {

/// The light of a sky, summed over the cells of a grid of directions, in rows like those of a picture.
struct SkyGrid {
    struct Cell {
        glm::vec3 light{0.0F};   ///< radiance, integrated over the cell's solid angle
        glm::vec3 moment{0.0F};  ///< the sum of its channels times direction, integrated likewise
    };
    glm::uvec2 size{0};
    std::vector<Cell> cells;

    [[nodiscard]] const Cell& at(std::uint32_t x, std::uint32_t y) const {
        return cells[std::size_t{y} * size.x + x];
    }
};

template <class T>
[[nodiscard]] T sum_of_channels(const glm::vec<3, T>& rgb) {
    return rgb.r + rgb.g + rgb.b;
}

/// The light of a picture, by cells of at most 1,024 × 512, in its rows and columns. Null: a radiance of 1
/// everywhere.
[[nodiscard]] SkyGrid picture_grid(const SkyPicture* picture);

/// The same light by cells of another grid. The grid is tilted against the picture, around no
/// axis of the world: the edges of patches would otherwise be parallel to those of most rooms and be seen as
/// bands. Moments have the picture's directions.
[[nodiscard]] SkyGrid sky_grid(const SkyPicture* picture);

/// The direction of the picture at a point of the grid, from (0, 0) to (1, 1); unit.
[[nodiscard]] glm::vec3 grid_direction(glm::vec2 at);

}  // namespace candela
