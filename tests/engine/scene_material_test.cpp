#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/engine/malformed_gltf.hpp"

TEST_SUITE("glTF materials") {

using namespace candela;
using namespace candela::test;

namespace {

using Texels = std::vector<glm::u8vec4>;

const Texels four_colours{{255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 0}, {10, 20, 30, 40}};

Bytes png(const Texels& texels, int width, int height) {
    Bytes bytes;
    stbi_write_png_to_func(append, &bytes, width, height, 4, texels.data(), width * 4);
    return bytes;
}

/// 8 × 8 pixels of one colour.
Bytes jpeg(const glm::u8vec4& colour) {
    Bytes bytes;
    const Texels texels(64, colour);
    stbi_write_jpg_to_func(append, &bytes, 8, 8, 4, texels.data(), 100);
    return bytes;
}

/// A triangle whose material's base colour is texture 0, of image 0.
GltfBuilder textured(const Json& image) {
    GltfBuilder file = right_triangle();
    file.primitive()["material"] = 0;
    file.document["materials"] =
        Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.add("images", image);
    return file;
}

Json data_uri(const Bytes& image) {
    return {{"uri", "data:image/png;base64," + base64(image)}};
}

bool is_rough_metal(const Material& material) {
    return material.metalness == 1.0F && material.roughness == 1.0F && material.specular == 1.0F &&
           material.ior == 1.5F;
}

/// A triangle that faces +Z, with normals, texture coordinates whose u grows along +X and whose v grows along
/// -Y, and a normal texture.
GltfBuilder bumpy() {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    Json attributes = file.primitive()["attributes"];
    attributes["NORMAL"] = file.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes["TEXCOORD_0"] = file.add_accessor(std::vector<float>{0, 1, 1, 1, 0, 0}, 5126, "VEC2", 2);
    file.primitive()["attributes"] = std::move(attributes);
    file.document["materials"] = Json::parse(R"([{"normalTexture": {"index": 0}}])");
    return file;
}

std::vector<glm::i16vec4> tangents_of(const Imported& imported) {
    std::vector<glm::i16vec4> tangents;
    for (const Vertex& vertex : imported.primitive().vertices) {
        tangents.push_back(vertex.tangent);
    }
    return tangents;
}

/// Both colours of the checker and nothing else, as many texels of each.
bool is_checker(const Image& image) {
    const auto magenta = std::ranges::count(image.texels, glm::u8vec4(255, 0, 255, 255));
    const auto black = std::ranges::count(image.texels, glm::u8vec4(0, 0, 0, 255));
    return magenta > 0 && magenta == black &&
           static_cast<std::size_t>(magenta + black) == image.texels.size() &&
           image.texels.size() == std::size_t{image.width} * image.height;
}

const Image& texture_of(const Imported& imported) {
    return *imported.primitive().material->base_colour_texture;
}

}  // namespace

TEST_CASE("an unlit material emits its base colour and reflects nothing") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.document["extensionsUsed"] = {"KHR_materials_unlit"};
    Json& source = file.document["materials"][0];
    source["extensions"]["KHR_materials_unlit"] = Json::object();
    source["emissiveFactor"] = {1, 1, 1};
    source["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.2, 0.3, 0.4};
    const Imported imported(file);
    const Material& material = *imported.primitive().material;
    CHECK(material.emissive == glm::vec3(0.1F, 0.2F, 0.3F));
    CHECK(material.emissive_texture == material.base_colour_texture);
    CHECK(material.base_colour_texture != nullptr);
    CHECK(material.base_colour == glm::vec4(0.0F, 0.0F, 0.0F, 0.4F));
    CHECK(imported.report.warnings.empty());
}

TEST_CASE("factors, sidedness and name") {
    GltfBuilder file = right_triangle();
    file.primitive()["material"] = 0;
    file.document["materials"] = Json::parse(R"([{"name": "paint", "doubleSided": true,
            "emissiveFactor": [1, 0.5, 0.25], "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4]}}])");
    const Imported imported(file);
    const Material& material = *imported.primitive().material;
    CHECK(material.name == "paint");
    CHECK(material.base_colour == glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    CHECK(material.emissive == glm::vec3(1.0F, 0.5F, 0.25F));
    CHECK(material.double_sided);
    CHECK(material.base_colour_texture == nullptr);
    CHECK(imported.report.warnings.empty());
}

TEST_CASE("emission: strength, texture, and textures that cannot be used") {
    GltfBuilder file = right_triangle();
    file.primitive()["material"] = 0;
    file.document["extensionsUsed"] = Json::parse(R"(["KHR_materials_emissive_strength"])");
    file.document["images"][0] = data_uri(png(four_colours, 2, 2));
    file.document["textures"] = Json::parse(R"([{"source": 0}, {}])");
    const auto set_material = [&](const char* emission) {
        file.document["materials"] = Json::array({Json::parse(emission)});
    };
    set_material(R"({"emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0},
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 20}}})");
    {
        const Imported imported(file);
        const Material& material = *imported.primitive().material;
        CHECK(material.emissive == glm::vec3(20.0F, 10.0F, 0.0F));
        REQUIRE(material.emissive_texture != nullptr);
        CHECK(material.emissive_texture->width == 2);
        CHECK(imported.report.warnings.empty());
    }
    // A texture alone emits nothing: the factor is 0 by default.
    set_material(R"({"emissiveTexture": {"index": 0}})");
    CHECK(Imported(file).primitive().material->emissive_texture == nullptr);

    set_material(R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1}})");
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{"texture 1: it has no PNG, JPEG or WebP image; it is taken to be black"});
}

