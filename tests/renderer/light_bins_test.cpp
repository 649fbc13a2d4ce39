#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "renderer/passes/lights/light_bins.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("light bins") {

using namespace candela;

namespace {

class Random {
 public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    glm::vec3 vector(float reach) {
        const float x = number(-reach, reach), y = number(-reach, reach);
        return {x, y, number(-reach, reach)};
    }
    /// Uniform on the sphere.
    glm::vec3 direction() { return around({0, 0, 1}, -1.0F); }
    /// Uniform over the directions whose cosine with the axis is above `cosine`.
    glm::vec3 around(glm::vec3 axis, float cosine) {
        const float z = number(cosine, 1.0F), angle = number(0.0F, 6.2831853F);
        const float r = std::sqrt(std::max(1.0F - z * z, 0.0F));
        const Basis basis = basis_around(axis);
        return r * std::cos(angle) * basis.tangent + r * std::sin(angle) * basis.bitangent + z * axis;
    }

 private:
    std::mt19937 engine_;
};

gpu::Light point_at(glm::vec3 position, float range) {
    gpu::Light light{};
    light.position = position;
    light.kind = LIGHT_POINT;
    light.range = range;
    return light;
}

LightTable::Entry random_light(Random& random) {
    gpu::Light light = point_at(random.vector(10.0F), std::pow(10.0F, random.number(-3.0F, 1.5F)));
    const int kind = random.integer(0, 9);
    if (kind >= 5) {
        const float outer = random.number(0.01F, 1.5707F);
        light.kind = LIGHT_SPOT;
        light.direction = random.direction();
        light.cos_outer = std::cos(outer);
    } else if (kind == 0) {
        light.range = std::numeric_limits<float>::infinity();
    }
    return {.entity = {}, .light = light};
}

LightTable random_lights(Random& random, int count) {
    LightTable table;
    for (int i = 0; i < count; ++i) table.entries.push_back(random_light(random));
    return table;
}

CameraView random_view(Random& random, glm::uvec2 size) {
    Camera camera{.vertical_fov = random.number(0.1F, 2.5F), .near_plane = 0.001F};
    if (random.integer(0, 3) == 0) {
        camera = {.projection = Camera::Projection::orthographic,
                  .half_height = random.number(0.1F, 10.0F),
                  .near_plane = 0.0F,
                  .far_plane = 40.0F};
    }
    const Transform pose = looking(random.vector(8.0F), random.vector(8.0F));
    glm::mat4 matrix = glm::mat4_cast(pose.rotation);
    matrix[3] = glm::vec4(pose.translation, 1.0F);
    const glm::vec2 jitter(random.number(-0.5F, 0.5F), random.number(-0.5F, 0.5F));
    return make_view(camera, matrix, size, jitter);
}

/// A point that the light reaches, often near the end of its range.
glm::vec3 lit_point(Random& random, const gpu::Light& light) {
    const float reach = std::isinf(light.range) ? 20.0F : light.range;
    const float distance = reach * (random.integer(0, 1) == 0 ? 0.9999F : random.number(0.0F, 1.0F));
    const float cosine = light.kind == LIGHT_SPOT ? std::min(light.cos_outer + 1e-5F, 1.0F) : -1.0F;
    return light.position + distance * random.around(light.direction, cosine);
}

/// The cell in which a point is seen, in double precision; nullopt outside the picture.
std::optional<std::uint32_t> cell_of(const CameraView& view, const CellGrid& grid, glm::dvec3 point) {
    const glm::dvec4 clip = glm::dmat4(view.clip_from_world) * glm::dvec4(point, 1.0);
    if (clip.w <= 0.0 || std::abs(clip.x) >= clip.w || std::abs(clip.y) >= clip.w || clip.z > clip.w) {
        return {};
    }
    const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(grid.size);
    const glm::uvec2 tile = glm::uvec2(pixel) / grid.tile_size;
    const double depth = -(glm::dmat4(view.view_from_world) * glm::dvec4(point, 1.0)).z;
    std::uint32_t slice = 0;
    for (double end = grid.first_depth; depth > end && slice + 1 < grid.slices; ++slice) {
        end *= static_cast<double>(grid.depth_ratio);
    }
    return (slice * grid.tiles.y + tile.y) * grid.tiles.x + tile.x;
}

std::span<const std::uint32_t> list_of(const LightBins& bins, std::uint32_t cell) {
    return std::span(bins.entries).subspan(bins.first[cell], bins.first[cell + 1] - bins.first[cell]);
}

std::span<const std::uint32_t> globals_of(const LightBins& bins) {
    return std::span(bins.entries).first(bins.global_count);
}

bool strictly_ascending(std::span<const std::uint32_t> list) {
    return std::ranges::adjacent_find(list, std::greater_equal<>()) == list.end();
}

CellGrid random_grid(Random& random) {
    const glm::uvec2 size(random.integer(1, 700), random.integer(1, 400));
    const ListSettings settings{.tile_size = 16U << static_cast<unsigned>(random.integer(0, 2)),
                                .slices = static_cast<std::uint32_t>(random.integer(2, 32))};
    if (random.integer(0, 1) == 0) return tile_grid(size, settings);
    return cluster_grid(size, settings, random.number(0.01F, 1.0F), random.number(2.0F, 40.0F));
}

}  // namespace

