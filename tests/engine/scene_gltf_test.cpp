#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include "tests/engine/gltf_builder.hpp"
#include "tests/throws.hpp"

using namespace candela;
using namespace candela::test;

namespace {

using Points = std::vector<glm::vec3>;

const Points right_corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// Four corners of a unit square in the plane z = 0.
GltfBuilder square() {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    return file;
}

/// The imported texture coordinates of a triangle whose texture coordinates are this accessor.
template <class T>
std::vector<glm::vec2> texture_coordinates(const std::vector<T>& values, int component_type,
                                           bool normalised) {
    GltfBuilder file = right_triangle();
    const std::size_t accessor = file.add_accessor(values, component_type, "VEC2", 2);
    // The rows of a vertex attribute are aligned to 4 bytes.
    if (sizeof(T) * 2 < 4) file.document["bufferViews"].back()["byteStride"] = 4;
    file.document["accessors"].back()["normalized"] = normalised;
    file.document["accessors"].back()["count"] = 3;
    file.primitive()["attributes"]["TEXCOORD_0"] = accessor;
    std::vector<glm::vec2> coordinates;
    for (const Vertex& corner : Imported(file).corners()) {
        coordinates.push_back(corner.uv);
    }
    return coordinates;
}

}  // namespace

TEST_SUITE("glTF geometry") {
TEST_CASE("a minimal file: one triangle") {
    const Imported imported(right_triangle());
    CHECK(imported.positions() == right_corners);
    CHECK(imported.report.triangles == 1);
    CHECK(imported.report.warnings.empty());
    REQUIRE(imported.report.entities.size() == 1);
    const Entity entity = imported.report.entities[0];
    CHECK(imported.world.get<Name>(entity).value == "node 0");
    CHECK(imported.world.get<Transform>(entity) == Transform{});
    CHECK(imported.primitive().material->base_colour == glm::vec4(1.0F));
    CHECK_FALSE(imported.primitive().material->double_sided);
    for (const Vertex& corner : imported.corners()) {
        CHECK(corner.normal == glm::vec3(0, 0, 1));
        CHECK(corner.uv == glm::vec2(0.0F));
    }
}

TEST_CASE("indices of every type give the same triangles") {
    const Points expected{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
    GltfBuilder file = square();
    SUBCASE("unsigned bytes") {
        file.primitive()["indices"] =
            file.add_accessor(std::vector<std::uint8_t>{0, 1, 2, 2, 1, 3}, 5121, "SCALAR", 1);
    }
    SUBCASE("unsigned shorts") {
        file.primitive()["indices"] =
            file.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 1);
    }
    SUBCASE("unsigned ints") {
        file.primitive()["indices"] =
            file.add_accessor(std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}, 5125, "SCALAR", 1);
    }
    SUBCASE("none") {
        file = GltfBuilder();
        file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0});
    }
    CHECK(Imported(file).positions() == expected);
}

