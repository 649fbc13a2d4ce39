// Skins, morph targets and animations in glTF files.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/animate.hpp>
#include <candela/scene/gltf_export.hpp>
#include <candela/scene/hierarchy.hpp>
#include "tests/engine/malformed_gltf.hpp"
#include "tests/engine/moving_gltf.hpp"

using namespace candela;
using namespace candela::test;

namespace {

constexpr float rounding = std::numeric_limits<float>::epsilon();

const std::vector<Vertex>& deformed(const Imported& imported) {
    return imported.world.get<DeformedMesh>(imported.report.entities.front()).vertices->at(0);
}

Entity player_of(const Imported& imported) {
    return imported.find("animations");
}

/// The transform of the entity when the first clip is at that time.
Transform at(Imported& imported, const std::string& name, double seconds) {
    imported.world.edit<AnimationPlayer>(player_of(imported),
                                         [&](AnimationPlayer& player) { player.time = seconds; });
    CHECK(apply_animation(imported.world, player_of(imported)).empty());
    return imported.world.get<Transform>(imported.find(name));
}

}  // namespace

TEST_SUITE("glTF skins") {
TEST_CASE("a skin is read, and the figure has the shape that its joints give it") {
    const Imported imported(figure());
    CHECK(imported.report.warnings.empty());
    REQUIRE(imported.report.entities.size() == 3);
    const auto& skin = imported.world.get<Skin>(imported.report.entities[0]);
    CHECK(skin.joints == std::vector<Entity>{imported.report.entities[1], imported.report.entities[2]});
    REQUIRE(skin.inverse_bind_matrices);
    CHECK((*skin.inverse_bind_matrices)[0] == glm::mat4(1.0F));
    CHECK((*skin.inverse_bind_matrices)[1] == glm::translate(glm::mat4(1.0F), glm::vec3(-1, 0, 0)));
    CHECK(imported.primitive().influences.at(0).at(1) ==
          Influences{glm::u16vec4(1, 0, 0, 0), glm::vec4(1, 0, 0, 0)});
    // All joints are 3 further along z than the mesh was bound.
    CHECK(deformed(imported)[0].position == glm::vec3(0, 0, 3));
    CHECK(deformed(imported)[1].position == glm::vec3(1, 0, 3));
    CHECK(deformed(imported)[2].position == glm::vec3(0, 1, 3));
}

TEST_CASE(
    "the transform of the mesh's node is ignored, and without matrices joints are bound where they are") {
    GltfBuilder file = figure();
    file.document["nodes"][0]["translation"] = {7, 8, 9};
    file.document["skins"][0].erase("inverseBindMatrices");
    const Imported imported(file);
    CHECK_FALSE(imported.world.get<Skin>(imported.report.entities[0]).inverse_bind_matrices);
    const glm::mat4 world = world_matrix(imported.world, imported.report.entities[0]);
    // Numbers below 16, with two roundings.
    CHECK(glm::distance(glm::vec3(world * glm::vec4(deformed(imported)[1].position, 1)), {2, 0, 3}) <=
          32.0F * rounding);
}

TEST_CASE("joints and weights of every type") {
    GltfBuilder file = figure();
    Json& attributes = file.primitive()["attributes"];
    SUBCASE("shorts") {
        attributes["JOINTS_0"] = file.add_accessor(
            std::vector<std::uint16_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4", 4);
        attributes["WEIGHTS_0"] = file.add_accessor(
            std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}, 5123, "VEC4", 4);
    }
    SUBCASE("bytes whose sum is not 1") {
        attributes["WEIGHTS_0"] = file.add_accessor(
            std::vector<std::uint8_t>{255, 0, 0, 0, 51, 0, 0, 0, 102, 0, 0, 0}, 5121, "VEC4", 4);
    }
    SUBCASE("floats, of which rounding has put one below 0") {
        attributes["WEIGHTS_0"] =
            file.add_accessor(Floats{1, -2e-16F, 0, 0, 1, 0, -1e-7F, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    }
    for (Json& accessor : file.document["accessors"]) {
        const bool is_short = accessor["componentType"] == 5123 && accessor["type"] == "VEC4";
        const bool is_weights = &accessor == &file.document["accessors"].back();
        if ((is_short || accessor["componentType"] == 5121) && is_weights) accessor["normalized"] = true;
    }
    CHECK(deformed(Imported(file))[1].position == glm::vec3(1, 0, 3));
}

TEST_CASE("a second set of influences counts like the first") {
    GltfBuilder file = figure();
    file.document["nodes"][2]["translation"] = {1, 0, 8};
    Json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_1"] =
        file.add_accessor(std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4);
    attributes["WEIGHTS_1"] = file.add_accessor(Floats{3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC4", 4);
    const Imported imported(file);
    CHECK(imported.primitive().influences.size() == 2);
    // A quarter at z = 3, three quarters at z = 3 + 8.
    CHECK(deformed(imported)[0].position == glm::vec3(0, 0, 9));
}

TEST_CASE("influences follow their vertices when few are used") {
    GltfBuilder file;
    Floats positions;
    std::vector<std::uint8_t> joints;
    Floats weights;
    for (int i = 0; i < 20; ++i) {
        const auto x = static_cast<float>(i);
        positions.insert(positions.end(), {x, x * x, 0});
        joints.insert(joints.end(), {static_cast<std::uint8_t>(i), 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
        file.document["nodes"][static_cast<std::size_t>(i) + 1]["translation"] = {0, 0, i};
        file.document["scenes"][0]["nodes"].push_back(i + 1);
        file.document["skins"][0]["joints"].push_back(i + 1);
    }
    file.document["nodes"][0]["skin"] = 0;
    file.add_primitive(positions);
    file.primitive()["indices"] = file.add_indices({17, 4, 9});
    file.primitive()["attributes"]["JOINTS_0"] = file.add_accessor(joints, 5121, "VEC4", 4);
    file.primitive()["attributes"]["WEIGHTS_0"] = file.add_accessor(weights, 5126, "VEC4", 4);
    SUBCASE("with the normals of the faces") {}
    SUBCASE("with normals") {
        Floats normals;
        for (int i = 0; i < 20; ++i) normals.insert(normals.end(), {0, 0, 1});
        file.primitive()["attributes"]["NORMAL"] = file.add_vectors(normals);
    }
    const Imported imported(file);
    REQUIRE(imported.primitive().vertices.size() == 3);
    for (const std::uint32_t corner : imported.primitive().indices) {
        const glm::vec3& position = deformed(imported)[corner].position;
        CHECK(position.z == position.x);  // joint i moves the vertex at x = i by i
    }
}

TEST_CASE("the lower entity of a sheared joint is the joint") {
    GltfBuilder file = figure();
    file.document["nodes"][1].erase("translation");
    file.document["nodes"][1]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1};
    const Imported imported(file);
    CHECK(imported.report.entities.size() == 4);
    const Entity joint = imported.world.get<Skin>(imported.report.entities[0]).joints[0];
    CHECK(joint == imported.report.entities[2]);
    // The decomposition is exact to a few roundings.
    CHECK(glm::distance(deformed(imported)[2].position, {0.5F, 1, 3}) <= 16.0F * rounding);
}

TEST_CASE("a mesh whose node has no skin keeps its shape and no influences") {
    GltfBuilder file = figure();
    file.document["nodes"][0].erase("skin");
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    CHECK(imported.primitive().influences.empty());
    CHECK_FALSE(imported.world.has<DeformedMesh>(imported.report.entities[0]));
}

TEST_CASE("what cannot move keeps its shape, with one warning") {
    using Warnings = std::vector<std::string>;
    GltfBuilder file = figure();
    SUBCASE("joints outside of the scene") {
        file.document["scenes"][0]["nodes"] = {0};
        CHECK(Imported(file).report.warnings ==
              Warnings{"skin 0 is ignored: its joint, node 1, is not in the scene"});
    }
    SUBCASE("more joints in the mesh than in the skin") {
        file.document["skins"][0]["joints"] = {1};
        CHECK(Imported(file).report.warnings ==
              Warnings{"entity \"node 0\": its mesh needs 2 joints, but its skin has 1; it keeps the "
                       "shape of its mesh"});
    }
    SUBCASE("a node without extent") {
        file.document["nodes"][0]["scale"] = {0, 1, 1};
        CHECK(Imported(file).report.warnings ==
              Warnings{"entity \"node 0\": its world matrix, in whose space it is deformed, has no "
                       "inverse; it keeps the shape of its mesh"});
    }
    SUBCASE("a skin without a mesh") {
        file.document["nodes"][0].erase("mesh");
        CHECK(Imported(file).report.warnings ==
              Warnings{"skins of nodes without a mesh, or with instances, are ignored"});
    }
}

TEST_CASE("an import leaves the figures of the world alone") {
    Imported imported(figure());
    MeshDeformer deformer;
    CHECK(deformer.update(imported.world).empty());
    const auto before = imported.world.changed<DeformedMesh>(imported.report.entities[0]);
    (void)import_gltf(figure().gltf(), {}, "second.gltf", imported.world);
    CHECK(imported.world.changed<DeformedMesh>(imported.report.entities[0]) == before);
    CHECK(imported.world.count<DeformedMesh>() == 2);
}

}  // TEST_SUITE("glTF skins")

TEST_SUITE("glTF morph targets") {
TEST_CASE("targets and weights of the mesh") {
    GltfBuilder file = morphing();
    file.document["meshes"][0]["weights"] = {0.5, 0};
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    CHECK(imported.mesh().morph_weights == Floats{0.5F, 0});
    CHECK(imported.primitive().targets.at(0).positions.at(1) == glm::vec3(0, 0, 2));
    CHECK(imported.primitive().targets.at(0).normals.empty());
    CHECK(imported.primitive().targets.at(1).normals.at(0) == glm::vec3(1, 0, 0));
    CHECK(imported.world.get<MorphWeights>(imported.report.entities[0]).values == Floats{0.5F, 0});
    CHECK(deformed(imported)[2].position == glm::vec3(0, 1, 1.5F));
}

TEST_CASE("weights of a node go before those of its mesh, and default to zeros") {
    GltfBuilder file = morphing();
    CHECK(deformed(Imported(file))[0].position == glm::vec3(0, 0, 0));
    file.document["meshes"][0]["weights"] = {0.5, 0};
    file.document["nodes"][0]["weights"] = {0, 1};
    const Imported imported(file);
    CHECK(deformed(imported)[0].position == glm::vec3(5, 0, 0));
    CHECK(glm::distance(deformed(imported)[0].normal, glm::normalize(glm::vec3(1, 0, 1))) <= 2.0F * rounding);
}

TEST_CASE("sparse offsets") {
    GltfBuilder file = morphing();
    const std::size_t indices = file.add_view(std::vector<std::uint16_t>{2});
    const std::size_t values = file.add_view(Floats{1, 2, 3});
    file.primitive()["targets"][0]["POSITION"] =
        file.add("accessors", {{"componentType", 5126},
                               {"count", 3},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 1},
                                 {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                 {"values", {{"bufferView", values}}}}}});
    file.document["nodes"][0]["weights"] = {1, 0};
    const Imported imported(file);
    CHECK(deformed(imported)[1].position == glm::vec3(1, 0, 0));
    CHECK(deformed(imported)[2].position == glm::vec3(1, 3, 3));
}

TEST_CASE("quantized offsets") {
    GltfBuilder file = morphing();
    file.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    const std::size_t accessor =
        file.add_accessor(std::vector<std::int8_t>{127, 0, 0, 0, 0, -127, 0, 0, 0, 0, 0, 0}, 5120, "VEC3", 4);
    file.document["accessors"][accessor]["normalized"] = true;
    file.document["bufferViews"].back()["byteStride"] = 4;
    file.primitive()["targets"][0]["POSITION"] = accessor;
    file.document["nodes"][0]["weights"] = {1, 0};
    const Imported imported(file);
    CHECK(deformed(imported)[0].position == glm::vec3(1, 0, 0));
    CHECK(deformed(imported)[1].position == glm::vec3(1, -1, 0));
}

TEST_CASE("meshes without normals have those of the faces that targets give them") {
    GltfBuilder file = morphing();
    file.primitive()["attributes"].erase("NORMAL");
    file.document["nodes"][0]["weights"] = {1, 0};
    const Imported imported(file);
    const std::vector<Vertex>& moved = deformed(imported);
    const glm::vec3 face = glm::normalize(
        glm::cross(moved[1].position - moved[0].position, moved[2].position - moved[0].position));
    for (const Vertex& vertex : moved) CHECK(glm::distance(vertex.normal, face) <= 4.0F * rounding);
}

TEST_CASE("triangles that have an area only when they move are kept") {
    GltfBuilder file = morphing();
    file.primitive()["attributes"]["POSITION"] = file.add_vectors({0, 0, 0, 1, 0, 0, 1, 0, 0});
    CHECK(Imported(file).report.triangles == 1);
}

}  // TEST_SUITE("glTF morph targets")

TEST_SUITE("glTF animations") {
TEST_CASE("a translation, and the player of the scene") {
    GltfBuilder file = right_triangle();
    file.document["nodes"][0]["name"] = "door";
    animate(file, {{"node", 0}, {"path", "translation"}}, {0, 2}, file.add_vectors({0, 0, 0, 4, 0, 0}));
    file.document["animations"][0]["name"] = "open";
    Imported imported(file);
    CHECK(imported.report.warnings.empty());
    CHECK(imported.report.entities.back() == player_of(imported));
    const auto& player = imported.world.get<AnimationPlayer>(player_of(imported));
    REQUIRE(player.animations);
    REQUIRE(player.animations->clips.size() == 1);
    CHECK(player.animations->clips[0]->name == "open");
    CHECK(player.animations->clips[0]->duration == 2.0F);
    CHECK(player.animations->targets == std::vector<Entity>{imported.find("door")});
    CHECK(player.playing);
    CHECK(player.looping);
    CHECK(player.time == 0.0);
    CHECK(imported.world.get<Transform>(imported.find("door")) == Transform{});
    CHECK(advance_animations(imported.world, 0.5).empty());
    CHECK(imported.world.get<Transform>(imported.find("door")).translation == glm::vec3(1, 0, 0));
}

TEST_CASE("rotations of every type, and every interpolation") {
    const float half = std::sqrt(0.5F);
    const auto turned = [&](int component_type, const std::function<std::size_t(GltfBuilder&)>& output) {
        GltfBuilder file = right_triangle();
        file.document["nodes"][0]["name"] = "wheel";
        const std::size_t accessor = output(file);
        if (component_type != 5126) file.document["accessors"][accessor]["normalized"] = true;
        animate(file, {{"node", 0}, {"path", "rotation"}}, {0, 1}, accessor);
        Imported imported(file);
        return at(imported, "wheel", 0.5).rotation;
    };
    const glm::quat expected = glm::angleAxis(glm::radians(45.0F), glm::vec3(0, 0, 1));
    // Half a step of the integers in each of four components, and roundings.
    const auto is_near = [&](const glm::quat& found, float step) {
        return glm::length(found - expected) <= 2.0F * step + 8.0F * rounding;
    };
    CHECK(is_near(turned(5126,
                         [&](GltfBuilder& file) {
                             return file.add_accessor(Floats{0, 0, 0, 1, 0, 0, half, half}, 5126, "VEC4", 4);
                         }),
                  0.0F));
    CHECK(is_near(turned(5122,
                         [&](GltfBuilder& file) {
                             return file.add_accessor(
                                 std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170}, 5122, "VEC4",
                                 4);
                         }),
                  1.0F / 32767.0F));
    CHECK(is_near(turned(5120,
                         [&](GltfBuilder& file) {
                             return file.add_accessor(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 90, 90},
                                                      5120, "VEC4", 4);
                         }),
                  1.0F / 127.0F));
}

TEST_CASE("steps and splines") {
    GltfBuilder file = right_triangle();
    file.document["nodes"][0]["name"] = "box";
    animate(file, {{"node", 0}, {"path", "scale"}}, {0, 1}, file.add_vectors({1, 1, 1, 2, 2, 2}), "STEP");
    Imported steps(file);
    CHECK(at(steps, "box", 0.9).scale == glm::vec3(1));
    file.document.erase("animations");
    // x = t³, whose slopes are 0 and 3.
    animate(file, {{"node", 0}, {"path", "translation"}}, {0, 1},
            file.add_vectors({0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 1, 0, 0, 0, 0, 0}), "CUBICSPLINE");
    Imported spline(file);
    CHECK(at(spline, "box", 0.5).translation.x == 0.125F);
}

TEST_CASE("weights, as floats and bytes") {
    for (const bool are_bytes : {false, true}) {
        GltfBuilder file = morphing();
        const std::size_t output =
            are_bytes ? file.add_accessor(std::vector<std::uint8_t>{0, 255, 255, 0}, 5121, "SCALAR", 1)
                      : file.add_accessor(Floats{0, 1, 1, 0}, 5126, "SCALAR", 1);
        if (are_bytes) file.document["accessors"][output]["normalized"] = true;
        animate(file, {{"node", 0}, {"path", "weights"}}, {0, 1}, output);
        Imported imported(file);
        CHECK(advance_animations(imported.world, 0.25).empty());
        CHECK(imported.world.get<MorphWeights>(imported.report.entities[0]).values == Floats{0.25F, 0.75F});
    }
}

TEST_CASE("a figure moves") {
    GltfBuilder file = figure();
    animate(file, {{"node", 2}, {"path", "translation"}}, {0, 1}, file.add_vectors({1, 0, 0, 1, 4, 0}));
    Imported imported(file);
    MeshDeformer deformer;
    CHECK(advance_animations(imported.world, 0.5).empty());
    CHECK(deformer.update(imported.world).empty());
    CHECK(deformed(imported)[1].position == glm::vec3(1, 2, 3));
    CHECK(deformed(imported)[0].position == glm::vec3(0, 0, 3));
}

TEST_CASE("what moves nothing is left out, each kind with one warning") {
    using Warnings = std::vector<std::string>;
    const auto warnings_for = [](const Json& target, const std::function<void(GltfBuilder&)>& change) {
        GltfBuilder file = right_triangle();
        const std::size_t output = file.add_vectors({0, 0, 0});
        animate(file, target, {0}, output);
        animate(file, target, {0}, output);
        change(file);
        const Imported imported(file);
        CHECK(imported.world.count<AnimationPlayer>() == 0);
        CHECK(imported.report.entities.size() == 1);
        return imported.report.warnings;
    };
    const auto nothing = [](GltfBuilder&) {};
    CHECK(warnings_for({{"path", "translation"}}, nothing) ==
          Warnings{"animations without a node are ignored"});
    CHECK(warnings_for({{"path", "pointer"}}, nothing) ==
          Warnings{"animations of other values than translation, rotation, scale and weights are ignored"});
    CHECK(warnings_for({{"node", 0}, {"path", "weights"}}, nothing) ==
          Warnings{"animations of weights of nodes without morph targets are ignored"});
    CHECK(warnings_for({{"node", 0}, {"path", "translation"}}, [](GltfBuilder& file) {
              file.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
          }) == Warnings{"animations of nodes with a matrix are ignored"});
    CHECK(warnings_for({{"node", 1}, {"path", "translation"}}, [](GltfBuilder& file) {
              file.add("nodes", Json::object());
          }) == Warnings{"animations of nodes that are not in the scene are ignored"});
}

}  // TEST_SUITE("glTF animations")

TEST_SUITE("glTF export") {
TEST_CASE("skins, morph targets and animations come back") {
    Imported before(moving_scene());
    const TemporaryDirectory folder;
    for (const char* const name : {"a.glb", "a.gltf"}) {
        CHECK(export_gltf(before.world, folder / name).empty());
        World after;
        const ImportReport report = import_gltf(folder / name, after);
        CHECK(report.warnings.empty());
        REQUIRE(report.entities.size() == before.report.entities.size());
        const Entity figure = report.entities[0];
        const Entity old = before.report.entities[0];
        const Primitive& primitive = after.get<MeshInstance>(figure).mesh->primitives.at(0);
        CHECK(primitive.influences == before.primitive().influences);
        CHECK(primitive.targets == before.primitive().targets);
        CHECK(after.get<MeshInstance>(figure).mesh->morph_weights == before.mesh().morph_weights);
        CHECK(after.get<MorphWeights>(figure) == before.world.get<MorphWeights>(old));
        CHECK(*after.get<Skin>(figure).inverse_bind_matrices ==
              *before.world.get<Skin>(old).inverse_bind_matrices);
        CHECK(after.get<Skin>(figure).joints == std::vector<Entity>{report.entities[1], report.entities[2]});
        CHECK(after.get<DeformedMesh>(figure).vertices->at(0) == deformed(before));

        const Animations& now = *after.get<AnimationPlayer>(report.entities.back()).animations;
        const Animations& old_ones = *before.world.get<AnimationPlayer>(player_of(before)).animations;
        REQUIRE(now.clips.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            const AnimationClip& clip = *now.clips[i];
            const AnimationClip& old_clip = *old_ones.clips[i];
            CHECK(clip.name == old_clip.name);
            CHECK(clip.duration == old_clip.duration);
            REQUIRE(clip.channels.size() == 1);
            CHECK(clip.channels[0].property == old_clip.channels[0].property);
            CHECK(now.targets.at(clip.channels[0].target).index ==
                  old_ones.targets.at(old_clip.channels[0].target).index);
            CHECK(clip.samplers[0].interpolation == old_clip.samplers[0].interpolation);
            CHECK(*clip.samplers[0].times == *old_clip.samplers[0].times);
            CHECK(*clip.samplers[0].values == *old_clip.samplers[0].values);
        }
    }
}

}  // TEST_SUITE("glTF export")

TEST_SUITE("malformed glTF") {
TEST_CASE("faults of skins, morph targets and animations are named") {
    GltfBuilder file = figure();  // accessors 0 to 3: positions, joints, weights, matrices
    const std::size_t output = file.add_vectors({0, 0, 0, 1, 0, 0});        // 4
    animate(file, {{"node", 2}, {"path", "translation"}}, {0, 1}, output);  // 5: times
    file.add_accessor(Floats{1, 1}, 5126, "SCALAR", 1);                     // 6
    file.add_accessor(Floats{-1, 1}, 5126, "SCALAR", 1);                    // 7
    CHECK(error_of(file) == "imported");
    check_defects(
        {
            {"/skins/0/joints", "", R"(^ has no "joints")"},
            {"/skins/0/joints", "[]", "@ has no joints"},
            {"/skins/0/joints/1", "9", "@ is 9, but there are 3 nodes"},
            {"/nodes/0/skin", "1", "@ is 1, but there are 1 skins"},
            {"/skins/0/joints", "[1, 2, 0]", "skin 0: it has 3 joints, but 2 inverse bind matrices"},
            {"/skins/0/inverseBindMatrices", "0",
             "skin 0: accessor 0 holds matrices, but is not MAT4 of FLOAT"},
            {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "",
             "mesh 0: it has only one of JOINTS_0 and WEIGHTS_0"},
            {"/meshes/0/primitives/0/attributes/JOINTS_1", "1",
             "mesh 0: it has only one of JOINTS_1 and WEIGHTS_1"},
            {"/meshes/0/primitives/0/attributes/JOINTS_0", "2",
             "mesh 0: accessor 2 holds joints, but is not VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT"},
            {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "1",
             "mesh 0: accessor 1 holds weights, but is not VEC4 of FLOAT or of normalised UNSIGNED_BYTE or "
             "UNSIGNED_SHORT"},
            {"/accessors/1/count", "2", "mesh 0: it has 3 positions, but 2 sets of joints"},
            {"/meshes/0/primitives/0/targets", R"([{"POSITION": 4}])",
             "mesh 0: it has 3 positions, but 2 offsets in a morph target"},
            {"/meshes/0/primitives/0/targets", R"([{"NORMAL": 99}])",
             "@[0].NORMAL is 99, but there are 8 accessors"},
            {"/meshes/0/primitives/1", R"({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]})",
             "mesh 0: its primitives have 0 and 1 morph targets"},
            {"/meshes/0/weights", "[0, 1]", "mesh 0: it has 2 weights for 0 morph targets"},
            {"/nodes/0/weights", "[1]", "node 0: it has 1 weights for 0 morph targets"},
            {"/nodes/0/weights", R"(["1"])", "@[0] is not a number"},
            {"/animations/0/channels", "", R"(^ has no "channels")"},
            {"/animations/0/samplers/0/input", "", R"(^ has no "input")"},
            {"/animations/0/samplers/0/interpolation", R"("CUBIC")",
             R"(@ is "CUBIC", not one of ["STEP","LINEAR","CUBICSPLINE"])"},
            {"/animations/0/channels/0/target/path", "", R"(^ has no "path")"},
            {"/animations/0/channels/0/sampler", "4",
             "animation 0: a channel has sampler 4, but there are 1 samplers"},
            {"/animations/0/samplers/0/interpolation", R"("CUBICSPLINE")",
             "animation 0: sampler 0: its 2 keys need 6 elements, but accessor 4 has 2"},
            {"/animations/0/samplers/0/input", "4",
             "animation 0: sampler 0: accessor 4 holds times, but is not SCALAR of FLOAT"},
            {"/animations/0/channels/0/target/path", R"("rotation")",
             "animation 0: sampler 0: accessor 4 holds values of keys, but is not VEC4 of FLOAT or of "
             "normalised integers of 8 or 16 bits"},
            {"/animations/0/samplers/0/input", "6",
             "animation 0: sampler 0: the times of its keys 0 and 1 do not ascend"},
            {"/animations/0/samplers/0/input", "7",
             "animation 0: sampler 0: the time of its first key is negative"},
        },
        file);
    const float infinite = std::numeric_limits<float>::infinity();
    const auto offset = file.document["bufferViews"][3]["byteOffset"].get<std::size_t>();
    std::memcpy(file.data.data() + offset + 100, &infinite, sizeof infinite);
    CHECK(error_of(file) == "skin 0: accessor 3 has a NaN or infinity in element 1");
}

TEST_CASE("memory for what moves is counted before it is allocated") {
    // Accessors claim zeros that the file does not contain, and nodes share what is large.
    const auto refused = [](const GltfBuilder& file) {
        return error_of(file).find("above the limit") != std::string::npos;
    };
    GltfBuilder animated = right_triangle();
    animate(animated, {{"node", 0}, {"path", "translation"}}, {0}, animated.add_vectors({0, 0, 0}));
    animated.document["animations"][0]["samplers"][0]["input"] =
        animated.add("accessors", {{"componentType", 5126}, {"count", 20000000}, {"type", "SCALAR"}});
    CHECK(refused(animated));

    // 100 000 triangles of the same vertex, whose 20 targets unshared would take 150 MB.
    GltfBuilder flat = morphing();
    flat.primitive()["attributes"].erase("NORMAL");
    flat.primitive()["indices"] = flat.add_accessor(std::vector<std::uint16_t>(300000), 5123, "SCALAR", 1);
    CHECK_FALSE(refused(flat));
    for (int i = 2; i < 20; ++i) flat.primitive()["targets"].push_back({{"POSITION", 0}});
    CHECK(refused(flat));

    // As many figures, of 30 000 vertices each, would take 2.9 GB.
    GltfBuilder figures;
    figures.add_primitive(Floats(90000));
    figures.primitive()["indices"] =
        figures.add_accessor(std::vector<std::uint16_t>(20001), 5123, "SCALAR", 1);
    figures.primitive()["attributes"]["NORMAL"] = 0;
    figures.primitive()["targets"] = {{{"POSITION", 0}}};
    for (int i = 1; i < 2000; ++i) {
        figures.document["nodes"].push_back({{"mesh", 0}});
        figures.document["scenes"][0]["nodes"].push_back(i);
    }
    CHECK(refused(figures));
    figures.primitive().erase("targets");
    CHECK_FALSE(refused(figures));
}

}  // TEST_SUITE("malformed glTF")