TEST_CASE("texture transforms move the texture coordinates") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_accessor(std::vector<float>{0, 0, 1, 0, 0.25F, 1}, 5126, "VEC2", 2);
    file.document["extensionsUsed"] = Json::parse(R"(["KHR_texture_transform"])");
    const auto transform = [&](const char* json) {
        file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
            {"KHR_texture_transform", Json::parse(json)}};
        const Imported imported(file);
        CHECK(imported.report.warnings.empty());
        std::vector<glm::vec2> uvs;
        for (const Vertex& vertex : imported.primitive().vertices) {
            uvs.push_back(vertex.uv);
        }
        return uvs;
    };
    const std::vector<glm::vec2> plain = transform("{}");
    const auto check = [&](const char* json, auto expected) {
        const std::vector<glm::vec2> moved = transform(json);
        REQUIRE(moved.size() == plain.size());
        for (std::size_t i = 0; i < plain.size(); ++i) {
            CHECK(glm::length(moved[i] - expected(plain[i])) < 1e-6F);
        }
    };
    check(R"({"offset": [0.25, -1]})", [](glm::vec2 uv) { return uv + glm::vec2(0.25F, -1.0F); });
    check(R"({"scale": [2, 3]})", [](glm::vec2 uv) { return uv * glm::vec2(2.0F, 3.0F); });
    // A quarter turn counter-clockwise, with v pointing down: (1, 0) becomes (0, -1).
    check(R"({"rotation": 1.5707963267948966})", [](glm::vec2 uv) { return glm::vec2(uv.y, -uv.x); });
    // Scaled first, moved last.
    check(R"({"rotation": 1.5707963267948966, "scale": [2, 3], "offset": [0.5, 0]})",
          [](glm::vec2 uv) { return glm::vec2(3.0F * uv.y + 0.5F, -2.0F * uv.x); });
}

