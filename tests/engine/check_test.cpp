// What is wrong with bumpy meshes. Other faults are tested with the renderer, which reports them.

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <candela/scene/tangents.hpp>
#include "engine/scene/check.hpp"

TEST_SUITE("faults of bumpy meshes") {

using namespace candela;

namespace {

std::shared_ptr<const Image> image(Encoding encoding, std::size_t texels = 4) {
    return std::make_shared<const Image>(Image{
        .width = 2, .height = 2, .texels = std::vector(texels, glm::u8vec4(128)), .encoding = encoding});
}

Material bumpy() {
    Material material;
    material.name = "paint";
    material.normal_texture = image(Encoding::linear);
    material.occlusion_texture = image(Encoding::linear);
    return material;
}

/// A triangle without tangents.
Mesh triangle(Material material) {
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    return {"patch",
            {{{{{0, 0, 0}, up, {0, 0}}, {{1, 0, 0}, up, {1, 0}}, {{0, 1, 0}, up, {0, 1}}},
              {0, 1, 2},
              std::make_shared<const Material>(std::move(material))}}};
}

std::string fault_of_changed(const std::function<void(Material&)>& change) {
    Material material = bumpy();
    change(material);
    Mesh mesh = triangle(std::move(material));
    derive_tangents(mesh.primitives[0]);
    return fault_of(mesh, Strictness::strict).value_or("none");
}

}  // namespace

TEST_CASE("normal and occlusion textures and their factors") {
    const std::string material = "primitive 0 of mesh \"patch\": material \"paint\": ";
    CHECK(fault_of_changed([](Material&) {}) == "none");
    CHECK(fault_of_changed([](Material& m) { m.normal_scale = -3.0F; }) == "none");
    CHECK(fault_of_changed([](Material& m) { m.normal_scale = std::numeric_limits<float>::infinity(); }) ==
          material + "the scale of the normal texture is not finite");
    for (const float strength : {-0.1F, 1.1F, std::numeric_limits<float>::quiet_NaN()}) {
        CHECK(fault_of_changed([&](Material& m) { m.occlusion_strength = strength; }) ==
              material + "the strength of occlusion is not between 0 and 1");
    }
    CHECK(fault_of_changed([](Material& m) { m.transmission = 1.5F; }) ==
          material + "the transmission is not between 0 and 1");
    CHECK(fault_of_changed([](Material& m) { m.normal_texture = image(Encoding::srgb); }) ==
          material + "the normal texture is not encoded as linear values");
    CHECK(fault_of_changed([](Material& m) { m.occlusion_texture = image(Encoding::srgb); }) ==
          material + "the occlusion texture is not encoded as linear values");
    CHECK(fault_of_changed([](Material& m) { m.normal_texture = image(Encoding::linear, 3); }) ==
          material + "the normal texture has 3 texels for 2 × 2");
    CHECK(fault_of_changed([](Material& m) { m.occlusion_texture = image(Encoding::linear, 5); }) ==
          material + "the occlusion texture has 5 texels for 2 × 2");
}

TEST_CASE("vertices with a normal texture need tangents, also those of a deformed mesh") {
    const std::string missing = " has no tangent, which its normal texture needs: see derive_tangents";
    Mesh mesh = triangle(bumpy());
    const DeformedMesh without{
        std::make_shared<const DeformedMesh::Vertices>(1, mesh.primitives[0].vertices)};
    CHECK(fault_of(mesh, Strictness::usual) == "primitive 0 of mesh \"patch\": vertex 0" + missing);
    derive_tangents(mesh.primitives[0]);
    CHECK(fault_of(mesh, Strictness::strict) == Fault{});
    const DeformedMesh with{std::make_shared<const DeformedMesh::Vertices>(1, mesh.primitives[0].vertices)};
    CHECK(fault_of_fit(with, mesh) == Fault{});
    CHECK(fault_of_fit(without, mesh) == "primitive 0: vertex 0" + missing);
    mesh.primitives[0].vertices[1].tangent = glm::i16vec4(0);
    CHECK(fault_of(mesh, Strictness::usual) == "primitive 0 of mesh \"patch\": vertex 1" + missing);
}

TEST_CASE("second texture coordinates: one for each vertex where a texture needs them, and finite") {
    Material material = bumpy();
    material.normal_texture = nullptr;
    material.second_uvs.normal = true;  // of no texture
    Mesh mesh = triangle(material);
    CHECK(fault_of(mesh, Strictness::strict) == Fault{});
    material.second_uvs.occlusion = true;
    mesh = triangle(material);
    const std::string primitive = "primitive 0 of mesh \"patch\": ";
    CHECK(fault_of(mesh, Strictness::usual) == primitive + "0 second texture coordinates for 3 vertices");
    mesh.primitives[0].second_uvs.resize(2);
    CHECK(fault_of(mesh, Strictness::usual) == primitive + "2 second texture coordinates for 3 vertices");
    mesh.primitives[0].second_uvs.resize(3);
    CHECK(fault_of(mesh, Strictness::strict) == Fault{});
    mesh.primitives[0].second_uvs[1].y = std::numeric_limits<float>::infinity();
    CHECK(fault_of(mesh, Strictness::usual) ==
          primitive + "vertex 1: its second texture coordinates are not finite");
}

TEST_CASE("occlusion alone needs no tangents") {
    Material material = bumpy();
    material.normal_texture = nullptr;
    CHECK(fault_of(triangle(std::move(material)), Strictness::strict) == Fault{});
}

}  // TEST_SUITE("faults of bumpy meshes")
