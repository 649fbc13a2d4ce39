#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/engine/malformed_gltf.hpp"

TEST_SUITE("malformed glTF") {

using namespace candela;
using namespace candela::test;

TEST_CASE("the complete scene itself is valid") {
    CHECK(error_of(complete_scene()) == "imported");
    CHECK(error_of(complete_scene().glb()) == "imported");
}

TEST_CASE("references to missing elements, including negative ones") {
    check_defects({
        {"/nodes/0/mesh", "1", "@ is 1, but there are 1 meshes"},
        {"/nodes/0/mesh", "-1", "@ is -1, but there are 1 meshes"},
        {"/nodes/0/mesh", "\"0\"", "@ is not an index"},
        {"/nodes/0/mesh", "4294967296", "@ is 4294967296, but there are 1 meshes"},
        {"/nodes/0/camera", "2", "@ is 2, but there are 2 cameras"},
        {"/nodes/0/children/1", "3", "@ is 3, but there are 3 nodes"},
        {"/nodes/0/extensions/KHR_lights_punctual/light", "-2", "@ is -2, but there are 1 lights"},
        {"/scenes/0/nodes/0", "9", "@ is 9, but there are 3 nodes"},
        {"/scene", "1", "@ is 1, but there are 1 scenes"},
        {"/meshes/0/primitives/0/material", "5", "@ is 5, but there are 1 materials"},
        {"/meshes/0/primitives/0/indices", "99", "@ is 99, but there are 4 accessors"},
        {"/meshes/0/primitives/0/attributes/NORMAL", "4", "@ is 4, but there are 4 accessors"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1", "@ is 1, but there are 1 textures"},
        {"/materials/0/normalTexture/index", "-1", "@ is -1, but there are 1 textures"},
        {"/textures/0/source", "1", "@ is 1, but there are 1 images"},
        {"/textures/0/sampler", "1", "@ is 1, but there are 1 samplers"},
        {"/accessors/2/bufferView", "6", "@ is 6, but there are 6 buffer views"},
        {"/accessors/0/sparse/indices/bufferView", "6", "@ is 6, but there are 6 buffer views"},
        {"/accessors/0/sparse/values/bufferView", "-1", "@ is -1, but there are 6 buffer views"},
        {"/bufferViews/1/buffer", "1", "@ is 1, but there are 1 buffers"},
    });
}

TEST_CASE("accessors and buffer views that do not fit") {
    check_defects({
        {"/accessors/1/byteOffset", "2", "mesh 0: accessor 1 reads past the end of buffer view 1"},
        {"/accessors/1/count", "6", "mesh 0: accessor 1 reads past the end of buffer view 1"},
        {"/accessors/0/count", "4000000000", "mesh 0: accessor 0 reads past the end of buffer view 0"},
        {"/accessors/0/count", "18446744073709551615", "@ is 18446744073709551615, which is out of range"},
        {"/accessors/0/count", "0", "@ is 0, which is out of range"},
        {"/accessors/0/byteOffset", "9223372036854775807",
         "mesh 0: accessor 0 reads past the end of buffer view 0"},
        {"/accessors/1/byteOffset", "-2", "@ is -2, which is out of range"},
        {"/bufferViews/0/byteLength", "9223372036854775807",
         "mesh 0: buffer view 0 reads past the end of buffer 0"},
        {"/bufferViews/0/byteOffset", "9223372036854775807",
         "mesh 0: buffer view 0 reads past the end of buffer 0"},
        {"/bufferViews/0/byteOffset", "1", "mesh 0: accessor 0 is not aligned to its components of 4 bytes"},
        {"/bufferViews/0/byteStride", "8",
         "mesh 0: accessor 0 has elements of 12 bytes, more than the stride of 8 of buffer view 0"},
        {"/bufferViews/0/byteStride", "13", "@ is 13, not a multiple of 4"},
        {"/bufferViews/0/byteStride", "256", "@ is 256, which is out of range"},
        {"/bufferViews/0/byteStride", "16", "mesh 0: accessor 0 reads past the end of buffer view 0"},
        {"/bufferViews/0/byteLength", "", "^ has no \"byteLength\""},
        {"/accessors/0/count", "", "^ has no \"count\""},
        {"/accessors/0/sparse/count", "2",
         "mesh 0: accessor 0 (its sparse indices) reads past the end of buffer view 4"},
        {"/accessors/0/sparse/count", "-1", "@ is -1, which is out of range"},
        {"/accessors/0/sparse/values/byteOffset", "4",
         "mesh 0: accessor 0 (its sparse values) reads past the end of buffer view 5"},
        {"/accessors/0/sparse/indices/componentType", "5126",
         "mesh 0: accessor 0 has sparse indices that are not unsigned integers"},
        {"/accessors/0/sparse/indices/bufferView", "5",
         "mesh 0: accessor 0 has a sparse index out of its 3 elements"},
    });
}

TEST_CASE("a huge accessor of zeros is not allocated") {
    GltfBuilder file = complete_scene();
    file.document["accessors"][0].erase("bufferView");
    file.document["accessors"][0]["count"] = 4'000'000'000;
    file.primitive()["attributes"].erase("NORMAL");
    CHECK(error_of(file) == "mesh 0: it has 4000000000 positions, but 3 texture coordinates");
    file.primitive().erase("indices");
    CHECK(error_of(file) ==
          "mesh 0: it has 4000000000 indices or vertices, which make no whole number of triangles");
    file.document["accessors"][0]["count"] = 3'999'999'999;
    CHECK(error_of(file) ==
          "mesh 0: the triangles of its meshes are 1,333,333,333, above the limit of 16,777,216 "
          "(triangles)");
}

TEST_CASE("types that geometry cannot have") {
    check_defects({
        {"/accessors/0/type", "\"VEC2\"", "mesh 0: accessor 0 holds positions, but is not VEC3 of FLOAT"},
        {"/accessors/2/componentType", "5120", "mesh 0: accessor 2 holds normals, but is not VEC3 of FLOAT"},
        {"/accessors/1/componentType", "5126",
         "mesh 0: accessor 1 holds indices, but is not SCALAR of an unsigned integer"},
        {"/accessors/1/type", "\"VEC3\"",
         "mesh 0: accessor 1 holds indices, but is not SCALAR of an unsigned integer"},
        {"/accessors/3/componentType", "5123",
         "mesh 0: accessor 3 holds texture coordinates, but is not VEC2 of FLOAT or of normalised "
         "UNSIGNED_BYTE or UNSIGNED_SHORT"},
        {"/accessors/3/type", "\"SCALAR\"",
         "mesh 0: accessor 3 holds texture coordinates, but is not VEC2 of FLOAT or of normalised "
         "UNSIGNED_BYTE or UNSIGNED_SHORT"},
        {"/accessors/3/count", "2", "mesh 0: it has 3 positions, but 2 texture coordinates"},
        {"/accessors/2/count", "1", "mesh 0: it has 3 positions, but 1 normals"},
        {"/accessors/1/count", "2",
         "mesh 0: it has 2 indices or vertices, which make no whole number of triangles"},
        {"/meshes/0/primitives/0/mode", "7", "@ is 7, which is out of range"},
        {"/meshes/0/primitives/0/attributes", "", "^ has no \"attributes\""},
        {"/meshes/0/primitives", "{}", "@ is not an array"},
        {"/accessors/0/componentType", "7", "@ is 7, which is out of range"},
        {"/accessors/0/type", "\"VEC5\"",
         R"(@ is "VEC5", not one of ["SCALAR","VEC2","VEC3","VEC4","MAT2","MAT3","MAT4"])"},
    });
}

TEST_CASE("an index beyond the vertices") {
    GltfBuilder file = right_triangle();
    file.primitive()["indices"] = file.add_indices({0, 1, 3});
    CHECK(error_of(file) == "mesh 0: accessor 1 has an index beyond the 3 vertices in element 2");
}

TEST_CASE("four vertices without indices") {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    CHECK(error_of(file) == "mesh 0: it has 4 indices or vertices, which make no whole number of triangles");
}

TEST_CASE("NaN and infinity") {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
        GltfBuilder positions;
        positions.add_primitive({0, 0, 0, 1, bad, 0, 0, 1, 0});
        CHECK(error_of(positions) == "mesh 0: accessor 0 has a NaN or infinity in element 1");

        GltfBuilder normals = right_triangle();
        normals.primitive()["attributes"]["NORMAL"] = normals.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, bad});
        CHECK(error_of(normals) == "mesh 0: accessor 1 has a NaN or infinity in element 2");

        GltfBuilder coordinates = right_triangle();
        coordinates.primitive()["attributes"]["TEXCOORD_0"] =
            coordinates.add_accessor(std::vector<float>{bad, 0, 0, 0, 0, 0}, 5126, "VEC2", 2);
        CHECK(error_of(coordinates) == "mesh 0: accessor 1 has a NaN or infinity in element 0");
    }
    check_defects({
        {"/nodes/0/translation/1", "1e39", "^ holds a member that is 1e+39, which is out of range"},
        {"/nodes/2/matrix/0", "-1e300", "^ holds a member that is -1e+300, which is out of range"},
        {"/nodes/2/matrix", "[3e38,3e38,0,0, -3e38,3e38,0,0, 0,0,1,0, 0,0,0,1]",
         "node 2: its transform overflows"},
    });
    const std::string text = R"({"asset": {"version": "2.0"}, "nodes": [{"scale": [1, 1e999, 1]}]})";
    CHECK(error_of(to_bytes(text)).starts_with("invalid JSON: number overflow"));
}