TEST_CASE("strips and fans are wound as the specification says") {
    GltfBuilder file = square();
    SUBCASE("strip: every second triangle is flipped") {
        file.primitive()["mode"] = 5;
        CHECK(Imported(file).positions() ==
              Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    }
    SUBCASE("fan: all share the first vertex, which comes last") {
        file = GltfBuilder();
        file.add_primitive({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})["mode"] = 6;
        CHECK(Imported(file).positions() ==
              Points{{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
    }
    for (const Vertex& corner : Imported(file).corners()) {
        CHECK(corner.normal == glm::vec3(0, 0, 1));
    }
}

TEST_CASE("points and lines are skipped and reported once") {
    GltfBuilder file = right_triangle();
    for (const int mode : {0, 1, 2, 3}) {
        file.add_primitive({0, 0, 0, 1, 0, 0})["mode"] = mode;
    }
    const Imported imported(file);
    CHECK(imported.mesh().primitives.size() == 1);
    CHECK(imported.report.warnings == std::vector<std::string>{"points and lines are skipped"});
}

TEST_CASE("a mesh without triangles gives no instance") {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0})["mode"] = 1;
    const Imported imported(file);
    CHECK(imported.world.count<MeshInstance>() == 0);
    CHECK(imported.report.entities.size() == 1);
}

TEST_CASE("interleaved attributes are read by their stride") {
    GltfBuilder file;
    const std::size_t view = file.add_view(std::vector<float>{0, 0, 0, 0, 0, 1, 0.25F, 0.5F,  //
                                                              1, 0, 0, 0, 3, 0, 0.75F, 1.0F,  //
                                                              0, 1, 0, 2, 0, 0, -2.0F, 7.0F});
    file.document["bufferViews"][view]["byteStride"] = 32;
    int offset = 0;
    for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
        const bool vec2 = offset == 24;
        file.document["meshes"][0]["primitives"][0]["attributes"][name] =
            file.add("accessors", {{"bufferView", view},
                                   {"byteOffset", offset},
                                   {"componentType", 5126},
                                   {"count", 3},
                                   {"type", vec2 ? "VEC2" : "VEC3"}});
        offset += 12;
    }
    // Normals are imported at unit length.
    CHECK(Imported(file).corners() == std::vector<Vertex>{{{0, 0, 0}, {0, 0, 1}, {0.25F, 0.5F}},
                                                          {{1, 0, 0}, {0, 1, 0}, {0.75F, 1.0F}},
                                                          {{0, 1, 0}, {1, 0, 0}, {-2.0F, 7.0F}}});
}

TEST_CASE("texture coordinates may be floats or normalised integers") {
    using Coordinates = std::vector<glm::vec2>;
    CHECK(texture_coordinates<float>({0, 1, 0.5F, 2, -1, 0}, 5126, false) ==
          Coordinates{{0, 1}, {0.5F, 2}, {-1, 0}});
    CHECK(texture_coordinates<std::uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0}, 5121, true) ==
          Coordinates{{0, 1}, {0.2F, 0.4F}, {1, 0}});
    CHECK(texture_coordinates<std::uint16_t>({0, 65535, 13107, 26214, 65535, 0}, 5123, true) ==
          Coordinates{{0, 1}, {0.2F, 0.4F}, {1, 0}});
}

TEST_CASE("vertex colours may be floats or normalised integers, with or without alpha") {
    const auto colours_of = [](auto values, int type, const char* shape, std::size_t components) {
        GltfBuilder file = right_triangle();
        const std::size_t accessor = file.add_accessor(values, type, shape, components);
        file.document["accessors"][accessor]["normalized"] = type != 5126;
        file.primitive()["attributes"]["COLOR_0"] = accessor;
        std::vector<glm::u16vec4> colours;
        for (const Vertex& vertex : Imported(file).corners()) {
            colours.push_back(vertex.colour);
        }
        return colours;
    };
    using Colours = std::vector<glm::u16vec4>;
    CHECK(colours_of(std::vector<float>{0, 0.5F, 1, 2, -1, 0.25F, 1, 1, 1}, 5126, "VEC3", 3) ==
          Colours{{0, 32768, 65535, 65535}, {65535, 0, 16384, 65535}, {65535, 65535, 65535, 65535}});
    CHECK(colours_of(std::vector<float>{0, 1, 0, 0.5F, 0, 0, 0, 0, 1, 1, 1, 1}, 5126, "VEC4", 4) ==
          Colours{{0, 65535, 0, 32768}, {0, 0, 0, 0}, {65535, 65535, 65535, 65535}});
    CHECK(colours_of(std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65535}, 5123, "VEC4", 4) ==
          Colours{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 65535}});
    CHECK(colours_of(std::vector<std::uint8_t>{0, 1, 255, 254, 0, 0, 0, 0, 51, 51, 51, 51}, 5121, "VEC4",
                     4) == Colours{{0, 257, 65535, 65278}, {0, 0, 0, 0}, {13107, 13107, 13107, 13107}});
    const Imported plain(right_triangle());
    CHECK(plain.corners().at(0).colour == glm::u16vec4(65535));
}

