// EXT_meshopt_compression: geometry that meshoptimizer has encoded, against the same without compression.

#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/engine/grid_gltf.hpp"
#include "tests/engine/malformed_gltf.hpp"
#include "tests/seed.hpp"

TEST_SUITE("meshoptimizer") {

using namespace candela;
using namespace candela::test;

namespace {

Bytes encode_vertices(const void* vertices, std::size_t count, std::size_t stride) {
    Bytes encoded(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), vertices, count, stride));
    return encoded;
}

Bytes encode_triangles(const Grid& grid) {
    const std::vector<unsigned int> indices(grid.indices.begin(), grid.indices.end());
    Bytes encoded(meshopt_encodeIndexBufferBound(indices.size(), Grid::side * Grid::side));
    encoded.resize(meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), indices.data(), indices.size()));
    return encoded;
}

Bytes encode_sequence(const Grid& grid) {
    const std::vector<unsigned int> indices(grid.indices.begin(), grid.indices.end());
    Bytes encoded(meshopt_encodeIndexSequenceBound(indices.size(), Grid::side * Grid::side));
    encoded.resize(
        meshopt_encodeIndexSequence(encoded.data(), encoded.size(), indices.data(), indices.size()));
    return encoded;
}

/// Replaces buffer view `view` by encoded bytes in the file's own buffer, number 1. Buffer 0 is the one whose
/// bytes are not there.
void compress(GltfBuilder& file, std::size_t view, const Bytes& encoded, const char* mode, std::size_t count,
              std::size_t stride) {
    const std::size_t added = file.add_view(encoded);
    const std::size_t offset = file.document["bufferViews"][added]["byteOffset"];
    file.document["bufferViews"].erase(added);
    file.document["bufferViews"][view] = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", count * stride}};
    file.document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 1},  {"byteOffset", offset}, {"byteLength", encoded.size()},
        {"mode", mode}, {"count", count},       {"byteStride", stride}};
}