TEST_CASE("transforms") {
    check_defects({
        {"/nodes/0/translation", "[1, 2]", "@ is not 3 numbers"},
        {"/nodes/0/rotation", "[0, 0, 1]", "@ is not 4 numbers"},
        {"/nodes/0/rotation", "[0, 0, 0, 0]", "node 0: its rotation is zero"},
        {"/nodes/0/scale", "\"big\"", "@ is not 3 numbers"},
        {"/nodes/0/scale", "[1, true, 1]", "@ holds a member that is not a number"},
        {"/nodes/2/matrix", "[1, 2, 3]", "@ is not 16 numbers"},
        {"/nodes/2/matrix/3", "1", "node 2: its matrix does not end in a row of 0 0 0 1"},
        {"/nodes/0/scale", "[0, 0, 0]", "imported"},
        {"/nodes/2/matrix", "[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]", "imported"},
    });
}

TEST_CASE("hierarchies that are not trees") {
    check_defects({
        {"/nodes/1/children", "[2]", "node 2 has two parents, nodes 0 and 1"},
        {"/nodes/0/children", "[1, 1]", "node 1 has two parents, nodes 0 and 0"},
        {"/nodes/0/children", "[0]", "node 0 is its own ancestor or has one that is"},
        {"/nodes/1/children", "[0]", "node 0 is its own ancestor or has one that is"},
        {"/scenes", "", "scene is 0, but there are 0 scenes"},
        {"/scenes", "{}", "@ is not an array"},
        {"/nodes", "[1]", "nodes[0] is not an object"},
    });
    GltfBuilder file = complete_scene();
    file.document.erase("scene");
    file.document.erase("scenes");
    CHECK(error_of(file) == "it has no scene");
}

