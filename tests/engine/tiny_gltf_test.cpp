// The shipped scenes, against a second reader of glTF: TinyGLTF.

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include <candela/scene/gltf.hpp>
#include "sandbox/files/shipped_file.hpp"

TEST_SUITE("glTF and TinyGLTF") {

using namespace candela;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> shipped_scenes() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& file : fs::directory_iterator(sandbox::shipped_file("scenes", ""))) {
        if (file.path().extension() == ".gltf") files.push_back(file.path());
    }
    return files;
}

template <class Vector>
Vector to_vector(const std::vector<double>& numbers, Vector otherwise) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        otherwise[static_cast<glm::length_t>(i)] = static_cast<float>(numbers[i]);
    }
    return otherwise;
}

void compare(const Material& read, const tinygltf::Material& expected) {
    CHECK(read.name == expected.name);
    CHECK(read.base_colour == to_vector(expected.pbrMetallicRoughness.baseColorFactor, glm::vec4(1.0F)));
    CHECK((read.base_colour_texture != nullptr) ==
          (expected.pbrMetallicRoughness.baseColorTexture.index >= 0));
    CHECK(read.metalness == static_cast<float>(expected.pbrMetallicRoughness.metallicFactor));
    CHECK(read.roughness == static_cast<float>(expected.pbrMetallicRoughness.roughnessFactor));
    CHECK(read.double_sided == expected.doubleSided);
    CHECK((read.alpha_mode == AlphaMode::blend) == (expected.alphaMode == "BLEND"));
    CHECK((read.alpha_mode == AlphaMode::mask) == (expected.alphaMode == "MASK"));
    CHECK(read.alpha_cutoff == static_cast<float>(expected.alphaCutoff));
    const auto strength = expected.extensions.find("KHR_materials_emissive_strength");
    if (strength == expected.extensions.end()) {
        CHECK(read.emissive == to_vector(expected.emissiveFactor, glm::vec3(0.0F)));
    }
}

void compare(const Mesh& read, const tinygltf::Mesh& expected, const tinygltf::Model& model) {
    CHECK(read.name == expected.name);
    REQUIRE(read.primitives.size() == expected.primitives.size());
    for (std::size_t i = 0; i < read.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = expected.primitives[i];
        const auto accessor = [&](int index) { return model.accessors[static_cast<std::size_t>(index)]; };
        CHECK(read.primitives[i].vertices.size() == accessor(primitive.attributes.at("POSITION")).count);
        CHECK(read.primitives[i].indices.size() == accessor(primitive.indices).count);
        if (primitive.material >= 0) {
            compare(*read.primitives[i].material,
                    model.materials[static_cast<std::size_t>(primitive.material)]);
        }
    }
}

void compare(const Camera& read, const tinygltf::Camera& expected) {
    REQUIRE(expected.type == "perspective");
    CHECK(read.projection == Camera::Projection::perspective);
    CHECK(read.vertical_fov == static_cast<float>(expected.perspective.yfov));
    CHECK(read.near_plane == static_cast<float>(expected.perspective.znear));
    if (expected.perspective.zfar > 0.0) {
        CHECK(read.far_plane == static_cast<float>(expected.perspective.zfar));
    }
}

void compare_light(const World& world, Entity entity, const tinygltf::Light& expected) {
    const auto compare_common = [&](const auto& light) {
        CHECK(light.colour == to_vector(expected.color, glm::vec3(1.0F)));
        CHECK(light.intensity == static_cast<float>(expected.intensity));
        if (expected.range > 0.0) CHECK(light.range == static_cast<float>(expected.range));
    };
    if (expected.type == "point") {
        compare_common(world.get<PointLight>(entity));
    } else if (expected.type == "spot") {
        const auto& light = world.get<SpotLight>(entity);
        compare_common(light);
        CHECK(light.inner_cone == static_cast<float>(expected.spot.innerConeAngle));
        CHECK(light.outer_cone == static_cast<float>(expected.spot.outerConeAngle));
    } else {
        const auto& light = world.get<DirectionalLight>(entity);
        CHECK(light.colour == to_vector(expected.color, glm::vec3(1.0F)));
        CHECK(light.illuminance == static_cast<float>(expected.intensity));
    }
}

}  // namespace

TEST_CASE("the import reads the shipped scenes as TinyGLTF does") {
    for (const fs::path& path : shipped_scenes()) {
        CAPTURE(path);
        tinygltf::Model model;
        std::string errors;
        std::string warnings;
        REQUIRE(tinygltf::TinyGLTF().LoadASCIIFromFile(&model, &errors, &warnings, path.string()));
        World world;
        const ImportReport report = import_gltf(path, world);
        std::map<std::string, std::vector<Entity>> entities;
        for (const Entity entity : report.entities) {
            entities[world.get<Name>(entity).value].push_back(entity);
        }
        std::size_t compared = 0;
        for (const tinygltf::Node& node : model.nodes) {
            CAPTURE(node.name);
            if (entities[node.name].size() != 1) {
                continue;  // a name that several have
            }
            ++compared;
            const Entity entity = entities[node.name].front();
            if (node.mesh >= 0) {
                const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
                compare(*world.get<MeshInstance>(entity).mesh, mesh, model);
            }
            if (node.camera >= 0) {
                compare(world.get<Camera>(entity), model.cameras[static_cast<std::size_t>(node.camera)]);
            }
            if (const auto light = node.extensions.find("KHR_lights_punctual");
                light != node.extensions.end()) {
                const int index = light->second.Get("light").GetNumberAsInt();
                compare_light(world, entity, model.lights[static_cast<std::size_t>(index)]);
            }
        }
        CHECK(compared > 0);
    }
}

}  // TEST_SUITE("glTF and TinyGLTF")
