#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/objects.hpp"
#include "renderer/gl/texture.hpp"
#include "tests/renderer/context_fixture.hpp"
#include "tests/throws.hpp"

TEST_SUITE("gl objects") {

using namespace candela;
using namespace candela::gl;

namespace {

/// The number of live objects of one kind.
std::uint32_t alive(const Device& device, ObjectKind kind) {
    return device.live()[kind];
}

/// Bytes 0, 1, 2, ... for one layer of one level.
std::vector<std::byte> ramp(std::size_t count) {
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i);
    return bytes;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "every kind of object is counted while it exists, and labelled") {
    const auto check = [&](const Object& object, ObjectKind kind, GLenum space) {
        CHECK(alive(device, kind) == 1);
        std::array<char, 64> label{};
        device.gl().GetObjectLabel(space, object.name(), 64, nullptr, label.data());
        CHECK(std::string(label.data()) == "it");
    };
    check(Buffer(device, "it", 12), ObjectKind::buffer, GL_BUFFER);
    check(Texture(device, "it", {}), ObjectKind::texture, GL_TEXTURE);
    check(Framebuffer(device, "it"), ObjectKind::framebuffer, GL_FRAMEBUFFER);
    check(VertexArray(device, "it"), ObjectKind::vertex_array, GL_VERTEX_ARRAY);
    check(Sampler(device, "it", {}), ObjectKind::sampler, GL_SAMPLER);
    check(Query(device, "it", GL_TIMESTAMP), ObjectKind::query, GL_QUERY);
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "moving an object transfers its ownership") {
    Buffer first(device, "first", 16);
    const GLuint name = first.name();
    Buffer second = std::move(first);
    CHECK_FALSE(first);
    CHECK(first.bytes() == 0);
    CHECK(second.name() == name);
    CHECK(second.bytes() == 16);

    Buffer third(device, "third", 100);
    CHECK(device.live().buffer_bytes == 116);
    third = std::move(second);
    CHECK(third.name() == name);
    CHECK(alive(device, ObjectKind::buffer) == 1);
    CHECK(device.live().buffer_bytes == 16);

    Buffer& itself = third;
    third = std::move(itself);
    CHECK(third.name() == name);
    CHECK(device.gl().IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE);
    third = {};
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "a label that is too long for the driver is cut off") {
    const Buffer buffer(device, std::string(1000, 'x'), 4);
    CHECK(buffer);
}

TEST_CASE_FIXTURE(GlFixture, "a buffer returns what was uploaded") {
    Buffer buffer(device, "numbers", std::vector<std::uint32_t>{1, 2, 3, 4});
    buffer.upload(std::uint32_t{30}, 8);
    buffer.upload(std::array<std::uint32_t, 1>{40}, 12);
    CHECK(buffer.download<std::uint32_t>() == std::vector<std::uint32_t>{1, 2, 30, 40});
    CHECK_THROWS_AS(buffer.upload(std::uint32_t{5}, 13), GlError);
    CHECK_THROWS_AS(buffer.upload(std::uint32_t{5}, ~std::uint64_t{0}), GlError);
    CHECK(buffer.download<std::array<std::uint32_t, 3>>().size() == 1);
}

TEST_CASE_FIXTURE(GlFixture, "an empty buffer can be bound") {
    const Buffer buffer(device, "empty", std::vector<float>{});
    buffer.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    CHECK(buffer.bytes() == 0);
    CHECK(buffer.download<float>().empty());
}

TEST_CASE_FIXTURE(GlFixture, "a buffer that is too large is refused, and no object is left") {
    CHECK(throws<GlError>([&] { static_cast<void>(Buffer(device, "huge", ~std::uint64_t{0})); },
                          "buffer \"huge\""));
    CHECK(throws<MemoryError>([&] { static_cast<void>(Buffer(device, "huge", std::uint64_t{1} << 50U)); },
                              "no memory"));
    static_cast<void>(device.take_messages());  // the driver may report its refusal
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "a texture that is too large for the memory is refused by name") {
    if (!device.limits().software) return;  // GPUs' drivers may only find memory when it is first used
    const std::uint32_t side = device.limits().texture_size;
    const TextureDesc huge{.size = {side, side},
                           .format = Format::rgba32f,
                           .shape = TextureShape::array,
                           .layers = device.limits().texture_layers};
    CHECK(throws<GlError>([&] { static_cast<void>(Texture(device, "huge", huge)); }, "texture \"huge\" of"));
    CHECK(throws<MemoryError>([&] { static_cast<void>(Texture(device, "huge", huge)); }, "no memory"));
    static_cast<void>(device.take_messages());  // the driver may report its refusal
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "a pending error of the host is neither cleared nor taken for lack of memory") {
    device.gl().Enable(GL_RENDERER);  // no capability
    CHECK_NOTHROW(Buffer(device, "buffer", 64));
    CHECK_NOTHROW(Texture(device, "texture", TextureDesc{.size = {4, 4}}));
    CHECK(throws<MemoryError>([&] { static_cast<void>(Buffer(device, "huge", std::uint64_t{1} << 50U)); },
                              "no memory"));
    CHECK(device.gl().GetError() == GL_INVALID_ENUM);
    static_cast<void>(device.take_messages());
}

TEST_CASE_FIXTURE(GlFixture, "textures of every format return what was uploaded") {
    for (const Format format : {Format::rgba8, Format::srgb8_alpha8, Format::rgba16f, Format::rgba32f,
                                Format::rg32f, Format::r32f, Format::rg16f, Format::r16f, Format::r32ui}) {
        CAPTURE(to_string(format));
        Texture texture(device, "texture", {.size = {3, 5}, .format = format});
        const auto texels = ramp(std::size_t{15} * bytes_per_texel(format));
        texture.upload(texels);
        CHECK(texture.read() == texels);
    }
    Texture depth(device, "depth", {.size = {2, 1}, .format = Format::depth32f});
    const std::array depths = {0.25F, 1.0F};
    depth.upload(std::as_bytes(std::span(depths)));
    CHECK(depth.read_floats() == std::vector{0.25F, 1.0F});
}

TEST_CASE_FIXTURE(GlFixture, "a texture has the requested format, size and number of bytes") {
    const Texture texture(device, "texture", {.size = {8, 4}, .format = Format::rg16f, .mips = 4});
    const auto parameter = [&](GLint level, GLenum name) {
        GLint value = 0;
        device.gl().GetTextureLevelParameteriv(texture.name(), level, name, &value);
        return value;
    };
    CHECK(parameter(0, GL_TEXTURE_INTERNAL_FORMAT) == GL_RG16F);
    CHECK(parameter(3, GL_TEXTURE_WIDTH) == 1);
    CHECK(parameter(1, GL_TEXTURE_WIDTH) == 4);
    CHECK(texture.level_size(1) == glm::uvec2(4, 2));
    CHECK(texture.level_size(3) == glm::uvec2(1, 1));
    CHECK(texture.bytes() == (32 + 8 + 2 + 1) * 4);
    CHECK(device.live().texture_bytes == texture.bytes());
}

TEST_CASE_FIXTURE(GlFixture, "layers and faces are addressed separately") {
    for (const TextureShape shape : {TextureShape::array, TextureShape::cube_array}) {
        Texture texture(device, "layers",
                        {.size = {2, 2}, .format = Format::r32f, .shape = shape, .layers = 12});
        for (std::uint32_t layer = 0; layer < 12; ++layer) {
            const std::vector<float> texels(4, static_cast<float>(layer));
            texture.upload(std::as_bytes(std::span(texels)), 0, layer);
        }
        for (std::uint32_t layer = 0; layer < 12; ++layer) {
            CHECK(texture.read_floats(0, layer) == std::vector<float>(4, static_cast<float>(layer)));
        }
    }
}

TEST_CASE_FIXTURE(GlFixture, "mip maps are averages") {
    Texture texture(device, "mips", {.size = {4, 4}, .format = Format::r32f, .mips = 3});
    std::vector<float> texels(16);
    for (std::size_t i = 0; i < 16; ++i) texels[i] = static_cast<float>(i);
    texture.upload(std::as_bytes(std::span(texels)));
    texture.generate_mips();
    // Means of 4 or 16 small integers: exact in binary.
    CHECK(texture.read_floats(1) == std::vector{2.5F, 4.5F, 10.5F, 12.5F});
    CHECK(texture.read_floats(2) == std::vector{7.5F});
}

TEST_CASE_FIXTURE(GlFixture,
                  "uploads and reads ignore the host's pixel transfer state and leave it unchanged") {
    const Buffer foreign(device, "host's pixels", 1024);
    device.gl().PixelStorei(GL_UNPACK_ROW_LENGTH, 7);
    device.gl().PixelStorei(GL_PACK_SKIP_ROWS, 2);
    device.gl().BindBuffer(GL_PIXEL_UNPACK_BUFFER, foreign.name());
    device.gl().BindBuffer(GL_PIXEL_PACK_BUFFER, foreign.name());

    Texture texture(device, "texture", {.size = {3, 3}, .format = Format::r16f});
    const auto texels = ramp(18);
    texture.upload(texels);
    CHECK(texture.read() == texels);

    const auto value = [&](GLenum name) {
        GLint integer = 0;
        device.gl().GetIntegerv(name, &integer);
        return integer;
    };
    CHECK(value(GL_UNPACK_ROW_LENGTH) == 7);
    CHECK(value(GL_PACK_SKIP_ROWS) == 2);
    CHECK(value(GL_PIXEL_UNPACK_BUFFER_BINDING) == static_cast<GLint>(foreign.name()));
    CHECK(value(GL_PIXEL_PACK_BUFFER_BINDING) == static_cast<GLint>(foreign.name()));
}

TEST_CASE_FIXTURE(GlFixture, "invalid textures are refused by name, and no object is left") {
    const std::uint32_t side = device.limits().texture_size;
    const std::uint32_t layers = device.limits().texture_layers;
    const auto refuse = [&](const TextureDesc& desc, const char* why) {
        CHECK(throws<GlError>([&] { static_cast<void>(Texture(device, "odd", desc)); }, why));
        CHECK(throws<GlError>([&] { static_cast<void>(Texture(device, "odd", desc)); }, "texture \"odd\""));
    };
    refuse({.size = {0, 4}}, "a side has no texels");
    refuse({.size = {side + 1, 1}}, "texels a side");
    refuse({.shape = TextureShape::array, .layers = 0}, "0 layers");
    refuse({.shape = TextureShape::array, .layers = layers + 1}, "layers");
    refuse({.layers = 2}, "a flat texture has one layer");
    refuse({.shape = TextureShape::cube_array, .layers = 7}, "square faces");
    refuse({.size = {2, 3}, .shape = TextureShape::cube_array, .layers = 6}, "square faces");
    refuse({.mips = 0}, "0 mip levels");
    refuse({.size = {8, 2}, .mips = 5}, "5 mip levels");
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "uploads and reads outside of a texture are refused") {
    Texture texture(device, "texture", {.size = {2, 2}});
    CHECK_THROWS_AS(texture.upload(ramp(15)), GlError);
    CHECK_THROWS_AS(texture.upload(ramp(16), 1), GlError);
    CHECK_THROWS_AS(static_cast<void>(texture.read(0, 1)), GlError);
}

TEST_CASE_FIXTURE(GlFixture, "a framebuffer is complete or reports why not") {
    const Texture colour(device, "colour", {.size = {4, 4}, .format = Format::rgba16f});
    const Texture faces(
        device, "faces",
        {.size = {4, 4}, .format = Format::depth32f, .shape = TextureShape::cube_array, .layers = 6});
    Framebuffer framebuffer(device, "target");
    CHECK_THROWS_WITH_AS(framebuffer.check(), "framebuffer \"target\" is incomplete: there is no attachment",
                         GlError);
    framebuffer.attach_colour(0, colour.name());
    framebuffer.attach_depth(faces.name());
    CHECK(throws<GlError>([&] { static_cast<void>(framebuffer.check()); }, "layered and flat"));
    framebuffer.attach_depth_layer(faces.name(), 3);
    framebuffer.draw_buffers(1);
    CHECK_NOTHROW(framebuffer.check());

    const float depth = 0.5F;
    device.gl().ClearNamedFramebufferfv(framebuffer.name(), GL_DEPTH, 0, &depth);
    CHECK(faces.read_floats(0, 3) == std::vector<float>(16, 0.5F));
    framebuffer.draw_buffers(0);
    framebuffer.attach_colour(0, 0);
    CHECK_NOTHROW(framebuffer.check());
}

TEST_CASE_FIXTURE(GlFixture, "a sampler filters as described") {
    const Sampler sampler(device, "repeating",
                          {.min_filter = GL_NEAREST, .wrap_v = GL_REPEAT, .anisotropy = 1e6F});
    const auto parameter = [&](GLenum name) {
        GLint value = 0;
        device.gl().GetSamplerParameteriv(sampler.name(), name, &value);
        return value;
    };
    CHECK(parameter(GL_TEXTURE_MIN_FILTER) == GL_NEAREST);
    CHECK(parameter(GL_TEXTURE_MAG_FILTER) == GL_LINEAR);
    CHECK(parameter(GL_TEXTURE_WRAP_S) == GL_CLAMP_TO_EDGE);
    CHECK(parameter(GL_TEXTURE_WRAP_T) == GL_REPEAT);
}

TEST_CASE_FIXTURE(GlFixture,
                  "a view of a layer of a mip level shares the texture's storage, and may outlive it") {
    const ObjectCounts before = device.live();
    {
        std::optional<Texture> cubes(std::in_place, device, "cubes",
                                     TextureDesc{.size = {8, 8},
                                                 .format = Format::r32f,
                                                 .shape = TextureShape::cube_array,
                                                 .layers = 12,
                                                 .mips = 3});
        const std::uint64_t bytes = device.live().texture_bytes;
        const Texture face(device, "face", cubes->name(), cubes->desc(), 1, 7);
        CHECK(device.live().texture_bytes == bytes);
        CHECK(face.desc() == TextureDesc{.size = {4, 4}, .format = Format::r32f});
        const float five = 5.0F;
        device.gl().ClearTexImage(face.name(), 0, GL_RED, GL_FLOAT, &five);
        CHECK(cubes->read_floats(1, 7) == std::vector<float>(16, 5.0F));
        cubes.reset();
        CHECK(face.read_floats() == std::vector<float>(16, 5.0F));
    }
    CHECK(device.live() == before);
}

}  // TEST_SUITE("gl objects")