TEST_CASE("lights and cameras with values out of range") {
    check_defects({
        {"/extensions/KHR_lights_punctual/lights/0/intensity", "-1", "@ is -1, which is out of range"},
        {"/extensions/KHR_lights_punctual/lights/0/range", "0", "@ is 0, which is out of range"},
        {"/extensions/KHR_lights_punctual/lights/0/color", "[1, 1]", "@ is not 3 numbers"},
        {"/extensions/KHR_lights_punctual/lights/0/color/0", "2",
         "^ holds a member that is 2, which is out of range"},
        {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "0.2",
         "light 0: its inner cone of 0.2 is not inside its outer cone of 0.2"},
        {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "2",
         "@ is 2, which is out of range"},
        {"/extensions/KHR_lights_punctual/lights/0/spot", "", "^ has no \"spot\""},
        {"/extensions/KHR_lights_punctual/lights/0/type", "\"lava\"",
         "light 0 has the unknown type \"lava\""},
        {"/extensions/KHR_lights_punctual/lights", "7", "@ is not an array"},
        {"/cameras/0/perspective/yfov", "0", "@ is 0, which is out of range"},
        {"/cameras/0/perspective/yfov", "3.2", "@ is 3.2, which is out of range"},
        {"/cameras/0/perspective/znear", "0", "@ is 0, which is out of range"},
        {"/cameras/0/perspective/zfar", "0.5", "camera 0: its zfar of 0.5 is not beyond its znear of 1"},
        {"/cameras/0/perspective", "", "^ has no \"perspective\""},
        {"/cameras/1/orthographic/ymag", "0", "@ is 0, which is out of range"},
        {"/cameras/1/orthographic/zfar", "1", "camera 1: its zfar of 1 is not beyond its znear of 1"},
        {"/cameras/1/orthographic/zfar", "", "^ has no \"zfar\""},
    });
}