TEST_CASE("textures of one material may have two kinds of coordinates") {
    const std::vector<float> set_0{0, 0, 1, 0, 0.25F, 1};
    const std::vector<float> set_1{0.5F, 0, 0.75F, 0.125F, 0, 0.5F};
    const auto imported_with = [&](const char* material) {
        GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
        file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor(set_0, 5126, "VEC2", 2);
        file.primitive()["attributes"]["TEXCOORD_1"] = file.add_accessor(set_1, 5126, "VEC2", 2);
        file.document["extensionsUsed"] = Json::parse(R"(["KHR_texture_transform"])");
        file.document["materials"] = Json::array({Json::parse(material)});
        return Imported(file);
    };
    const auto has_uvs = [](const Primitive& primitive, const std::vector<float>& expected) {
        for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
            if (primitive.vertices[i].uv != glm::vec2(expected[2 * i], expected[2 * i + 1])) return false;
        }
        return 2 * primitive.vertices.size() == expected.size();
    };
    const auto has_second = [](const Primitive& primitive, const std::vector<float>& expected) {
        std::vector<float> flat;
        for (const glm::vec2 uv : primitive.second_uvs) flat.insert(flat.end(), {uv.x, uv.y});
        return flat == expected;
    };

    // Occlusion by the second set.
    {
        const Imported imported = imported_with(R"({
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
                "occlusionTexture": {"index": 0, "texCoord": 1}})");
        CHECK(imported.report.warnings.empty());
        CHECK(has_uvs(imported.primitive(), set_0));
        CHECK(has_second(imported.primitive(), set_1));
        CHECK(imported.primitive().material->second_uvs == SecondUvUse{.occlusion = true});
    }
    // All by the second set: no other coordinates are needed.
    {
        const Imported imported = imported_with(R"({
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}},
                "occlusionTexture": {"index": 0, "texCoord": 1}})");
        CHECK(imported.report.warnings.empty());
        CHECK(has_uvs(imported.primitive(), set_1));
        CHECK(imported.primitive().second_uvs.empty());
        CHECK_FALSE(uses_second_uvs(*imported.primitive().material));
    }
    // The extension's set replaces that of the textureInfo, and its transform is that of this texture.
    {
        const Imported imported = imported_with(R"({
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                "emissiveFactor": [1, 1, 1],
                "emissiveTexture": {"index": 0, "texCoord": 0, "extensions":
                    {"KHR_texture_transform": {"texCoord": 1, "scale": [2, 4], "offset": [1, 0.5]}}}})");
        CHECK(imported.report.warnings.empty());
        CHECK(has_uvs(imported.primitive(), set_0));
        CHECK(has_second(imported.primitive(), {2, 0.5F, 2.5F, 1, 1, 2.5F}));
        CHECK(imported.primitive().material->second_uvs == SecondUvUse{.emissive = true});
    }
    // Two transforms of one set.
    {
        const Imported imported = imported_with(R"({
                "pbrMetallicRoughness": {
                    "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}},
                    "metallicRoughnessTexture": {"index": 0}}})");
        CHECK(imported.report.warnings.empty());
        CHECK(has_uvs(imported.primitive(), {0, 0, 2, 0, 0.5F, 2}));
        CHECK(has_second(imported.primitive(), set_0));
        CHECK(imported.primitive().material->second_uvs == SecondUvUse{.metal_roughness = true});
    }
    // A third kind is placed like another one of its set.
    {
        const Imported imported = imported_with(R"({
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                "emissiveFactor": [1, 1, 1],
                "emissiveTexture": {"index": 0, "texCoord": 1},
                "occlusionTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [1, 0]}}}})");
        CHECK(imported.report.warnings ==
              std::vector<std::string>{
                  "material 0: its occlusion texture is placed like its base colour texture: two kinds of "
                  "texture coordinates are read"});
        CHECK(imported.primitive().material->second_uvs == SecondUvUse{.emissive = true});
    }
}