TEST_CASE("vertex colours of a wrong type or number are refused") {
    GltfBuilder file = right_triangle();
    file.primitive()["attributes"]["COLOR_0"] = file.add_vectors({1, 1, 1, 0, 0, 0});
    CHECK_THROWS_WITH_AS(Imported{file}, "test.gltf: mesh 0: it has 3 positions, but 2 colours", SceneError);
    file = right_triangle();
    file.primitive()["attributes"]["COLOR_0"] =
        file.add_accessor(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 5121, "VEC4", 4);
    CHECK_THROWS_WITH_AS(
        Imported{file},
        "test.gltf: mesh 0: accessor 1 holds colours, but is not VEC3 or VEC4 of FLOAT or of "
        "normalised UNSIGNED_BYTE or UNSIGNED_SHORT",
        SceneError);
}

TEST_CASE("a sparse accessor replaces the elements it lists") {
    GltfBuilder file = right_triangle();
    const std::size_t indices = file.add_view(std::vector<std::uint16_t>{0, 2});
    const std::size_t values = file.add_view(std::vector<float>{0, 0, 5, 0, 1, 5});
    Json& accessor = file.document["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
    CHECK(Imported(file).positions() == Points{{0, 0, 5}, {1, 0, 0}, {0, 1, 5}});
    accessor.erase("bufferView");  // elements that are not listed are then zero
    accessor["sparse"]["indices"]["byteOffset"] = 0;
    CHECK(Imported(file).report.triangles == 1);
    CHECK(Imported(file).positions() == Points{{0, 0, 5}, {0, 0, 0}, {0, 1, 5}});
}

TEST_CASE("missing normals become the normals of the faces, so vertices are not shared") {
    GltfBuilder file;
    // Two faces of a roof that share a ridge along z.
    file.add_primitive({-1, 0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 0})["indices"] = 1;
    file.add_indices({0, 2, 1, 1, 2, 3});
    const std::vector<Vertex> corners = Imported(file).corners();
    const float half = std::sqrt(0.5F);
    for (std::size_t i = 0; i < 6; ++i) {
        const glm::vec3 expected(i < 3 ? -half : half, half, 0.0F);
        CHECK(glm::distance(corners[i].normal, expected) < 1e-6F);
    }
}

TEST_CASE("a normal of length zero becomes the normal of the face") {
    GltfBuilder file = right_triangle();
    file.primitive()["attributes"]["NORMAL"] = file.add_vectors({0, 0, 0, 1, 0, 0, 1e-30F, 0, 0});
    const std::vector<Vertex> corners = Imported(file).corners();
    CHECK(corners[0].normal == glm::vec3(0, 0, 1));
    CHECK(corners[1].normal == glm::vec3(1, 0, 0));
    CHECK(corners[2].normal == glm::vec3(1, 0, 0));  // short, but not zero
}

TEST_CASE("triangles without area are dropped, very small and very large ones are kept") {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1,      0, 0, 2, 0,      0,  //
                        0, 0, 0, 1e-30F, 0, 0, 0, 1e-30F, 0,  //
                        0, 0, 0, 1e30F,  0, 0, 0, 1e30F,  0,  //
                        1, 1, 1, 1,      1, 1, 2, 2,      2});
    const Imported imported(file);
    CHECK(imported.report.triangles == 2);
    for (const Vertex& corner : imported.corners()) {
        CHECK(corner.normal == glm::vec3(0, 0, 1));
    }
}

}  // TEST_SUITE("glTF geometry")

