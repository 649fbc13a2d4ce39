#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include "sandbox/files/shipped_file.hpp"
#include "tests/engine/gltf_builder.hpp"

using namespace candela;
using namespace candela::test;

namespace {

const std::filesystem::path scenes = sandbox::shipped_file("scenes", "");

/// Triangle of a mesh instance in the world.
struct WorldTriangle {
    glm::vec3 a, b, c;
    glm::vec3 normal;  ///< from the vertices, unit length

    /// Half the cross product of two edges: its length is the area, and it points to the front.
    [[nodiscard]] glm::vec3 area() const { return 0.5F * glm::cross(b - a, c - a); }
};

std::vector<WorldTriangle> triangles_of(const World& world, Entity entity) {
    const glm::mat4 matrix = world_matrix(world, entity);
    std::vector<WorldTriangle> triangles;
    for (const Primitive& primitive : world.get<MeshInstance>(entity).mesh->primitives) {
        const auto position = [&](std::size_t i) {
            return glm::vec3(matrix * glm::vec4(primitive.vertices.at(primitive.indices[i]).position, 1.0F));
        };
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            // The matrices here do not scale, so they transform normals like positions.
            const glm::vec3 normal = glm::mat3(matrix) * primitive.vertices.at(primitive.indices[i]).normal;
            triangles.push_back({position(i), position(i + 1), position(i + 2), normal});
        }
    }
    return triangles;
}

}  // namespace

TEST_SUITE("glTF files") {
TEST_CASE("a buffer may be a data URI, an external file or the .glb's binary chunk") {
    const TemporaryDirectory directory;
    GltfBuilder file = right_triangle();
    std::filesystem::path path = directory / "scene.gltf";
    SUBCASE("data URI") {
        write_file(path, file.gltf());
    }
    SUBCASE("external, longer than declared, with an encoded name") {
        Bytes longer = file.data;
        longer.resize(longer.size() + 10);
        write_file(directory / "a buffer.bin", longer);
        file.document["buffers"].push_back(file.buffer("a%20buffer.bin"));
        write_file(path, to_bytes(file.document.dump()));
    }
    SUBCASE(".glb, recognised by its first bytes only") {
        path = directory / "scene.model";
        write_file(path, file.glb());
    }
    World world;
    const ImportReport report = import_gltf(path, world);
    CHECK(report.triangles == 1);
    CHECK(world.get<MeshInstance>(report.entities.at(0)).mesh->primitives.at(0).vertices.at(1).position ==
          glm::vec3(1, 0, 0));
}

TEST_CASE("a .glb without a binary chunk") {
    GltfBuilder file;
    file.document["meshes"] = Json::array();
    file.document["nodes"] = Json::parse(R"([{"name": "alone"}])");
    World world;
    const ImportReport report = import_gltf(file.glb(), {}, "test.glb", world);
    CHECK(world.get<Name>(report.entities.at(0)).value == "alone");
}

}  // TEST_SUITE("glTF files")

TEST_SUITE("Cornell box") {
TEST_CASE("holds five walls, two blocks, a light and a camera") {
    World world;
    const ImportReport report = import_gltf(scenes / "cornell.gltf", world);
    CHECK(report.warnings.empty());
    CHECK(report.triangles == 34);
    CHECK(report.entities.size() == 9);
    CHECK(world.count<MeshInstance>() == 7);
    REQUIRE(world.count<PointLight>() == 1);
    REQUIRE(world.count<Camera>() == 1);
    for (auto [entity, light] : world.view<PointLight>()) {
        CHECK(world.get<Name>(entity).value == "ceiling light");
        const glm::vec3 at = world_matrix(world, entity)[3];
        CHECK(at.x == 0.0F);
        CHECK(at.z == 0.0F);
        CHECK(at.y < 2.0F);
        // Directly below the light, the floor receives about pi / 2 lux.
        CHECK(light.intensity / (at.y * at.y) == doctest::Approx(1.57).epsilon(0.02));
    }
}

TEST_CASE("fills a square picture") {
    World world;
    (void)import_gltf(scenes / "cornell.gltf", world);
    for (auto [entity, camera] : world.view<Camera>()) {
        const glm::mat4 matrix = world_matrix(world, entity);
        CHECK(glm::vec3(matrix[2]) == glm::vec3(0, 0, 1));  // looks along -z
        CHECK(matrix[3][1] == 1.0F);                        // from half the height
        // The opening's edge, 1 m above the axis, lies just inside the picture.
        const float half_height = (matrix[3][2] - 1.0F) * std::tan(camera.vertical_fov / 2.0F);
        CHECK(half_height > 1.0F);
        CHECK(half_height < 1.05F);
    }
}

TEST_CASE("has the area of the room and its blocks, and every front faces the light's space") {
    World world;
    (void)import_gltf(scenes / "cornell.gltf", world);
    float total = 0.0F;
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        const std::string name = world.get<Name>(entity).value;
        CAPTURE(name);
        glm::vec3 sum(0.0F);
        glm::vec3 centre(0.0F);
        const std::vector<WorldTriangle> triangles = triangles_of(world, entity);
        for (const WorldTriangle& triangle : triangles) {
            total += glm::length(triangle.area());
            sum += triangle.area();
            centre += (triangle.a + triangle.b + triangle.c) / (3.0F * static_cast<float>(triangles.size()));
            CHECK(glm::distance(glm::normalize(triangle.area()), triangle.normal) < 1e-6F);
        }
        const bool block = name.ends_with("block");
        if (block) {
            CHECK(glm::length(sum) < 1e-6F);  // closed: the area vectors cancel
        } else {
            CHECK(glm::dot(sum, glm::vec3(0, 1, 0) - centre) > 0.0F);  // points to the middle of the room
        }
        for (const WorldTriangle& triangle : triangles) {
            const glm::vec3 outwards = (triangle.a + triangle.b + triangle.c) / 3.0F - centre;
            if (block) CHECK(glm::dot(triangle.normal, outwards) > 0.0F);
        }
    }
    // Five walls of 2 m × 2 m; blocks of base 0.6 m × 0.6 m, 0.6 m and 1.2 m high.
    const float expected = 5 * 4 + (2 * 0.36F + 4 * 0.36F) + (2 * 0.36F + 4 * 0.72F);
    CHECK(total == doctest::Approx(expected).epsilon(1e-6));
}

}  // TEST_SUITE("Cornell box")