TEST_CASE("second coordinates that the file lacks are zero, and stay with vertices that are unshared") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.document["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 3}};
    const Imported without(file);
    CHECK(without.primitive().second_uvs == std::vector<glm::vec2>(3, glm::vec2(0.0F)));

    // Two triangles that share an edge and have no normals.
    GltfBuilder pair = textured(data_uri(png(four_colours, 2, 2)));
    pair.document["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}};
    Json& attributes = pair.primitive()["attributes"];
    attributes["POSITION"] = pair.add_vectors({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1});
    attributes["TEXCOORD_1"] = pair.add_accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
    pair.primitive()["indices"] = pair.add_indices({0, 1, 2, 0, 2, 3});
    const Imported imported(pair);
    const Primitive& primitive = imported.primitive();
    REQUIRE(primitive.vertices.size() == 6);
    REQUIRE(primitive.second_uvs.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(primitive.second_uvs[i] == glm::vec2(primitive.vertices[i].position));
    }
}

TEST_CASE("one warning for each kind of thing that materials ask for and that is ignored") {
    GltfBuilder file = right_triangle();
    file.document["images"][0] = data_uri(png(four_colours, 2, 2));
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.document["extensionsUsed"] = {"KHR_materials_specular"};
    file.document["materials"] = Json::parse(R"([
            {},
            {"extensions": {"KHR_materials_specular": {"specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}}}}])");
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{"specularTextures of KHR_materials_specular are ignored",
                                   "specularColorTextures of KHR_materials_specular are ignored"});
}

TEST_CASE("layers that are left out are one warning each, also if the file requires them") {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_clearcoat",
                                       "KHR_materials_volume"};
    file.document["extensionsRequired"] = {"KHR_materials_clearcoat"};
    CHECK(Imported(file).report.warnings ==
          std::vector<std::string>{"KHR_materials_clearcoat is approximated by the base layer",
                                   "KHR_materials_sheen is approximated by the base layer",
                                   "KHR_materials_volume is approximated by the base layer"});
}

TEST_CASE("transmission") {
    GltfBuilder file = right_triangle();
    file.primitive()["material"] = 0;
    file.document["extensionsUsed"] = {"KHR_materials_transmission"};
    const auto imported_with = [&](const char* extension) {
        file.document["materials"][0]["extensions"]["KHR_materials_transmission"] = Json::parse(extension);
        return Imported(file);
    };
    CHECK(imported_with("{}").primitive().material->transmission == 0.0F);
    const Imported half = imported_with(R"({"transmissionFactor": 0.5})");
    CHECK(half.primitive().material->transmission == 0.5F);
    CHECK(half.report.warnings.empty());
    file.document["images"][0] = data_uri(png(four_colours, 2, 2));
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    const Imported textured =
        imported_with(R"({"transmissionFactor": 1, "transmissionTexture": {"index": 0}})");
    CHECK(textured.primitive().material->transmission == 1.0F);
    CHECK(textured.report.warnings ==
          std::vector<std::string>{"transmissionTextures of KHR_materials_transmission are approximated by "
                                   "their factor"});
    file.document["materials"][0]["extensions"]["KHR_materials_transmission"] =
        Json::parse(R"({"transmissionFactor": 1.5})");
    CHECK(error_of(file).find("transmissionFactor") != std::string::npos);
}

TEST_CASE("metalness, roughness and specular reflection") {
    GltfBuilder file = right_triangle();
    // Without a material: white rough metal, by glTF's defaults.
    CHECK(is_rough_metal(*Imported(file).primitive().material));
    file.primitive()["material"] = 0;
    file.document["materials"] = Json::parse("[{}]");
    CHECK(is_rough_metal(*Imported(file).primitive().material));

    file.document["images"][0] = data_uri(png(four_colours, 2, 2));
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.document["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_ior"};
    file.document["materials"] = Json::parse(R"([{"pbrMetallicRoughness":
            {"metallicFactor": 0.25, "roughnessFactor": 0.5, "baseColorTexture": {"index": 0},
             "metallicRoughnessTexture": {"index": 0}},
            "extensions": {"KHR_materials_specular": {"specularFactor": 0.75, "specularColorFactor": [1, 0.5, 2]},
                           "KHR_materials_ior": {"ior": 1.25}}}])");
    const Imported imported(file);
    const Material& material = *imported.primitive().material;
    CHECK(material.metalness == 0.25F);
    CHECK(material.roughness == 0.5F);
    CHECK(material.specular == 0.75F);
    CHECK(material.specular_colour == glm::vec3(1.0F, 0.5F, 2.0F));
    CHECK(material.ior == 1.25F);
    // The same picture, once as colours and once as other values.
    REQUIRE(material.metal_roughness_texture != nullptr);
    CHECK(material.metal_roughness_texture->encoding == Encoding::linear);
    CHECK(material.base_colour_texture->encoding == Encoding::srgb);
    CHECK(material.metal_roughness_texture->texels == material.base_colour_texture->texels);
    CHECK(imported.report.warnings.empty());
}

