#include "renderer/passes/sky/sky_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace candela {
namespace {

constexpr glm::uvec2 most_cells{1024, 512};
constexpr std::uint32_t least_columns = 256;

/// Integrals over the azimuths of a column, which the directions x = sin φ sin θ and z = -cos φ sin θ need.
struct Column {
    double width, x, z;
};

/// Integrals over the polar angles of a row: of sin θ, cos θ sin θ and sin² θ.
struct Row {
    double one, y, across;
};

std::vector<Column> columns_of(std::uint32_t count) {
    std::vector<Column> columns;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double from = 2.0 * std::numbers::pi * (static_cast<double>(i) / count - 0.5);
        const double to = 2.0 * std::numbers::pi * (static_cast<double>(i + 1) / count - 0.5);
        columns.push_back({to - from, std::cos(from) - std::cos(to), std::sin(from) - std::sin(to)});
    }
    return columns;
}

Row row_of(std::uint32_t row, std::uint32_t count) {
    const double from = std::numbers::pi * row / count;
    const double to = std::numbers::pi * (row + 1) / count;
    return {std::cos(from) - std::cos(to),
            0.5 * (std::sin(to) * std::sin(to) - std::sin(from) * std::sin(from)),
            0.5 * (to - from) - 0.25 * (std::sin(2.0 * to) - std::sin(2.0 * from))};
}

/// Radiance of the picture at a point from (0, 0) to (size), interpolated bilinearly; left and right edge
/// meet.
glm::vec3 radiance_at(const SkyPicture& picture, glm::vec2 at) {
    const glm::vec2 first = glm::floor(at - 0.5F);
    const glm::vec2 share = at - 0.5F - first;
    const auto texel = [&](float x, float y) {
        const auto column = static_cast<std::uint32_t>(x + static_cast<float>(picture.width)) % picture.width;
        const auto row =
            static_cast<std::uint32_t>(std::clamp(y, 0.0F, static_cast<float>(picture.height - 1)));
        return picture.texels[std::size_t{row} * picture.width + column];
    };
    return glm::mix(glm::mix(texel(first.x, first.y), texel(first.x + 1.0F, first.y), share.x),
                    glm::mix(texel(first.x, first.y + 1.0F), texel(first.x + 1.0F, first.y + 1.0F), share.x),
                    share.y);
}

/// The rotation from the picture's directions to those of the grid.
glm::quat tilt() {
    return glm::angleAxis(1.0F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F)));
}

/// The same light, by cells of the tilted grid.
SkyGrid tilted(const SkyGrid& grid) {
    SkyGrid result{grid.size, std::vector<SkyGrid::Cell>(grid.cells.size())};
    const glm::vec2 most(grid.size - 1U);
    for (const SkyGrid::Cell& cell : grid.cells) {
        if (cell.moment == glm::vec3(0.0F)) continue;
        const glm::vec2 at = sky_position(tilt() * glm::normalize(cell.moment)) * glm::vec2(grid.size);
        const glm::uvec2 index(glm::clamp(at, glm::vec2(0.0F), most));
        SkyGrid::Cell& target = result.cells[std::size_t{index.y} * grid.size.x + index.x];
        target.light += cell.light;
        target.moment += cell.moment;
    }
    return result;
}

}  // namespace

/// Cells are blocks of texels, or parts of texels where the picture is small: a bright texel must be
/// divisible.
SkyGrid picture_grid(const SkyPicture* given) {
    static const SkyPicture white{2, 1, {glm::vec3(1.0F), glm::vec3(1.0F)}};
    const SkyPicture& picture = given == nullptr ? white : *given;
    const glm::uvec2 texels(picture.width, picture.height);
    const std::uint32_t parts = std::max(least_columns / picture.width, 1U);
    const glm::uvec2 samples = texels * parts;
    const glm::uvec2 block = (samples + most_cells - 1U) / most_cells;
    SkyGrid grid{(samples + block - 1U) / block, {}};
    grid.cells.resize(std::size_t{grid.size.x} * grid.size.y);
    const std::vector<Column> columns = columns_of(samples.x);
    for (std::uint32_t y = 0; y < samples.y; ++y) {
        const Row row = row_of(y, samples.y);
        for (std::uint32_t x = 0; x < samples.x; ++x) {
            const Column& column = columns[x];
            const glm::vec2 at = (glm::vec2(x, y) + 0.5F) / static_cast<float>(parts);
            const glm::vec3 radiance =
                parts == 1 ? picture.texels[std::size_t{y} * picture.width + x] : radiance_at(picture, at);
            SkyGrid::Cell& cell = grid.cells[std::size_t{y / block.y} * grid.size.x + x / block.x];
            cell.light += radiance * static_cast<float>(column.width * row.one);
            cell.moment +=
                sum_of_channels(radiance) *
                glm::vec3(glm::dvec3(column.x * row.across, column.width * row.y, column.z * row.across));
        }
    }
    return grid;
}

SkyGrid sky_grid(const SkyPicture* picture) {
    return tilted(picture_grid(picture));
}

glm::vec3 grid_direction(glm::vec2 at) {
    return glm::inverse(tilt()) * sky_direction(at);
}

}  // namespace candela