/// The grid with all of its buffer views compressed.
GltfBuilder compressed(const Grid& grid) {
    GltfBuilder file = grid.file();
    file.data.clear();
    constexpr std::size_t count = Grid::side * Grid::side;
    compress(file, 0, encode_vertices(grid.positions.data(), count, 12), "ATTRIBUTES", count, 12);
    compress(file, 1, encode_vertices(grid.normals.data(), count, 12), "ATTRIBUTES", count, 12);
    compress(file, 2, encode_vertices(grid.coordinates.data(), count, 8), "ATTRIBUTES", count, 8);
    compress(file, 3, encode_triangles(grid), "TRIANGLES", grid.indices.size(), 2);
    Json missing{{"byteLength", 100'000}};
    missing["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    file.document["buffers"] = Json::array({missing});
    file.document["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    file.document["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    return file;
}

Json& extension_of(GltfBuilder& file, std::size_t view) {
    return file.document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

}  // namespace

TEST_CASE("attributes and triangles are the same as without compression") {
    const Grid grid;
    const Imported imported(compressed(grid));
    CHECK(imported.report.warnings.empty());
    CHECK(sorted_triangles(imported) == sorted_triangles(Imported(grid.file())));
}

TEST_CASE("a sequence of indices keeps its order") {
    const Grid grid;
    GltfBuilder file = compressed(grid);
    compress(file, 3, encode_sequence(grid), "INDICES", grid.indices.size(), 2);
    CHECK(Imported(file).corners() == Imported(grid.file()).corners());
}

TEST_CASE("normals on an octahedron and positions with a shared exponent") {
    const Grid grid;
    constexpr std::size_t count = Grid::side * Grid::side;
    std::vector<float> padded;
    for (std::size_t i = 0; i < count; ++i) {
        padded.insert(padded.end(),
                      {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
    }
    std::vector<unsigned char> octahedral(count * 4);
    meshopt_encodeFilterOct(octahedral.data(), count, 4, 8, padded.data());
    constexpr int bits = 15;
    std::vector<unsigned char> exponential(count * 12);
    meshopt_encodeFilterExp(exponential.data(), count, 12, bits, grid.positions.data());

    GltfBuilder file = compressed(grid);
    compress(file, 0, encode_vertices(exponential.data(), count, 12), "ATTRIBUTES", count, 12);
    extension_of(file, 0)["filter"] = "EXPONENTIAL";
    compress(file, 1, encode_vertices(octahedral.data(), count, 4), "ATTRIBUTES", count, 4);
    extension_of(file, 1)["filter"] = "OCTAHEDRAL";
    file.document["bufferViews"][1]["byteStride"] = 4;
    file.document["accessors"][1]["componentType"] = 5120;
    file.document["accessors"][1]["normalized"] = true;
    compress(file, 3, encode_sequence(grid), "INDICES", grid.indices.size(), 2);

    const std::vector<Vertex> read = Imported(file).corners();
    const std::vector<Vertex> expected = Imported(grid.file()).corners();
    REQUIRE(read.size() == expected.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        // Components below 2 in magnitude, as multiples of 2 / 2^(bits - 1), rounded.
        CHECK(glm::distance(read[i].position, expected[i].position) <= std::sqrt(3.0F) / (1 << (bits - 1)));
        // Half a step of 1 / 127 in both coordinates, of which the octahedron's face to the sphere makes
        // at most twice as much, and again in each component of the decoded vector.
        CHECK(glm::distance(read[i].normal, expected[i].normal) <=
              (2.0F * std::sqrt(2.0F) + std::sqrt(3.0F)) * 0.5F / 127.0F);
    }
}

TEST_CASE("damaged data and sizes that do not go together are refused") {
    GltfBuilder whole = compressed(Grid());
    const std::size_t length = extension_of(whole, 0)["byteLength"];
    const std::string first = "/bufferViews/0/extensions/EXT_meshopt_compression/";
    const std::string last = "/bufferViews/3/extensions/EXT_meshopt_compression/";
    check_defects(
        {
            {first + "byteLength", std::to_string(length - 1),
             "buffer view 0: its compressed data are damaged"},
            {first + "byteLength", "1000000", "buffer view 0: buffer view 0 reads past the end of buffer 1"},
            {first + "count", "80",
             "buffer view 0: its 80 elements of 12 bytes are not the 972 bytes it declares"},
            {first + "byteStride", "10",
             "buffer view 0: its stride of 10 does not go with ATTRIBUTES and NONE"},
            {first + "filter", R"("QUATERNION")",
             "buffer view 0: its stride of 12 does not go with ATTRIBUTES and QUATERNION"},
            {last + "filter", R"("OCTAHEDRAL")",
             "buffer view 3: its filter OCTAHEDRAL does not go with TRIANGLES"},
            {last + "count", "385", "buffer view 3: its 385 indices make no whole number of triangles"},
            {last + "byteStride", "8", "buffer view 3: its stride of 8 does not go with TRIANGLES and NONE"},
            {first + "mode", R"("POINTS")",
             R"(@ is "POINTS", not one of ["ATTRIBUTES","TRIANGLES","INDICES"])"},
            {first + "buffer", "2", "@ is 2, but there are 2 buffers"},
        },
        whole);
}

TEST_CASE("data with random bytes are decoded or refused") {
    std::mt19937 random(test_seed(5));
    const GltfBuilder whole = compressed(Grid());
    int refused = 0;
    for (int round = 0; round < 1000; ++round) {
        GltfBuilder changed = whole;
        changed.data[random() % whole.data.size()] = static_cast<unsigned char>(random());
        refused += error_of(changed) != "imported" ? 1 : 0;
    }
    CHECK(refused > 0);
    CHECK(refused < 1000);
}

TEST_CASE("what is to be decoded counts before memory is allocated for it") {
    GltfBuilder file = compressed(Grid());
    extension_of(file, 0)["count"] = 1'000'000'000;
    file.document["bufferViews"][0]["byteLength"] = 12'000'000'000;
    CHECK(error_of(file).ends_with("(growth)"));
}

}  // TEST_SUITE("meshoptimizer")