TEST_CASE("normal and occlusion textures") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    CHECK_FALSE(is_bumpy(Imported(file).mesh()));
    file.document["materials"][0]["normalTexture"] = {{"index", 0}};
    file.document["materials"][0]["occlusionTexture"] = {{"index", 0}};
    const Imported plain(file);
    CHECK(is_bumpy(plain.mesh()));
    CHECK(plain.report.warnings.empty());
    CHECK(plain.primitive().material->normal_scale == 1.0F);
    CHECK(plain.primitive().material->occlusion_strength == 1.0F);

    file.document["materials"][0]["normalTexture"]["scale"] = -2.5;
    file.document["materials"][0]["occlusionTexture"]["strength"] = 0.25;
    const Imported scaled(file);
    const Material& material = *scaled.primitive().material;
    CHECK(material.normal_scale == -2.5F);
    CHECK(material.occlusion_strength == 0.25F);
    REQUIRE(material.normal_texture != nullptr);
    CHECK(material.normal_texture->encoding == Encoding::linear);
    CHECK(material.normal_texture->texels == four_colours);
    CHECK(material.occlusion_texture == material.normal_texture);
}

TEST_CASE("an unlit material has no bumps") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.document["extensionsUsed"] = {"KHR_materials_unlit"};
    file.document["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
    file.document["materials"][0]["normalTexture"] = {{"index", 0}};
    file.document["materials"][0]["occlusionTexture"] = {{"index", 0}};
    CHECK_FALSE(is_bumpy(Imported(file).mesh()));
}

TEST_CASE("tangents of the file are normalised, and those that are missing are derived") {
    GltfBuilder file = bumpy();
    Json& attributes = file.primitive()["attributes"];
    // u grows along +X, v along -Y.
    CHECK(tangents_of(Imported(file)) == std::vector<glm::i16vec4>(3, {32767, 0, 0, 32767}));

    attributes["TANGENT"] = file.add_accessor(
        std::vector<float>{0, 1, 0, -1, 0, 0.5F, 0, 1, -3e30F, 0, 4e30F, 1}, 5126, "VEC4", 4);
    CHECK(tangents_of(Imported(file)) ==
          std::vector<glm::i16vec4>{{0, 32767, 0, -32767}, {0, 32767, 0, 32767}, {-19660, 0, 26214, 32767}});
    SUBCASE("without normals, glTF ignores tangents") {
        attributes.erase("NORMAL");
        CHECK(tangents_of(Imported(file)) == std::vector<glm::i16vec4>(3, {32767, 0, 0, 32767}));
    }
    SUBCASE("one of them has no length") {
        attributes["TANGENT"] =
            file.add_accessor(std::vector<float>{0, 1, 0, -1, 0, 0, 0, 1, 0, 1, 0, 1}, 5126, "VEC4", 4);
        CHECK(tangents_of(Imported(file)) == std::vector<glm::i16vec4>(3, {32767, 0, 0, 32767}));
    }
    SUBCASE("texture coordinates are turned by a quarter: u grows downwards") {
        file.document["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {
            {"rotation", 1.5707963267948966}};
        CHECK(tangents_of(Imported(file)) == std::vector<glm::i16vec4>(3, {0, -32767, 0, 32767}));
    }
    SUBCASE("without a normal texture, there are no tangents, and those of the file are not read") {
        file.document["materials"][0].erase("normalTexture");
        file.document["accessors"].back()["type"] = "VEC2";
        CHECK(tangents_of(Imported(file)) == std::vector<glm::i16vec4>(3, glm::i16vec4(0)));
    }
}

TEST_CASE("tangents that are malformed, and factors out of range") {
    const auto with_tangents = [](const std::vector<float>& values, const char* type,
                                  std::size_t components) {
        GltfBuilder file = bumpy();
        file.primitive()["attributes"]["TANGENT"] = file.add_accessor(values, 5126, type, components);
        return error_of(file);
    };
    CHECK(with_tangents(std::vector<float>(8, 1.0F), "VEC4", 4) ==
          "mesh 0: it has 3 positions, but 2 tangents");
    CHECK(with_tangents(std::vector<float>(9, 1.0F), "VEC3", 3) ==
          "mesh 0: accessor 3 holds tangents, but is not VEC4 of FLOAT");
    std::vector<float> infinite(12, 1.0F);
    infinite[6] = std::numeric_limits<float>::infinity();
    CHECK(with_tangents(infinite, "VEC4", 4) == "mesh 0: accessor 3 has a NaN or infinity in element 1");

    GltfBuilder file = bumpy();
    file.document["materials"][0]["occlusionTexture"] = {{"index", 0}};
    check_defects(
        {
            {"/materials/0/normalTexture/scale", R"("1")", "@ is not a number"},
            {"/materials/0/normalTexture/scale", "1e39", "@ is 1e+39, which is out of range"},
            {"/materials/0/occlusionTexture/strength", "1.5", "@ is 1.5, which is out of range"},
            {"/materials/0/occlusionTexture/strength", "-0.5", "@ is -0.5, which is out of range"},
            {"/materials/0/occlusionTexture/index", "1", "@ is 1, but there are 1 textures"},
        },
        file);
}

