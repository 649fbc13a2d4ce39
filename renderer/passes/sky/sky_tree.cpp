#include "renderer/passes/sky/sky_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <candela/graph/execute.hpp>

namespace candela {
namespace {

constexpr std::uint32_t width = SkyTree::width;

bool is_sun(const SkyGrid::Cell& cell, const std::vector<SkySun>& suns) {
    return std::ranges::any_of(suns, [&](const SkySun& sun) {
        return glm::dot(cell.moment, sun.direction) > sun_cosine * glm::length(cell.moment);
    });
}

/// The moment and the light of the picture, summed over the cells of the lowest level.
std::vector<glm::vec4> lowest_level(const SkyPicture* picture, const std::vector<SkySun>& suns) {
    const SkyGrid grid = picture_grid(picture);
    std::vector<glm::vec4> level(std::size_t{width} * width, glm::vec4(0.0F));
    for (std::uint32_t i = 0; i < grid.cells.size(); ++i) {
        const SkyGrid::Cell& cell = grid.cells[i];
        if (is_sun(cell, suns)) continue;
        const glm::uvec2 at = glm::uvec2(i % grid.size.x, i / grid.size.x) * width / grid.size;
        level[std::size_t{at.y} * width + at.x] += glm::vec4(cell.moment, sum_of_channels(cell.light));
    }
    return level;
}

float light_of(const std::vector<glm::vec4>& level) {
    float sum = 0.0F;
    for (const glm::vec4& cell : level) sum += cell.w;
    return sum;
}

/// Takes light of the radiance that is the mean of all from each cell.
void take_mean(std::vector<glm::vec4>& level) {
    constexpr float pi = std::numbers::pi_v<float>;
    const float mean = light_of(level) / (4.0F * pi);
    for (std::uint32_t i = 0; i < level.size(); ++i) {
        const std::uint32_t row = i / width;
        const float top = std::cos(pi * static_cast<float>(row) / static_cast<float>(width));
        const float bottom = std::cos(pi * static_cast<float>(row + 1) / static_cast<float>(width));
        const float solid_angle = 2.0F * pi / static_cast<float>(width) * (top - bottom);
        glm::vec4& cell = level[i];
        if (cell.w > 0.0F) cell *= std::max(cell.w - mean * solid_angle, 0.0F) / cell.w;
    }
}

/// Half as wide and high.
std::vector<glm::vec4> level_above(const std::vector<glm::vec4>& level, std::uint32_t size) {
    std::vector<glm::vec4> above;
    for (std::uint32_t y = 0; y < size; y += 2) {
        for (std::uint32_t x = 0; x < size; x += 2) {
            const std::size_t at = std::size_t{y} * size + x;
            above.push_back(level[at] + level[at + 1] + level[at + size] + level[at + size + 1]);
        }
    }
    return above;
}

}  // namespace

SkyTree sky_tree(const SkyPicture* picture, const std::vector<SkySun>& suns) {
    SkyTree tree;
    tree.levels.push_back(lowest_level(picture, suns));
    const float all = light_of(tree.levels[0]);
    take_mean(tree.levels[0]);
    tree.share = all > 0.0F ? light_of(tree.levels[0]) / all : 0.0F;
    for (std::uint32_t size = width; size > 1; size /= 2) {
        tree.levels.push_back(level_above(tree.levels.back(), size));
    }
    return tree;
}

SkyTreeData add_sky_tree(FrameGraph& graph, Gpu& gpu, const Sky& sky) {
    return graph.add("sky-tree", [&](Pass& pass) {
        pass.read(sky.picture);
        pass.read(sky.split);
        const TextureDesc desc{.size = {width, width},
                               .format = Format::rgba32f,
                               .mips = static_cast<std::uint32_t>(std::bit_width(width))};
        const SkyTreeData out{
            .levels = pass.write(graph.texture("sky tree", desc, Lifetime::persistent), Usage::copy),
            .share = pass.write(graph.value<float>("share of bright sky"))};
        pass.run([=, &gpu](Execution& run) {
            const SkyTree tree = sky_tree(run.value(sky.picture).get(), run.value(sky.split).suns);
            for (std::size_t level = 0; level < tree.levels.size(); ++level) {
                const auto size = static_cast<GLsizei>(width >> level);
                gpu.gl().TextureSubImage2D(run.object(out.levels), static_cast<GLint>(level), 0, 0, size,
                                           size, GL_RGBA, GL_FLOAT, tree.levels[level].data());
            }
            run.set(out.share, tree.share);
        });
        return out;
    });
}

}  // namespace candela
