// KHR_draco_mesh_compression: geometry that Draco has encoded, against the same without compression.

#include <doctest/doctest.h>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <candela/scene/deformed_mesh.hpp>
#include "tests/engine/grid_gltf.hpp"
#include "tests/engine/malformed_gltf.hpp"
#include "tests/seed.hpp"

TEST_SUITE("Draco") {

using namespace candela;
using namespace candela::test;

namespace {

/// Encoded triangles, and how many vertices they have.
struct Encoded {
    Bytes bytes;
    std::size_t vertices = 0;
};

draco::Mesh& build(const Grid& grid, std::unique_ptr<draco::Mesh>& mesh) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(grid.indices.size() / 3));
    const auto add = [&](draco::GeometryAttribute::Type type, const std::vector<float>& values,
                         int components) {
        const int attribute =
            builder.AddAttribute(type, static_cast<std::int8_t>(components), draco::DT_FLOAT32);
        for (std::uint32_t i = 0; i < grid.indices.size() / 3; ++i) {
            const auto corner = [&](std::size_t k) {
                return &values[grid.indices[3 * i + k] * static_cast<std::size_t>(components)];
            };
            builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(i), corner(0), corner(1),
                                              corner(2));
        }
    };
    add(draco::GeometryAttribute::POSITION, grid.positions, 3);     // unique id 0
    add(draco::GeometryAttribute::NORMAL, grid.normals, 3);         // unique id 1
    add(draco::GeometryAttribute::TEX_COORD, grid.coordinates, 2);  // unique id 2
    mesh = builder.Finalize();
    return *mesh;
}

/// `position_bits` is 0 for floats as they are.
Encoded encode(const Grid& grid, int method, int position_bits) {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    if (position_bits > 0) {
        encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, position_bits);
    }
    std::unique_ptr<draco::Mesh> mesh;
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(build(grid, mesh), &buffer).ok());
    draco::DecoderBuffer again;
    again.Init(buffer.data(), buffer.size());
    draco::Decoder decoder;
    return {Bytes(buffer.data(), buffer.data() + buffer.size()),
            decoder.DecodeMeshFromBuffer(&again).value()->num_points()};
}

/// The grid's file, whose accessors have no data of their own.
GltfBuilder compressed(const Grid& grid, const Encoded& encoded) {
    GltfBuilder file = grid.file();
    file.data.clear();
    file.document["bufferViews"] = Json::array();
    const std::size_t view = file.add_view(encoded.bytes);
    for (std::size_t i = 0; i < 4; ++i) {
        file.document["accessors"][i].erase("bufferView");
        if (i < 3) file.document["accessors"][i]["count"] = encoded.vertices;
    }
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}};
    file.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return file;
}

Encoded encode_exactly(const Grid& grid) {
    return encode(grid, draco::MESH_EDGEBREAKER_ENCODING, 0);
}

}  // namespace

TEST_CASE("triangles of both methods are the same as without compression") {
    const Grid grid;
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        CAPTURE(method);
        const Imported imported(compressed(grid, encode(grid, method, 0)));
        CHECK(imported.report.warnings.empty());
        CHECK(sorted_triangles(imported) == sorted_triangles(Imported(grid.file())));
    }
}

TEST_CASE("joints and weights that Draco has encoded move the vertices") {
    const Grid grid;
    draco::TriangleSoupMeshBuilder builder;
    const auto triangles = static_cast<std::uint32_t>(grid.indices.size() / 3);
    builder.Start(static_cast<int>(triangles));
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int joints = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
    const int weights = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32);
    constexpr std::array<std::uint8_t, 4> both{0, 1, 0, 0};
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const auto position = [&](std::size_t k) { return &grid.positions[3U * grid.indices[3 * i + k]]; };
        // The share of the second joint grows along x, from 0 to 1.
        std::array<std::array<float, 4>, 3> shares{};
        for (std::size_t k = 0; k < 3; ++k) {
            const float share = 0.5F * (*position(k) + 1.0F);
            shares[k] = {1.0F - share, share, 0.0F, 0.0F};
        }
        const draco::FaceIndex face(i);
        builder.SetAttributeValuesForFace(positions, face, position(0), position(1), position(2));
        builder.SetAttributeValuesForFace(joints, face, both.data(), both.data(), both.data());
        builder.SetAttributeValuesForFace(weights, face, shares[0].data(), shares[1].data(),
                                          shares[2].data());
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    draco::DecoderBuffer again;
    again.Init(buffer.data(), buffer.size());
    const std::size_t vertices = draco::Decoder().DecodeMeshFromBuffer(&again).value()->num_points();

    GltfBuilder file;
    const auto accessor = [&](int component_type, const char* type, std::size_t count) {
        return file.add("accessors", {{"componentType", component_type}, {"type", type}, {"count", count}});
    };
    Json primitive;
    primitive["attributes"]["POSITION"] = accessor(5126, "VEC3", vertices);
    primitive["attributes"]["JOINTS_0"] = accessor(5121, "VEC4", vertices);
    primitive["attributes"]["WEIGHTS_0"] = accessor(5126, "VEC4", vertices);
    primitive["indices"] = accessor(5123, "SCALAR", grid.indices.size());
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.add_view(Bytes(buffer.data(), buffer.data() + buffer.size()))},
        {"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}};
    file.document["meshes"][0]["primitives"].push_back(primitive);
    file.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.document["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0}, {}, {"translation": [0, 0, 2]}])");
    file.document["scenes"][0]["nodes"] = {0, 1, 2};
    file.document["skins"] = Json::parse(R"([{"joints": [1, 2]}])");
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    const std::vector<Vertex>& rest = imported.primitive().vertices;
    const std::vector<Vertex>& moved =
        imported.world.get<DeformedMesh>(imported.report.entities[0]).vertices->at(0);
    CHECK(rest.size() == grid.indices.size());
    for (std::size_t i = 0; i < rest.size(); ++i) {
        // Roundings of numbers up to 3.
        CHECK(std::abs(moved[i].position.z - rest[i].position.z - (rest[i].position.x + 1.0F)) <= 1e-6F);
    }
}