TEST_CASE("alpha modes and their cutoff") {
    struct Alpha {
        const char* json;
        AlphaMode mode;
        float cutoff;
    };
    for (const Alpha& alpha :
         {Alpha{"{}", AlphaMode::opaque, 0.5F}, Alpha{R"({"alphaMode": "OPAQUE"})", AlphaMode::opaque, 0.5F},
          Alpha{R"({"alphaMode": "MASK"})", AlphaMode::mask, 0.5F},
          Alpha{R"({"alphaMode": "MASK", "alphaCutoff": 0.25})", AlphaMode::mask, 0.25F},
          Alpha{R"({"alphaMode": "BLEND"})", AlphaMode::blend, 0.5F}}) {
        CAPTURE(alpha.json);
        GltfBuilder file = right_triangle();
        file.primitive()["material"] = 0;
        file.document["materials"] = Json::array({Json::parse(alpha.json)});
        const Imported imported(file);
        CHECK(imported.primitive().material->alpha_mode == alpha.mode);
        CHECK(imported.primitive().material->alpha_cutoff == alpha.cutoff);
        CHECK(imported.report.warnings.empty());
    }
}

TEST_CASE("an image in a data URI, in a buffer view, in a file with an awkward name") {
    const Bytes image = png(four_colours, 2, 2);
    const TemporaryDirectory directory;
    GltfBuilder file = textured(data_uri(image));
    SUBCASE("data URI") {}
    SUBCASE("buffer view") {
        file.document["images"][0] = {{"bufferView", file.add_view(image)}, {"mimeType", "image/png"}};
    }
    SUBCASE("file") {
        write_file(directory / "four colours+50%.png", image);
        file.document["images"][0] = {{"uri", "four%20colours+50%25.png"}};
    }
    write_file(directory / "scene.gltf", file.gltf());
    const Imported imported(file.gltf(), directory / "");
    CHECK(texture_of(imported).width == 2);
    CHECK(texture_of(imported).height == 2);
    CHECK(texture_of(imported).texels == four_colours);
    CHECK(texture_of(imported).wrap_u == Wrap::repeat);
}

TEST_CASE("a JPEG") {
    const Imported imported(textured(data_uri(jpeg({200, 100, 50, 255}))));
    REQUIRE(texture_of(imported).texels.size() == 64);
    for (const glm::u8vec4& texel : texture_of(imported).texels) {
        // At quality 100, a constant block gets up to one rounding error in each of three conversions.
        for (int i = 0; i < 4; ++i) {
            CHECK(std::abs(texel[i] - glm::u8vec4(200, 100, 50, 255)[i]) <= 3);
        }
    }
}

TEST_CASE("16 bits per channel become 8") {
    const Imported imported(textured({{"uri", sixteen_bit_png}}));
    CHECK(texture_of(imported).texels == Texels{{0xFF, 0x80, 0x00, 0xFF}, {0x12, 0x00, 0xAB, 0xFF}});
}

TEST_CASE("textures share an image if their source and wrapping are equal") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.document["samplers"] = Json::parse(R"([{"wrapS": 33071, "wrapT": 33648}, {}])");
    file.document["textures"] =
        Json::parse(R"([{"source": 0, "sampler": 0}, {"source": 0, "sampler": 1}, {"source": 0}])");
    for (const int texture : {1, 2}) {
        file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0})["material"] =
            file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    }
    const Imported imported(file);
    const auto image = [&](std::size_t i) {
        return imported.mesh().primitives[i].material->base_colour_texture;
    };
    CHECK(image(0)->wrap_u == Wrap::clamp_to_edge);
    CHECK(image(0)->wrap_v == Wrap::mirrored_repeat);
    CHECK(image(1)->wrap_u == Wrap::repeat);
    CHECK(image(0) != image(1));
    CHECK(image(1) == image(2));
}