TEST_CASE("materials and images") {
    check_defects({
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1]", "@ is not 4 numbers"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor/2", "1.5",
         "^ holds a member that is 1.5, which is out of range"},
        {"/materials/0/doubleSided", "1", "@ is not true or false"},
        {"/materials/0/alphaMode", "\"GLASS\"", R"(@ is "GLASS", not one of ["OPAQUE","MASK","BLEND"])"},
        {"/materials/0/alphaMode", "2", R"(@ is 2, not one of ["OPAQUE","MASK","BLEND"])"},
        {"/materials/0/alphaCutoff", "-0.1", "@ is -0.1, which is out of range"},
        {"/materials/0/alphaCutoff", "\"half\"", "@ is not a number"},
        {"/materials/0/pbrMetallicRoughness/metallicFactor", "2", "@ is 2, which is out of range"},
        {"/materials/0/pbrMetallicRoughness/roughnessFactor", "\"rough\"", "@ is not a number"},
        {"/materials/0/extensions/KHR_materials_ior/ior", "0.5", "@ is 0.5, which is out of range"},
        {"/materials/0/extensions/KHR_materials_specular/specularFactor", "1.5",
         "@ is 1.5, which is out of range"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset", "[1]",
         "@ is not 2 numbers"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation",
         "\"half\"", "@ is not a number"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/texCoord", "-1",
         "@ is -1, which is out of range"},
        {"/materials/0/emissiveFactor/1", "-0.5", "^ holds a member that is -0.5, which is out of range"},
        {"/materials/0/emissiveFactor/1", "1e39", "^ holds a member that is 1e+39, which is out of range"},
        {"/materials/0/emissiveTexture/index", "7", "@ is 7, but there are 1 textures"},
        {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "-1",
         "@ is -1, which is out of range"},
        {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "\"bright\"",
         "@ is not a number"},
        {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "1e39",
         "@ is 1e+39, which is out of range"},
        {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "3e38",
         "material 0: its emission is too large"},
        {"/samplers/0/wrapS", "1", "@ is 1, not one of [10497,33071,33648]"},
        {"/images/0", "{\"bufferView\": 6}", "images[0].bufferView is 6, but there are 6 buffer views"},
        {"/images/0/uri", "\"../nowhere.png\"",
         "image 0: ../nowhere.png is outside of the folder that files are read from"},
        {"/images/0/uri", "\"a\\u0000.png\"", "image 0: a\\x00.png contains a NUL character"},
    });
}

