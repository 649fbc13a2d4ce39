// KHR_mesh_quantization: the same mesh in integers and in floats.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/engine/malformed_gltf.hpp"

TEST_SUITE("quantized glTF") {

using namespace candela;
using namespace candela::test;

namespace {

/// The component types of glTF.
template <class Integer>
constexpr int type_of = 0;
template <>
constexpr int type_of<std::int8_t> = 5120;
template <>
constexpr int type_of<std::uint8_t> = 5121;
template <>
constexpr int type_of<std::int16_t> = 5122;
template <>
constexpr int type_of<std::uint16_t> = 5123;

GltfBuilder quantized_triangle() {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    return file;
}

/// Adds an accessor of the values divided by `step`, in rows that are aligned to 4 bytes.
template <class Integer>
std::size_t add_quantized(GltfBuilder& file, const std::vector<float>& values, std::size_t components,
                          float step, bool normalized) {
    const std::size_t row = (components * sizeof(Integer) + 3) / 4 * 4 / sizeof(Integer);
    std::vector<Integer> integers(values.size() / components * row);
    for (std::size_t i = 0; i < values.size(); ++i) {
        integers[i / components * row + i % components] = static_cast<Integer>(std::lround(values[i] / step));
    }
    const std::size_t view = file.add_view(integers);
    file.document["bufferViews"][view]["byteStride"] = row * sizeof(Integer);
    return file.add("accessors", {{"bufferView", view},
                                  {"componentType", type_of<Integer>},
                                  {"normalized", normalized},
                                  {"count", values.size() / components},
                                  {"type", "VEC" + std::to_string(components)}});
}

/// The corners of a triangle, all different and within what the integers hold: [0, 1] or [-1, 1].
template <class Integer>
std::vector<float> values(std::size_t count) {
    std::mt19937 random(1);
    const float least = std::numeric_limits<Integer>::is_signed ? -1.0F : 0.0F;
    std::uniform_real_distribution<float> within(least, 1.0F);
    std::vector<float> numbers(count);
    for (float& number : numbers) {
        number = within(random);
    }
    return numbers;
}

template <class Integer>
void check_positions_and_coordinates(bool normalized) {
    CAPTURE(type_of<Integer>);
    CAPTURE(normalized);
    constexpr float one = static_cast<float>(std::numeric_limits<Integer>::max());
    const float step = 1.0F / one;
    const float unit = normalized ? 1.0F : step;  // what a read number is to be multiplied by
    const std::vector<float> positions = values<Integer>(9);
    const std::vector<float> coordinates = values<Integer>(6);
    GltfBuilder file = quantized_triangle();
    file.primitive()["attributes"]["POSITION"] = add_quantized<Integer>(file, positions, 3, step, normalized);
    file.primitive()["attributes"]["TEXCOORD_0"] =
        add_quantized<Integer>(file, coordinates, 2, step, normalized);
    const Imported imported(file);
    CHECK(imported.report.warnings.empty());
    const std::vector<Vertex> corners = imported.corners();
    REQUIRE(corners.size() == 3);
    // Half a step, and a rounding of a float near 1 in each of three operations.
    const float tolerance = 0.5F * step + 3.0F * std::numeric_limits<float>::epsilon();
    for (std::size_t i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            const float expected = positions[3 * i + static_cast<std::size_t>(k)];
            CHECK(std::abs(corners[i].position[k] * unit - expected) <= tolerance);
        }
        for (int k = 0; k < 2; ++k) {
            const float expected = coordinates[2 * i + static_cast<std::size_t>(k)];
            CHECK(std::abs(corners[i].uv[k] * unit - expected) <= tolerance);
        }
    }
}

template <class Integer>
void check_second_coordinates() {
    const float step = 1.0F / static_cast<float>(std::numeric_limits<Integer>::max());
    const std::vector<float> coordinates = values<Integer>(6);
    GltfBuilder file = quantized_triangle();
    file.primitive()["attributes"]["TEXCOORD_1"] = add_quantized<Integer>(file, coordinates, 2, step, true);
    file.document["images"] = {{{"uri", sixteen_bit_png}}};
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.document["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "occlusionTexture": {"index": 0, "texCoord": 1}}])");
    file.primitive()["material"] = 0;
    const Imported imported(file);
    REQUIRE(imported.primitive().second_uvs.size() == 3);
    // As those of the first set.
    const float tolerance = 0.5F * step + 3.0F * std::numeric_limits<float>::epsilon();
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(imported.primitive().second_uvs[i].x - coordinates[2 * i]) <= tolerance);
        CHECK(std::abs(imported.primitive().second_uvs[i].y - coordinates[2 * i + 1]) <= tolerance);
    }
}