TEST_SUITE("glTF scenes") {
TEST_CASE("nodes become entities with names, transforms and parents") {
    GltfBuilder file = right_triangle();
    file.document["nodes"] = Json::parse(R"([
            {"name": "root", "children": [1, 2], "translation": [1, 2, 3], "scale": [2, 2, -2]},
            {"name": "turned", "rotation": [0, 0, 0.70710678, 0.70710678]},
            {"name": "by matrix", "matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1]}])");
    const Imported imported(file);
    REQUIRE(imported.report.entities.size() == 3);
    const Entity root = imported.find("root");
    CHECK(imported.world.get<Transform>(root).scale == glm::vec3(2, 2, -2));
    CHECK(imported.world.get<Transform>(imported.find("turned")).parent == root);
    const auto in_world = [&](const char* name, const glm::vec3& point) {
        return glm::vec3(world_matrix(imported.world, imported.find(name)) * glm::vec4(point, 1.0F));
    };
    // (1, 0, 0) rotated is (0, 1, 0), scaled and moved (1, 4, 3). Tolerance: the file's eight digits.
    CHECK(glm::distance(in_world("turned", {1, 0, 0}), glm::vec3(1, 4, 3)) < 1e-5F);
    // (1, 1, 1) is (-3, 2, 4) + (5, 6, 7) = (2, 8, 11) in the root.
    CHECK(glm::distance(in_world("by matrix", {1, 1, 1}), glm::vec3(5, 18, -19)) < 1e-4F);
}

TEST_CASE("roots that are below others, or listed twice, are there once, with a warning") {
    struct Case {
        const char* roots;
        std::vector<std::string> names;
        bool has_parent;  // the last of them
    };
    for (const Case& each : {Case{"[1]", {"low"}, false}, Case{"[1, 0]", {"high", "low"}, true},
                             Case{"[0, 1]", {"high", "low"}, true}, Case{"[0, 0]", {"high", "low"}, true},
                             Case{"[1, 1]", {"low"}, false}}) {
        CAPTURE(each.roots);
        GltfBuilder file = right_triangle();
        file.document["nodes"] = Json::parse(
            R"([{"name": "high", "translation": [1, 0, 0], "children": [1]}, {"name": "low", "mesh": 0}])");
        file.document["scenes"][0]["nodes"] = Json::parse(each.roots);
        const Imported imported(file);
        std::vector<std::string> names;
        for (const Entity entity : imported.report.entities) {
            names.push_back(imported.world.get<Name>(entity).value);
        }
        CHECK(names == each.names);
        const auto& last = imported.world.get<Transform>(imported.report.entities.back());
        CHECK((last.parent != Entity{}) == each.has_parent);
        CHECK(imported.report.warnings.size() == 1);
    }
}

TEST_CASE("a sheared matrix is kept exactly, for the node and for its children") {
    GltfBuilder file = right_triangle();
    file.document["nodes"] = Json::parse(R"([
            {"name": "sheared", "children": [1], "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 9, 8, 7, 1]},
            {"name": "child", "translation": [0, 2, 0]}])");
    const Imported imported(file);
    CHECK(imported.report.entities.size() == 3);
    const glm::vec3 origin = world_matrix(imported.world, imported.find("child"))[3];
    CHECK(glm::distance(origin, glm::vec3(10, 10, 7)) < 1e-5F);  // a few roundings of numbers near 10
}

TEST_CASE("only the default scene is imported, or the first if there is no default") {
    GltfBuilder file = right_triangle();
    file.document["nodes"] = Json::parse(R"([{"name": "a"}, {"name": "b"}])");
    file.document["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
    CHECK(Imported(file).find("a"));
    CHECK_FALSE(Imported(file).find("b"));
    file.document["scene"] = 1;
    CHECK_FALSE(Imported(file).find("a"));
    CHECK(Imported(file).find("b"));
}

TEST_CASE("instances share their mesh, meshes their material") {
    GltfBuilder file = right_triangle();
    file.document["materials"] = Json::parse(R"([{"name": "paint"}])");
    file.document["nodes"] = Json::parse(R"([{"mesh": 0, "children": [1]}, {"mesh": 0}])");
    file.primitive()["material"] = 0;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 1})["material"] = 0;
    const Imported imported(file);
    const auto& entities = imported.report.entities;
    CHECK(imported.world.get<MeshInstance>(entities[0]) == imported.world.get<MeshInstance>(entities[1]));
    CHECK(imported.mesh().primitives[0].material == imported.mesh().primitives[1].material);
    CHECK(imported.report.triangles == 4);
}

TEST_CASE("each instance of a node becomes an entity below the node's") {
    GltfBuilder file = right_triangle();
    file.document["nodes"] =
        Json::parse(R"([{"name": "tree", "mesh": 0, "translation": [10, 0, 0], "children": [1]},
                            {"name": "child", "translation": [0, 0, 1]}])");
    const std::size_t translations = file.add_vectors({1, 2, 3, 4, 5, 6});
    const std::size_t scales = file.add_vectors({1, 1, 1, 2, 2, 2});
    // None, and a quarter turn about z.
    const std::size_t rotations =
        file.add_accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170}, 5122, "VEC4", 4);
    file.document["accessors"][rotations]["normalized"] = true;
    file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}};
    file.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    file.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    CHECK(imported.report.triangles == 2);
    const std::vector<Entity>& entities = imported.report.entities;
    REQUIRE(entities.size() == 4);
    CHECK(imported.world.find<MeshInstance>(entities[0]) == nullptr);
    CHECK(imported.world.get<MeshInstance>(entities[1]) == imported.world.get<MeshInstance>(entities[2]));
    CHECK(imported.world.get<Name>(entities[1]).value == "tree");
    const auto in_world = [&](std::size_t entity, const glm::vec3& point) {
        return glm::vec3(world_matrix(imported.world, entities[entity]) * glm::vec4(point, 1.0F));
    };
    CHECK(in_world(1, {1, 0, 0}) == glm::vec3(12, 2, 3));
    // Scaled, turned, moved, and moved with the node. Tolerance: the rotation's 16 bits.
    CHECK(glm::distance(in_world(2, {1, 0, 0}), glm::vec3(14, 7, 6)) < 1e-4F);
    CHECK(in_world(3, {0, 0, 0}) == glm::vec3(10, 0, 1));
}

