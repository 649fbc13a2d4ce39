#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <vector>

#include "renderer/passes/lights/shadow_draws.hpp"
#include "tests/seed.hpp"

TEST_SUITE("shadow draws") {

using namespace candela;

namespace {

constexpr std::uint32_t resolution = 64;

class Random {
 public:
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    glm::vec3 point(float reach) {
        const float x = number(-reach, reach), y = number(-reach, reach);
        return {x, y, number(-reach, reach)};
    }

 private:
    std::mt19937 engine_{test_seed()};
};

/// Small triangles along a random walk, so that those of a part are near each other.
Primitive strip(Random& random, std::uint32_t triangles) {
    Primitive primitive;
    glm::vec3 at(0.0F);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        at = glm::clamp(at + random.point(0.05F), -5.0F, 5.0F);
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            primitive.indices.push_back(3 * i + corner);
            Vertex vertex;
            vertex.position = at + random.point(0.05F);
            primitive.vertices.push_back(vertex);
        }
    }
    return primitive;
}

/// The layout of one item with one drawable, whose indices start at 30.
SceneLayout layout_of(Primitive primitive) {
    constexpr std::size_t part_size = 3 * triangles_per_part;
    const auto index_count = static_cast<std::uint32_t>(primitive.indices.size());
    std::vector<Box> parts((index_count + part_size - 1) / part_size);
    Box whole;
    for (std::size_t i = 0; i < index_count; ++i) {
        parts[i / part_size].grow(primitive.vertices[i].position);
        whole.grow(primitive.vertices[i].position);
    }
    DrawnPrimitive drawn{.bounds = whole};
    drawn.mesh = std::make_shared<const Mesh>(Mesh{"strip", {std::move(primitive)}});
    if (parts.size() > 1) drawn.parts = parts;
    SceneLayout layout;
    layout.first_of_item.push_back(0);
    layout.drawables.push_back({.entity = {},
                                .item = 0,
                                .next = SceneLayout::none,
                                .drawn = std::make_shared<const DrawnPrimitive>(std::move(drawn))});
    layout.draw_of.push_back(0);
    layout.draws.push_back({.index_count = index_count,
                            .instance_count = 1,
                            .first_index = 30,
                            .base_vertex = 7,
                            .base_instance = 0});
    return layout;
}

/// A face of a cube, as of a light at `from`, with reversed depth and no far plane.
glm::mat4 face(glm::vec3 from, glm::vec3 towards) {
    glm::mat4 projection(0.0F);
    projection[0][0] = projection[1][1] = 1.0F;
    projection[2][3] = -1.0F;
    projection[3][2] = 0.01F;
    return projection * glm::lookAt(from, towards, glm::vec3(0.1F, 1.0F, 0.2F));
}

/// Whether a corner of the triangle marks a texel: it is in front of the light, on the map or less than a
/// texel beside it.
bool marks(const glm::mat4& clip_from_local, const Primitive& primitive, std::uint32_t triangle) {
    return std::ranges::any_of(std::array{0U, 1U, 2U}, [&](std::uint32_t corner) {
        const glm::vec3& position = primitive.vertices[primitive.indices[3 * triangle + corner]].position;
        const glm::vec4 clip = clip_from_local * glm::vec4(position, 1.0F);
        const float most = clip.w * (1.0F + 2.0F / static_cast<float>(resolution));
        return clip.w > 0.0F && std::abs(clip.x) < most && std::abs(clip.y) < most;
    });
}

/// How many of the commands draw the triangle.
std::size_t times_drawn(const std::vector<gpu::DrawCommand>& draws, std::uint32_t triangle) {
    const std::uint32_t index = 30 + 3 * triangle;
    return static_cast<std::size_t>(std::ranges::count_if(draws, [&](const gpu::DrawCommand& draw) {
        return draw.first_index <= index && index < draw.first_index + draw.index_count;
    }));
}

}  // namespace

TEST_CASE("every triangle that marks a texel of a map is drawn once, and others are left out") {
    Random random;
    std::size_t triangles = 0, drawn = 0, marking = 0;
    for (int i = 0; i < 60; ++i) {
        // From a single part to several; the last one is not full.
        const Primitive primitive = strip(random, 200 + 230 * static_cast<std::uint32_t>(i % 10));
        const SceneLayout layout = layout_of(primitive);
        const glm::mat4 world = glm::translate(
            glm::rotate(glm::mat4(1.0F), random.number(0.0F, 6.0F), random.point(1.0F)), random.point(2.0F));
        const ScenePlacement placement{.world = {world}, .deformed = {}};
        const glm::vec3 light = random.point(4.0F);
        const glm::mat4 clip = face(light, light + random.point(1.0F));
        std::vector<gpu::DrawCommand> draws;
        append_shadow_draws(shadow_casters(layout, placement, 1e-4F), clip, resolution, draws);
        const auto count = static_cast<std::uint32_t>(primitive.indices.size() / 3);
        for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
            const std::size_t times = times_drawn(draws, triangle);
            const bool must = marks(clip * world, primitive, triangle);
            REQUIRE(times <= 1);
            if (must) REQUIRE(times == 1);
            marking += must ? 1 : 0;
            drawn += times;
            ++triangles;
        }
        for (const gpu::DrawCommand& draw : draws) {
            CHECK(draw.first_index >= 30);
            CHECK(draw.first_index + draw.index_count <= 30 + 3 * count);
            CHECK(draw.base_vertex == 7);
            CHECK(draw.instance_count == 1);
        }
    }
    // A face sees about a sixth of the directions, and the boxes are not much larger than their
    // triangles.
    CHECK(marking > 0);
    CHECK(drawn < triangles / 2);
}

TEST_CASE("parts that follow each other are drawn by one command") {
    Random random;
    const Primitive primitive = strip(random, 4 * triangles_per_part + 1);
    const SceneLayout layout = layout_of(primitive);
    const ScenePlacement placement{.world = {glm::mat4(1.0F)}, .deformed = {}};
    std::vector<gpu::DrawCommand> draws;
    append_shadow_draws(shadow_casters(layout, placement, 0.0F), face({0.0F, 0.0F, 30.0F}, {}), resolution,
                        draws);
    REQUIRE(draws.size() == 1);
    CHECK(draws[0].first_index == layout.draws[0].first_index);
    CHECK(draws[0].index_count == layout.draws[0].index_count);
}

}  // TEST_SUITE("shadow draws")