TEST_CASE("every cell lists all lights that reach into it") {
    Random random(1);
    std::uint64_t seen = 0, listed = 0, possible = 0;
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        const CellGrid grid = random_grid(random);
        const CameraView view = random_view(random, grid.size);
        const LightTable lights = random_lights(random, random.integer(0, 40));
        const LightBins bins = bin_lights(lights, view, grid);
        std::uint64_t missing = 0;
        for (std::uint32_t i = 0; i < lights.entries.size(); ++i) {
            if (std::ranges::binary_search(globals_of(bins), i)) continue;
            for (int sample = 0; sample < 50; ++sample) {
                const auto cell = cell_of(view, grid, lit_point(random, lights.entries[i].light));
                if (!cell) continue;
                ++seen;
                missing += std::ranges::binary_search(list_of(bins, *cell), i) ? 0U : 1U;
            }
        }
        CHECK(missing == 0);
        listed += bins.entries.size() - bins.global_count + std::uint64_t{bins.global_count} * grid.cells();
        possible += lights.entries.size() * grid.cells();
    }
    // Most possible entries are not in the lists, and many of the tested points are in the picture.
    CHECK(seen > 10'000);
    CHECK(listed * 4 < possible);
}

TEST_CASE("lists are sorted, and each light is either in lists or global, never both") {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const CellGrid grid = random_grid(random);
        const LightTable lights = random_lights(random, 60);
        const LightBins bins = bin_lights(lights, random_view(random, grid.size), grid);
        REQUIRE(bins.first.size() == grid.cells() + 1);
        REQUIRE(bins.first.front() == bins.global_count);
        REQUIRE(bins.first.back() == bins.entries.size());
        REQUIRE(std::ranges::is_sorted(bins.first));
        CHECK(strictly_ascending(globals_of(bins)));
        bool ascending = true, twice = false;
        for (std::uint32_t cell = 0; cell < grid.cells(); ++cell) {
            const auto list = list_of(bins, cell);
            ascending = ascending && strictly_ascending(list);
            twice = twice || std::ranges::any_of(list, [&](std::uint32_t light) {
                        return light >= lights.entries.size() ||
                               std::ranges::binary_search(globals_of(bins), light);
                    });
        }
        CHECK(ascending);
        CHECK_FALSE(twice);
    }
}

TEST_CASE("without lights all lists are empty") {
    const CellGrid grid = tile_grid({100, 50}, {});
    const LightBins bins = bin_lights({}, CameraView{}, grid);
    CHECK(bins.entries.empty());
    CHECK(bins.first == std::vector<std::uint32_t>(grid.cells() + 1, 0));
}

TEST_CASE("a small distant light is in few cells") {
    const glm::uvec2 size(640, 480);
    const CameraView view = make_view({.vertical_fov = 1.0F}, glm::mat4(1.0F), size);
    const LightTable lights{{{.entity = {}, .light = point_at({0.4F, 0.3F, -10.0F}, 0.1F)}}};
    const LightBins tiles = bin_lights(lights, view, tile_grid(size, {}));
    // 0.2 m at a distance of 10 m are 9 of 480 pixels; with a margin of one pixel that is at most 2 × 2
    // tiles.
    CHECK(tiles.entries.size() >= 1);
    CHECK(tiles.entries.size() <= 4);
    // In depth the light is in one slice of 0.05 m to 50 m, or crosses the border of two, with a margin
    // of one slice on either side.
    const LightBins clusters = bin_lights(lights, view, cluster_grid(size, {}, 0.05F, 50.0F));
    CHECK(clusters.entries.size() <= 4 * tiles.entries.size());
}

TEST_CASE("lights behind the eye are in no list") {
    const glm::uvec2 size(64, 64);
    const CameraView view = make_view({}, glm::mat4(1.0F), size);
    const LightTable lights{{{.entity = {}, .light = point_at({0, 0, 1.0F}, 0.99F)},
                             {.entity = {}, .light = point_at({3.0F, 0, 9.0F}, 5.0F)}}};
    CHECK(bin_lights(lights, view, tile_grid(size, {})).entries.empty());
    CHECK(bin_lights(lights, view, cluster_grid(size, {}, 0.1F, 10.0F)).entries.empty());
}

TEST_CASE("if lists exceed their memory, the lights with the largest extent become global") {
    const glm::uvec2 size(1024, 1024);
    const CameraView view = make_view({.vertical_fov = 1.2F}, glm::mat4(1.0F), size);
    const CellGrid grid = cluster_grid(size, {}, 0.1F, 100.0F);
    Random random(3);
    LightTable lights;
    for (int i = 0; i < 1500; ++i) {
        const gpu::Light light =
            point_at({random.number(-2, 2), random.number(-2, 2), -4.0F}, random.number(0.1F, 1.5F));
        lights.entries.push_back({.entity = {}, .light = light});
    }
    const LightBins bins = bin_lights(lights, view, grid);
    CHECK(bins.global_count > 0);
    CHECK(bins.entries.size() - bins.global_count <= most_list_entries);
    // The number of global lights is minimal: with one less, the lists would not have fitted.
    CHECK(bins.entries.size() + grid.cells() > most_list_entries);

    float narrowest_global = std::numeric_limits<float>::infinity();
    for (const std::uint32_t i : globals_of(bins)) {
        narrowest_global = std::min(narrowest_global, lights.entries[i].light.range);
    }
    // Lights of the same size at the same distance touch about the same number of cells, except at
    // borders.
    std::vector<std::uint32_t> listed(bins.entries.begin() + bins.global_count, bins.entries.end());
    float widest_listed = 0.0F;
    for (const std::uint32_t i : listed) {
        widest_listed = std::max(widest_listed, lights.entries[i].light.range);
    }
    CHECK(widest_listed < 1.3F * narrowest_global);
}

}  // TEST_SUITE("light bins")