TEST_CASE("instances that do not go together or exceed the limit are refused") {
    GltfBuilder file = right_triangle();
    const std::size_t two = file.add_vectors({1, 2, 3, 4, 5, 6});
    const std::size_t three = file.add_vectors({1, 2, 3, 4, 5, 6, 7, 8, 9});
    Json& attributes = file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", two}, {"SCALE", three}};
    CHECK_THROWS_WITH_AS(Imported{file},
                         "test.gltf: node 0: its instances have 3 values of one attribute and 2 of another",
                         SceneError);
    attributes = {{"ROTATION", two}};
    CHECK_THROWS_WITH_AS(Imported{file},
                         "test.gltf: node 0: accessor 1 holds rotations, but is not VEC4 of FLOAT or of "
                         "normalised BYTE or SHORT",
                         SceneError);
    attributes = {{"TRANSLATION", two}};
    World world;
    ImportOptions options;
    options.limits.nodes = 3;
    CHECK(import_gltf(file.gltf(), {}, "test.gltf", world, options).entities.size() == 3);
    options.limits.nodes = 2;
    CHECK_THROWS_WITH_AS((void)import_gltf(file.gltf(), {}, "test.gltf", world, options),
                         "test.gltf: node 0: its nodes are 3, above the limit of 2 (nodes)", SceneError);
    // Zeros that no bytes of the file stand for.
    file.document["accessors"][two].erase("bufferView");
    file.document["accessors"][two]["count"] = 4'000'000;
    CHECK(throws<SceneError>([&] { Imported{file}; }, "(growth)"));
}

TEST_CASE("of materials with variants, the defaults are read") {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"KHR_materials_variants"};
    file.document["extensions"] =
        Json::parse(R"({"KHR_materials_variants": {"variants": [{"name": "red"}]}})");
    file.document["materials"] = Json::parse(R"([{"name": "plain"}, {"name": "red"}])");
    file.primitive()["material"] = 0;
    file.primitive()["extensions"] =
        Json::parse(R"({"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}})");
    const Imported imported(file);
    CHECK(imported.primitive().material->name == "plain");
    CHECK(imported.report.warnings.empty());
}

TEST_CASE("the previous content of the world stays") {
    World world;
    const Entity before = world.create();
    world.set(before, Name{"before"});
    const ImportReport report = import_gltf(right_triangle().gltf(), {}, "test.gltf", world);
    CHECK(world.size() == 2);
    CHECK(world.get<Name>(before).value == "before");
    CHECK(world.alive(report.entities[0]));
}