/// Normals and tangents at right angles to each other, of unit length.
template <class Integer>
void check_directions() {
    const std::vector<float> normals{0.6F, 0.0F, 0.8F, 0.0F, -1.0F, 0.0F, -0.48F, 0.6F, 0.64F};
    const std::vector<float> tangents{0.8F, 0.0F,  -0.6F, 1.0F, 1.0F, 0.0F,
                                      0.0F, -1.0F, 0.8F,  0.0F, 0.6F, 1.0F};
    const float step = 1.0F / static_cast<float>(std::numeric_limits<Integer>::max());
    GltfBuilder file = quantized_triangle();
    file.primitive()["attributes"]["NORMAL"] = add_quantized<Integer>(file, normals, 3, step, true);
    file.primitive()["attributes"]["TANGENT"] = add_quantized<Integer>(file, tangents, 4, step, true);
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2", 2);
    file.document["images"] = {{{"uri", sixteen_bit_png}}};
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    file.document["materials"] = Json::parse(R"([{"normalTexture": {"index": 0}}])");
    file.primitive()["material"] = 0;
    const std::vector<Vertex> corners = Imported(file).corners();
    REQUIRE(corners.size() == 3);
    // Half a step in each component, as much again from making the length 1, and the 16 bits of a tangent.
    const float tolerance = 2.0F * std::sqrt(3.0F) * 0.5F * step + 1.0F / 32767.0F;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3 normal(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
        const glm::vec3 tangent(tangents[4 * i], tangents[4 * i + 1], tangents[4 * i + 2]);
        CHECK(glm::distance(corners[i].normal, normal) <= tolerance);
        CHECK(glm::distance(glm::vec3(corners[i].tangent) / 32767.0F, tangent) <= tolerance);
        CHECK((corners[i].tangent.w < 0) == (tangents[4 * i + 3] < 0.0F));
    }
}

}  // namespace

TEST_CASE("positions and texture coordinates of every type are within half a step of the floats") {
    for (const bool normalized : {false, true}) {
        check_positions_and_coordinates<std::int8_t>(normalized);
        check_positions_and_coordinates<std::uint8_t>(normalized);
        check_positions_and_coordinates<std::int16_t>(normalized);
        check_positions_and_coordinates<std::uint16_t>(normalized);
    }
    check_second_coordinates<std::uint8_t>();
    check_second_coordinates<std::uint16_t>();
}

TEST_CASE("normals and tangents of both types are within half a step of the floats") {
    check_directions<std::int8_t>();
    check_directions<std::int16_t>();
}

TEST_CASE("the lowest normalised integer is -1, like the one above it") {
    GltfBuilder file = quantized_triangle();
    file.primitive()["attributes"]["POSITION"] =
        add_quantized<std::int8_t>(file, {-128, -127, 127, 127, 0, 0, 0, 127, 0}, 3, 1.0F, true);
    CHECK(Imported(file).positions() == std::vector<glm::vec3>{{-1, -1, 1}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("other types are refused, and all of them without the extension") {
    const auto error_with = [](const char* attribute, std::size_t components, bool normalized,
                               bool is_declared) {
        GltfBuilder file = quantized_triangle();
        file.primitive()["attributes"][attribute] = add_quantized<std::int16_t>(
            file, std::vector<float>(3 * components, 1.0F), components, 1.0F, normalized);
        if (!is_declared) file.document.erase("extensionsUsed");
        file.document.erase("extensionsRequired");
        return error_of(file);
    };
    CHECK(error_with("NORMAL", 3, true, true) == "imported");
    CHECK(error_with("NORMAL", 3, false, true) ==
          "mesh 0: accessor 1 holds normals, but is not VEC3 of FLOAT, or of a type of "
          "KHR_mesh_quantization");
    CHECK(error_with("NORMAL", 3, true, false) ==
          "mesh 0: accessor 1 holds normals, but is not VEC3 of FLOAT");
    CHECK(error_with("POSITION", 3, true, false) ==
          "mesh 0: accessor 1 holds positions, but is not VEC3 of FLOAT");
    CHECK(error_with("POSITION", 2, true, true) ==
          "mesh 0: accessor 1 holds positions, but is not VEC3 of FLOAT, or of a type of "
          "KHR_mesh_quantization");
    CHECK(error_with("TEXCOORD_0", 2, false, true) == "imported");
    CHECK(error_with("TEXCOORD_0", 2, false, false) ==
          "mesh 0: accessor 1 holds texture coordinates, but is not VEC2 of FLOAT or of normalised "
          "UNSIGNED_BYTE or UNSIGNED_SHORT");
}

}  // TEST_SUITE("quantized glTF")