TEST_CASE("an image that cannot be read is one warning, whatever uses it") {
    const auto warnings_of = [](const std::string& image) {
        GltfBuilder file = complete_scene();
        file.document["images"][0] = Json::parse(image);
        return Imported(file).report.warnings;
    };
    const auto check_warning = [&](const std::string& image, const std::string& fault) {
        CAPTURE(image);
        CHECK(warnings_of(image) ==
              std::vector<std::string>{"image 0: " + fault + "; a checker pattern takes its place"});
    };
    check_warning("{}", R"(it needs either a "uri" or a "bufferView")");
    check_warning(R"({"uri": "a.png", "bufferView": 0})", R"(it needs either a "uri" or a "bufferView")");
    check_warning(R"({"uri": "nowhere.png"})", "nowhere.png does not exist");
    check_warning(R"({"uri": "\u001B[2J.png"})", "\\x1B[2J.png does not exist");
    check_warning(R"({"uri": "."})", ". is not a file");
    check_warning(R"({"uri": "data:image/png;base64,"})",
                  "the data URI data:image/png;base64,... is empty or of an unknown kind");
    check_warning(R"({"uri": "data:image/png;base64,AAAA"})", "it is neither PNG, JPEG nor WebP");
    check_warning(R"({"uri": "data:image/png;base64,AAAA", "name": "rock"})",
                  "rock: it is neither PNG, JPEG nor WebP");
    check_warning(R"({"uri": "data:image/png;base64,iVBORw0KGgo="})", "it is cut short");
    check_warning(
        R"({"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR42mP4/7+B"})",
        "it is cut short");
    check_warning(R"({"bufferView": 0})", "it is neither PNG, JPEG nor WebP");
}

TEST_CASE("an image that declares more pixels than its bytes can hold is not allocated") {
    const Bytes png{0x89, 'P',  'N', 'G', 13,  10,  26,  10,  //
                    0,    0,    0,   13,  'I', 'H', 'D', 'R', 0,    0,    0x40, 0,    0,
                    0,    0x40, 0,   8,   6,   0,   0,   0,   0xA9, 0xC8, 0x10, 0x84,  // and data of 0 bytes
                    0,    0,    0,   0,   'I', 'D', 'A', 'T', 0,    0,    0,    0};
    GltfBuilder file = complete_scene();
    file.document["images"][0]["uri"] = "data:image/png;base64," + base64(png);
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{"image 0: its 45 bytes cannot hold 16384 x 16384 pixels; "
                                   "a checker pattern takes its place"});
}

TEST_CASE("buffers") {
    GltfBuilder file = right_triangle();
    const auto with_buffer = [&](const Json& buffer) {
        file.document["buffers"] = Json::array();
        file.document["buffers"].push_back(buffer);
        return error_of(to_bytes(file.document.dump()));
    };
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "nowhere.bin"}}) ==
          "buffer 0: nowhere.bin does not exist");
    CHECK(with_buffer({{"byteLength", 36}, {"uri", "."}}) == "buffer 0: . is not a file");
    CHECK(with_buffer({{"byteLength", 36}}) == "buffer 0: it has neither a \"uri\" nor a binary chunk");
    CHECK(with_buffer(
              {{"byteLength", 37}, {"uri", "data:application/octet-stream;base64," + base64(file.data)}}) ==
          "buffer 0: it has 36 of the 37 bytes it declares");
    CHECK(with_buffer({{"byteLength", 4e18}, {"uri", "nowhere.bin"}}) ==
          "buffers[0].byteLength is not a whole number");
    CHECK(with_buffer({{"byteLength", -1}, {"uri", "nowhere.bin"}}) ==
          "buffers[0].byteLength is -1, which is out of range");
    CHECK(with_buffer({{"uri", "nowhere.bin"}}) == "buffers[0] has no \"byteLength\"");
    CHECK(with_buffer({{"byteLength", 3}, {"uri", "data:text/html,abc"}}) ==
          "buffer 0: the data URI data:text/html,abc... is empty or of an unknown kind");
}