TEST_CASE("lights have the extension's values and defaults") {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"KHR_lights_punctual"};
    file.document["extensionsRequired"] = {"KHR_lights_punctual"};
    file.document["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
            {"type": "point"},
            {"type": "point", "color": [1, 0.5, 0.25], "intensity": 20, "range": 3},
            {"type": "spot", "spot": {}},
            {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 1.57079632679}, "range": 9},
            {"type": "directional", "intensity": 3, "color": [0, 0, 1]}])");
    file.document["nodes"] = Json::array();
    file.document["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    for (int i = 0; i < 5; ++i) {
        file.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    }
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    const World& world = imported.world;
    const std::vector<Entity>& entities = imported.report.entities;
    CHECK(world.get<PointLight>(entities[0]) == PointLight{});
    CHECK(world.get<PointLight>(entities[1]) == PointLight{{1, 0.5F, 0.25F}, 20.0F, 3.0F});
    CHECK(world.get<SpotLight>(entities[2]) == SpotLight{});
    SpotLight wide;
    wide.range = 9.0F;
    wide.inner_cone = 0.1F;
    wide.outer_cone = 1.57079632679F;
    CHECK(world.get<SpotLight>(entities[3]) == wide);
    CHECK(world.get<DirectionalLight>(entities[4]) == DirectionalLight{{0, 0, 1}, 3.0F});
}

TEST_CASE("cameras of both kinds") {
    GltfBuilder file = right_triangle();
    file.document["cameras"] = Json::parse(R"([
            {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25, "aspectRatio": 2}},
            {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25, "zfar": 100}},
            {"type": "orthographic", "name": "plan", "orthographic": {"xmag": 9, "ymag": 3, "znear": 0, "zfar": 8}}])");
    file.document["nodes"] =
        Json::parse(R"([{"camera": 0, "children": [1, 2]}, {"camera": 1}, {"camera": 2}])");
    const Imported imported(file);
    const auto camera = [&](std::size_t i) {
        return imported.world.get<Camera>(imported.report.entities[i]);
    };
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(camera(0) == Camera{Camera::Projection::perspective, 0.5F, 1.0F, 0.25F, infinity});
    CHECK(camera(1) == Camera{Camera::Projection::perspective, 0.5F, 1.0F, 0.25F, 100.0F});
    CHECK(camera(2).projection == Camera::Projection::orthographic);
    CHECK(camera(2).half_height == 3.0F);
    CHECK(camera(2).near_plane == 0.0F);
    CHECK(camera(2).far_plane == 8.0F);
    CHECK(imported.find("plan") ==
          imported.report.entities[2]);  // a node without a name gets that of its camera
}

TEST_CASE("unsupported extensions that are used but not required are reported once each") {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"EXT_texture_avif", "KHR_lights_punctual", "EXT_texture_avif"};
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{"the extension EXT_texture_avif is not supported and is ignored"});
}

TEST_CASE("what a required extension that is not supported does not hold is read") {
    GltfBuilder file = right_triangle();
    file.document["extensionsRequired"] = {"EXT_unknown"};
    file.document["extensionsUsed"] = {"EXT_unknown"};
    const std::string warning =
        "it requires the extension EXT_unknown, which is not supported: what is shown may be wrong";
    CHECK(Imported(file).report.triangles == 1);
    CHECK(Imported(file).report.warnings == std::vector<std::string>{warning});

    // Positions and indices that the extension holds are not taken for zeros.
    Json& hidden = file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0});
    file.document["accessors"].back().erase("bufferView");
    hidden["extensions"]["EXT_unknown"] = Json::object();
    CHECK(Imported(file).report.triangles == 1);
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{warning, "primitives whose data EXT_unknown holds are skipped"});
    hidden.erase("extensions");
    hidden["attributes"]["POSITION"] = 0;
    hidden["indices"] = file.add("accessors", {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    CHECK(
        Imported(file).report.warnings ==
        std::vector<std::string>{warning, "primitives whose positions or indices have no data are skipped"});
}

}  // TEST_SUITE("glTF scenes")
