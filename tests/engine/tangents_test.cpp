// Tangents of vertices: closed forms.

#include <candela/scene/tangents.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

TEST_SUITE("tangents") {

using namespace candela;

namespace {

constexpr glm::vec3 up(0.0F, 0.0F, 1.0F);

/// Members are rounded to half a step of 1 / 32767, and the computation before it to less than 1e-6.
constexpr float rounding = 0.5F / 32767.0F + 1e-6F;

bool is_close(const glm::i16vec4& tangent, glm::vec4 expected) {
    const glm::vec4 error = glm::abs(unpacked_tangent(tangent) - expected);
    return error.x <= rounding && error.y <= rounding && error.z <= rounding && error.w == 0.0F;
}

/// A unit square in the plane z = 0 that faces +Z, whose texture has its top left corner at (0, 1).
Primitive square() {
    return {
        {{{0, 0, 0}, up, {0, 1}}, {{1, 0, 0}, up, {1, 1}}, {{1, 1, 0}, up, {1, 0}}, {{0, 1, 0}, up, {0, 0}}},
        {0, 1, 2, 0, 2, 3},
        nullptr};
}

Primitive derived(Primitive primitive) {
    derive_tangents(primitive);
    return primitive;
}

void check_all(const Primitive& primitive, glm::vec4 expected) {
    for (const Vertex& vertex : primitive.vertices) {
        CHECK(is_close(vertex.tangent, expected));
    }
}

/// A unit vector perpendicular to the normal, and a handedness.
bool is_usable(const Vertex& vertex) {
    const glm::vec4 tangent = unpacked_tangent(vertex.tangent);
    const glm::vec3 along(tangent);
    // Each member may be off by half a step, which adds up to √3 of it in the length.
    return std::abs(glm::length(along) - 1.0F) < 2.0F * rounding &&
           std::abs(glm::dot(along, glm::normalize(vertex.normal))) < 2.0F * rounding &&
           std::abs(tangent.w) == 1.0F;
}

/// A sphere of radius 1 around the origin with +Z up, whose u grows eastwards and whose v grows southwards.
/// Rows and columns are those of its quadrilaterals.
Primitive sphere(std::uint32_t columns, std::uint32_t rows) {
    constexpr float pi = std::numbers::pi_v<float>;
    Primitive primitive;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const glm::vec2 uv(float(column) / float(columns), float(row) / float(rows));
            const float azimuth = 2.0F * pi * uv.x;
            const float polar = pi * uv.y;
            const glm::vec3 direction(std::cos(azimuth) * std::sin(polar),
                                      std::sin(azimuth) * std::sin(polar), std::cos(polar));
            primitive.vertices.push_back({direction, direction, uv});
        }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t first = row * (columns + 1) + column;
            const std::uint32_t below = first + columns + 1;
            for (const std::uint32_t index : {first, below, below + 1, first, below + 1, first + 1}) {
                primitive.indices.push_back(index);
            }
        }
    }
    return primitive;
}

}  // namespace

TEST_CASE("a picture that stands upright: its tangent points to the right, its bitangent upwards") {
    const Primitive plain = derived(square());
    CHECK(plain.vertices.size() == 4);
    CHECK(plain.indices == square().indices);
    check_all(plain, {1, 0, 0, 1});
}

TEST_CASE("turned, stretched and mirrored pictures") {
    const auto with_uv = [](auto change) {
        Primitive primitive = square();
        for (Vertex& vertex : primitive.vertices) vertex.uv = change(vertex.uv);
        return derived(primitive);
    };
    // u grows upwards in space, v to the right: down in the picture is right, up is left.
    check_all(with_uv([](glm::vec2 uv) { return glm::vec2(1.0F - uv.y, uv.x); }), {0, 1, 0, 1});
    check_all(with_uv([](glm::vec2 uv) { return glm::vec2(1.0F - uv.x, uv.y); }), {-1, 0, 0, -1});
    check_all(with_uv([](glm::vec2 uv) { return glm::vec2(uv.x, 1.0F - uv.y); }), {1, 0, 0, -1});
    check_all(with_uv([](glm::vec2 uv) { return glm::vec2(5.0F * uv.x, 0.1F * uv.y); }), {1, 0, 0, 1});
    // Along lines of equal v, u grows to the right.
    check_all(with_uv([](glm::vec2 uv) { return glm::vec2(uv.x + 2.0F * uv.y, uv.y); }), {1, 0, 0, 1});
}