TEST_CASE("unsupported features are reported") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    SUBCASE("a texture whose image comes from an extension") {
        file.document["textures"][0].erase("source");
        CHECK(Imported(file).report.warnings ==
              std::vector<std::string>{
                  "texture 0: it has no PNG, JPEG or WebP image; a checker pattern takes its place"});
        CHECK(is_checker(texture_of(Imported(file))));
    }
}

TEST_CASE("what takes the place of an image that cannot be read depends on what it is for") {
    GltfBuilder file = textured({{"uri", "nowhere.png"}});
    file.document["materials"] = Json::parse(R"([
            {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
             "normalTexture": {"index": 0}, "occlusionTexture": {"index": 0},
             "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}},
            {"normalTexture": {"index": 1}}])");
    file.document["images"].push_back({{"uri", "nowhere else.png"}});
    file.document["textures"].push_back({{"source", 1}});
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0})["material"] = 1;
    const Imported imported(file);
    const Material& material = *imported.primitive().material;
    REQUIRE(material.base_colour_texture != nullptr);
    CHECK(is_checker(*material.base_colour_texture));
    REQUIRE(material.emissive_texture != nullptr);
    CHECK(material.emissive_texture->texels == Texels{{0, 0, 0, 255}});
    CHECK(material.metal_roughness_texture == nullptr);
    CHECK(material.normal_texture == nullptr);
    CHECK(material.occlusion_texture == nullptr);
    CHECK(imported.mesh().primitives[1].material->normal_texture == nullptr);
    CHECK(imported.report.warnings ==
          std::vector<std::string>{"image 0: nowhere.png does not exist; a checker pattern takes its place",
                                   "image 1: nowhere else.png does not exist; it is left out"});
}

TEST_CASE("a texture in Basis Universal is replaced by its fallback, or else by a pattern") {
    const Bytes basis{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    file.document["extensionsUsed"] = {"KHR_texture_basisu"};
    file.document["images"].push_back({{"uri", "data:image/png;base64," + base64(basis)}});
    Json& texture = file.document["textures"][0];
    texture["extensions"]["KHR_texture_basisu"]["source"] = 1;
    CHECK(texture_of(Imported(file)).texels == four_colours);
    CHECK(Imported(file).report.warnings.empty());

    texture.erase("source");
    file.document["extensionsRequired"] = {"KHR_texture_basisu"};
    CHECK(is_checker(texture_of(Imported(file))));
    CHECK(
        Imported(file).report.warnings ==
        std::vector<std::string>{"image 1: it is KTX, which is not read; a checker pattern takes its place"});
    texture["extensions"]["KHR_texture_basisu"]["source"] = 2;
    CHECK(error_of(file) == "textures[0].extensions.KHR_texture_basisu.source is 2, but there are 2 images");
}

TEST_CASE("a damaged image is decoded once, however many textures have it") {
    GltfBuilder file = textured(data_uri(png(four_colours, 2, 2)));
    Bytes damaged = png(four_colours, 2, 2);
    damaged.resize(damaged.size() - 20);  // without its end and the last of its pixels' data
    const TemporaryDirectory directory;
    write_file(directory / "rock.png", damaged);
    file.document["images"][0] = {{"uri", "rock.png"}};
    for (int i = 0; i < 100; ++i) {
        file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0})["material"] =
            file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    }
    ImportOptions options;
    options.limits.pixels = 4;
    World world;
    const ImportReport report = import_gltf(file.gltf(), directory / "", "test.gltf", world, options);
    CHECK(report.triangles == 101);
    CHECK(report.warnings ==
          std::vector<std::string>{"image 0: rock.png: it is cut short; a checker pattern takes its place"});
}

TEST_CASE("an image of an emission that is zero is not loaded") {
    GltfBuilder file = textured({{"uri", "nowhere.png"}});
    file.document["materials"][0] = Json::parse(R"({"emissiveTexture": {"index": 0}})");
    CHECK(Imported(file).report.triangles == 1);
}

}  // TEST_SUITE("glTF materials")