TEST_CASE("a second set of texture coordinates") {
    const Grid grid;
    GltfBuilder file = compressed(grid, encode_exactly(grid));
    Json& attributes = file.primitive()["attributes"];
    Json& packed = file.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
    attributes.erase("TEXCOORD_0");
    packed["TEXCOORD_1"] = packed["TEXCOORD_0"];
    packed.erase("TEXCOORD_0");
    file.document["images"] = {{{"uri", sixteen_bit_png}}};
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.document["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
            "occlusionTexture": {"index": 0, "texCoord": 1}}])");
    file.primitive()["material"] = 0;
    const Imported imported(file);
    const Imported plain(compressed(grid, encode_exactly(grid)));
    std::vector<glm::vec2> expected;
    for (const Vertex& vertex : plain.primitive().vertices) expected.push_back(vertex.uv);
    CHECK(imported.primitive().second_uvs == expected);
}

TEST_CASE("positions that Draco has rounded are within half a step") {
    const Grid grid;
    constexpr int bits = 12;
    const Imported imported(compressed(grid, encode(grid, draco::MESH_EDGEBREAKER_ENCODING, bits)));
    // The steps divide the longest side of the bounding box, 2, evenly; and roundings of floats.
    constexpr float tolerance = 0.5F * 2.0F / ((1 << bits) - 1) + 1e-6F;
    const std::vector<Vertex> corners = imported.corners();
    CHECK(corners.size() == grid.indices.size());
    for (const Vertex& corner : corners) {
        // Texture coordinates are exact and tell which vertex it is.
        const auto x = static_cast<std::size_t>(std::lround(corner.uv.x * (Grid::side - 1)));
        const auto y = static_cast<std::size_t>(std::lround(corner.uv.y * (Grid::side - 1)));
        for (int k = 0; k < 3; ++k) {
            const std::size_t at = 3 * (y * Grid::side + x) + static_cast<std::size_t>(k);
            CHECK(std::abs(corner.position[k] - grid.positions[at]) <= tolerance);
        }
    }
}

TEST_CASE("data that are not compressed are preferred") {
    const Grid grid;
    GltfBuilder file = grid.file();
    const std::size_t view = file.add_view(Bytes{1, 2, 3, 4});
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                    {"attributes", {{"POSITION", 0}}}};
    CHECK(sorted_triangles(Imported(file)) == sorted_triangles(Imported(grid.file())));
}

TEST_CASE("damaged data and accessors that do not fit are refused") {
    const Grid grid;
    const Encoded whole = encode_exactly(grid);
    Encoded cut = whole;
    cut.bytes.resize(whole.bytes.size() / 2);
    CHECK(error_of(compressed(grid, cut)) == "mesh 0: buffer view 0: its Draco data are damaged");
    cut.bytes.resize(4);
    CHECK(error_of(compressed(grid, cut)) == "mesh 0: buffer view 0: it holds no Draco data");
    const std::string draco = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    check_defects(
        {
            {"/accessors/1/count", "7", "mesh 0: accessor 1 has 7 elements, but its Draco data 81"},
            {"/accessors/3/count", "9", "mesh 0: accessor 3 has 9 elements, but its Draco data 384"},
            {"/meshes/0/primitives/0/indices", "",
             "mesh 0: its Draco data need accessors of positions and indices"},
            {draco + "/attributes/NORMAL", "9", "mesh 0: accessor 1 is not in its Draco data"},
            {draco + "/bufferView", "1", "@ is 1, but there are 1 buffer views"},
        },
        compressed(grid, whole));
}

TEST_CASE("data with random bytes are decoded or refused") {
    std::mt19937 random(test_seed(4));
    const Grid grid;
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const Encoded whole = encode(grid, method, 10);
        int refused = 0;
        for (int round = 0; round < 1000; ++round) {
            Encoded changed = whole;
            changed.bytes[random() % whole.bytes.size()] = static_cast<unsigned char>(random());
            refused += error_of(compressed(grid, changed)) != "imported" ? 1 : 0;
        }
        CHECK(refused > 0);
        CHECK(refused < 1000);
    }
}

TEST_CASE("what is to be decoded counts before memory is allocated for it") {
    // The header is 11 bytes long; for the first method, one byte more tells how the triangles are
    // stored. Then follow the numbers of vertices and triangles, here with the most that five bytes may
    // say.
    const Grid grid;
    Encoded encoded = encode_exactly(grid);
    const Bytes most{0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF, 0xFF, 0xFF, 0x0F};
    encoded.bytes.insert(encoded.bytes.begin() + 12, most.begin(), most.end());
    CHECK(error_of(compressed(grid, encoded)).ends_with("(growth)"));
    encoded = encode(grid, draco::MESH_SEQUENTIAL_ENCODING, 0);
    encoded.bytes.insert(encoded.bytes.begin() + 11, most.begin(), most.end());
    CHECK(error_of(compressed(grid, encoded)).ends_with("(growth)"));
}

}  // TEST_SUITE("Draco")