TEST_CASE("they belong to the coordinates of the normal texture, and splitting keeps the others") {
    Material material;
    material.normal_texture = std::make_shared<const Image>();
    material.second_uvs.normal = true;
    Primitive primitive = square();
    primitive.material = std::make_shared<const Material>(material);
    for (const Vertex& vertex : primitive.vertices) {
        primitive.second_uvs.emplace_back(1.0F - vertex.uv.y, vertex.uv.x);
    }
    check_all(derived(primitive), {0, 1, 0, 1});

    // Mirrored in the second triangle alone: the vertices of its diagonal are split.
    material.second_uvs.normal = false;
    primitive.material = std::make_shared<const Material>(material);
    primitive.vertices[3].uv = {1, 1};
    const Primitive split = derived(primitive);
    REQUIRE(split.vertices.size() == 6);
    REQUIRE(split.second_uvs.size() == 6);
    for (std::size_t i = 0; i < split.indices.size(); ++i) {
        CHECK(split.second_uvs[split.indices[i]] == primitive.second_uvs[primitive.indices[i]]);
    }
}

TEST_CASE("sizes do not matter, however small or large") {
    for (const float size : {1e-20F, 1e-3F, 1e9F, 1e15F}) {
        for (const float in_texture : {1e-20F, 1.0F, 1e15F}) {
            Primitive primitive = square();
            for (Vertex& vertex : primitive.vertices) {
                vertex.position *= size;
                vertex.uv *= in_texture;
            }
            check_all(derived(primitive), {1, 0, 0, 1});
        }
    }
}

TEST_CASE("tangents lie in the plane of the normal") {
    Primitive primitive = square();
    for (Vertex& vertex : primitive.vertices) vertex.normal = glm::normalize(glm::vec3(3.0F, 1.0F, 4.0F));
    // (1, 0, 0) without its part along (3, 1, 4).
    const glm::vec3 along = glm::normalize(glm::vec3(26.0F - 9.0F, -3.0F, -12.0F));
    check_all(derived(primitive), glm::vec4(along, 1.0F));
}

TEST_CASE("triangles count by their angles at the vertex, whatever their areas are") {
    // Around the origin: a triangle of 90° whose u grows along +X, and a larger one of 45° whose u grows
    // along +Y. The vertices at the origin are equal, but are two.
    Primitive primitive{{{{0, 0, 0}, up, {0, 0}},
                         {{1, 0, 0}, up, {1, 0}},
                         {{0, 1, 0}, up, {0, -1}},
                         {{0, 0, 0}, up, {0, 0}},
                         {{0, 9, 0}, up, {9, 0}},
                         {{-9, 9, 0}, up, {9, -9}}},
                        {0, 1, 2, 3, 4, 5},
                        nullptr};
    const glm::vec4 expected(glm::normalize(glm::vec3(90.0F, 45.0F, 0.0F)), 1.0F);
    derive_tangents(primitive);
    CHECK(is_close(primitive.vertices[0].tangent, expected));
    CHECK(is_close(primitive.vertices[3].tangent, expected));
    CHECK(is_close(primitive.vertices[1].tangent, {1, 0, 0, 1}));
    CHECK(is_close(primitive.vertices[4].tangent, {0, 1, 0, 1}));
}

TEST_CASE("vertices that differ in their normals or texture coordinates have nothing in common") {
    for (const bool by_normal : {false, true}) {
        Primitive primitive{{{{0, 0, 0}, up, {0, 0}},
                             {{1, 0, 0}, up, {1, 0}},
                             {{0, 1, 0}, up, {0, -1}},
                             {{0, 0, 0}, up, {0, 0}},
                             {{0, 1, 0}, up, {1, 0}},
                             {{-1, 0, 0}, up, {0, -1}}},
                            {0, 1, 2, 3, 4, 5},
                            nullptr};
        if (by_normal) {
            primitive.vertices[3].normal = glm::vec3(0.0F, 0.0F, 2.0F);
        } else {
            primitive.vertices[3].uv = glm::vec2(0.0F, -0.5F);
            primitive.vertices[4].uv = glm::vec2(1.0F, -0.5F);
        }
        derive_tangents(primitive);
        CHECK(is_close(primitive.vertices[0].tangent, {1, 0, 0, 1}));
        CHECK(is_close(primitive.vertices[3].tangent, {0, 1, 0, 1}));
    }
}

TEST_CASE("vertices at which a texture is mirrored are split") {
    // Both halves of the picture of a face: u grows from the middle, x = 0, to either side.
    Primitive primitive{{{{0, 0, 0}, up, {0, 1}},
                         {{1, 0, 0}, up, {1, 1}},
                         {{0, 1, 0}, up, {0, 0}},
                         {{-1, 0, 0}, up, {1, 1}, glm::u16vec4(1, 2, 3, 4)}},
                        {0, 1, 2, 0, 2, 3},
                        nullptr};
    primitive.vertices[2].colour = glm::u16vec4(5, 6, 7, 8);
    const Primitive split = derived(primitive);
    REQUIRE(split.vertices.size() == 6);
    REQUIRE(split.indices.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
        Vertex vertex = split.vertices[split.indices[i]];
        CHECK(is_close(vertex.tangent, i < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1)));
        vertex.tangent = glm::i16vec4(0);
        CHECK(vertex == primitive.vertices[primitive.indices[i]]);
    }
}