TEST_CASE("versions and extensions") {
    check_defects({
        {"/asset", "", "it has no \"asset\", so it is not glTF 2.0"},
        {"/asset/version", "", "^ has no \"version\""},
        {"/asset/version", "\"1.0\"", "@ is \"1.0\"; only 2.0 is read"},
        {"/extensionsRequired", "[3]", "extensionsRequired[0] is not a string"},
        {"/extensionsUsed", "[3]", "extensionsUsed[0] is not a string"},
    });
}

TEST_CASE("files that are not glTF") {
    CHECK(error_of(Bytes{}) == "the file is empty");
    CHECK(
        error_of(to_bytes("{\n\"asset\" 2}")).starts_with("invalid JSON: parse error at line 2, column 9: "));
    CHECK(error_of(to_bytes("{")).starts_with("invalid JSON: parse error"));
    CHECK(error_of(to_bytes("gl")).starts_with("invalid JSON: parse error"));
    CHECK(error_of(to_bytes("[]")) == "the document is not a JSON object");
    CHECK(error_of(to_bytes("null")) == "the document is not a JSON object");
    CHECK(error_of(to_bytes("{\"asset\": \"\xFF\"}")).starts_with("invalid JSON: parse error"));
    CHECK(error_of(to_bytes("{\"extras\": " + std::string(1'000'000, '['))) ==
          "its JSON is nested too deeply");
}

TEST_CASE("files that cannot be opened") {
    World world;
    CHECK_THROWS_WITH_AS((void)import_gltf("nowhere/at all.gltf", world),
                         "nowhere/at all.gltf: the file does not exist", SceneError);
    CHECK_THROWS_WITH_AS((void)import_gltf("/", world), "/: the file is not a file", SceneError);
}

TEST_CASE("a .glb that is cut off at any byte, or has wrong headers") {
    const Bytes whole = complete_scene().glb();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        CAPTURE(size);
        CHECK(error_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))) !=
              "imported");
    }
    const auto with_u32 = [&](std::size_t offset, std::uint32_t value) {
        Bytes changed = whole;
        std::memcpy(changed.data() + offset, &value, 4);
        return error_of(changed);
    };
    const std::size_t binary = 20 + std::size_t{whole[12]} + std::size_t{whole[13]} * 256;
    CHECK(with_u32(4, 1) == "the .glb has version 1; only 2 is read");
    CHECK(with_u32(8, 8) ==
          "the .glb says it has 8 bytes, but " + std::to_string(whole.size()) + " are there");
    CHECK(with_u32(12, 0xFFFFFFFF) == "the .glb ends inside a chunk");
    CHECK(with_u32(16, 0) == "the .glb lacks its JSON chunk");
    CHECK(with_u32(binary, 0xFFFFFFFF) == "the .glb ends inside a chunk");
    CHECK(with_u32(binary, 8) ==
          "buffer 0: it has 8 of the " + std::to_string(complete_scene().data.size()) + " bytes it declares");
    CHECK(with_u32(binary + 4, 0) == "the .glb lacks its BIN chunk");
}

TEST_CASE("strings from the file do not break a message into several lines") {
    const std::string name = "_\n\r\x7F" + std::string(10'000, 'x');
    GltfBuilder file = complete_scene();
    file.document["extensionsRequired"] = {name};
    const Imported imported(file);
    REQUIRE(imported.report.warnings.size() == 1);
    CHECK(imported.report.warnings[0].starts_with("it requires the extension _\\x0A\\x0D\\x7Fxxx"));
    file.document["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = name;
    CHECK(error_of(file).starts_with("light 0 has the unknown type \"_\\x0A\\x0D\\x7Fxxx"));
}

}  // TEST_SUITE("malformed glTF")