TEST_CASE("the tangents of a sphere point eastwards") {
    // The tangents of triangles are chords of circles of latitude: at the chord's ends, they are half the
    // angle between columns away from east.
    constexpr std::uint32_t columns = 64;
    const Primitive primitive = derived(sphere(columns, 32));
    CHECK(primitive.vertices.size() == sphere(columns, 32).vertices.size());
    const float tolerance = 1.01F * std::numbers::pi_v<float> / float(columns);
    for (const Vertex& vertex : primitive.vertices) {
        CHECK(is_usable(vertex));
        const glm::vec3 east = glm::cross(up, vertex.normal);
        const float sine = glm::length(east);
        if (sine < 0.05F) continue;  // a pole
        const glm::vec4 tangent = unpacked_tangent(vertex.tangent);
        CHECK(tangent.w == 1.0F);
        CHECK(glm::dot(glm::vec3(tangent), east / sine) > std::cos(tolerance));
    }
}

TEST_CASE("triangles without area, in space or in the texture, spoil nothing") {
    Primitive primitive = square();
    const auto add = [&](glm::vec3 position, glm::vec2 uv) {
        primitive.vertices.push_back({position, up, uv});
        return static_cast<std::uint32_t>(primitive.vertices.size() - 1);
    };
    const std::uint32_t same_uv = add({-1, 0, 0}, primitive.vertices[0].uv);
    const std::uint32_t on_line = add({2, 0, 0}, {7, 3});
    for (const std::uint32_t index : {0U, 3U, same_uv, 0U, 1U, on_line, 2U, 2U, 2U}) {
        primitive.indices.push_back(index);
    }
    const Primitive with_others = derived(primitive);
    CHECK(with_others.indices == primitive.indices);
    REQUIRE(with_others.vertices.size() == primitive.vertices.size());
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(is_close(with_others.vertices[i].tangent, {1, 0, 0, 1}));
    }
    CHECK(is_usable(with_others.vertices[on_line]));
}

TEST_CASE("a vertex without any tangent gets one that is perpendicular to its normal") {
    for (const glm::vec3 normal : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1),
                                   glm::vec3(0, 0, -1), glm::vec3(1, 1, 1), glm::vec3(-3, 0.1F, 2)}) {
        Primitive primitive = square();
        for (Vertex& vertex : primitive.vertices) {
            vertex.normal = glm::normalize(normal);
            vertex.uv = {0.5F, 0.5F};
        }
        primitive.vertices.push_back(primitive.vertices[0]);  // which no triangle uses
        for (const Vertex& vertex : derived(primitive).vertices) {
            CHECK(is_usable(vertex));
        }
    }
    Primitive primitive = square();
    primitive.vertices[0].normal = glm::vec3(0.0F);
    CHECK(glm::length(glm::vec3(unpacked_tangent(derived(primitive).vertices[0].tangent))) ==
          doctest::Approx(1.0F).epsilon(2.0 * rounding));
}

TEST_CASE("triangles without area in the texture take the tangent that is there, mirrored or not") {
    Primitive primitive = square();
    for (Vertex& vertex : primitive.vertices) vertex.uv.x = -vertex.uv.x;
    primitive.vertices.push_back({{-1, 0, 0}, up, primitive.vertices[0].uv});
    primitive.indices = {4, 0, 3, 0, 1, 2, 0, 2, 3};  // the one without area comes first
    const Primitive mirrored = derived(primitive);
    CHECK(mirrored.vertices.size() == primitive.vertices.size());
    CHECK(is_close(mirrored.vertices[0].tangent, {-1, 0, 0, -1}));
    CHECK(is_close(mirrored.vertices[3].tangent, {-1, 0, 0, -1}));
}

TEST_CASE("nothing of nothing, and the same tangents a second time") {
    CHECK(derived(Primitive{}).vertices.empty());
    const Primitive once = derived(sphere(7, 5));
    CHECK(derived(once).vertices == once.vertices);
    CHECK(derived(once).indices == once.indices);
}

TEST_CASE("packing rounds, and is undone by unpacking") {
    CHECK(packed_tangent({1.0F, -1.0F, 0.0F, -1.0F}) == glm::i16vec4(32767, -32767, 0, -32767));
    CHECK(packed_tangent({0.6F / 32767.0F, -0.6F / 32767.0F, 0.4F / 32767.0F, 1.0F}) ==
          glm::i16vec4(1, -1, 0, 32767));
    for (int i = -32767; i <= 32767; ++i) {
        const glm::i16vec4 packed(static_cast<std::int16_t>(i));
        if (packed_tangent(unpacked_tangent(packed)) != packed) FAIL("not undone: " << i);
    }
}

}  // TEST_SUITE("tangents")
