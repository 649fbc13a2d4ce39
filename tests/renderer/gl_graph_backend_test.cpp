#include <doctest/doctest.h>

#include <array>
#include <vector>

#include <candela/gl_backend.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include "renderer/gl/graph_backend.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gl graph backend") {

using namespace candela;
using namespace candela::gl;

namespace {

GLint get(const Device& device, GLenum name) {
    GLint value = 0;
    device.gl().GetIntegerv(name, &value);
    return value;
}

/// Runs a pass that clears its first colour attachment to `value`.
void clear_pass(const Device& device, GraphBackend& backend, const PassTargets& targets, float value) {
    const std::array colour = {value, value, value, value};
    backend.begin_pass("clear", 0, &targets);
    device.gl().ClearBufferfv(GL_COLOR, 0, colour.data());
    backend.end_pass();
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "objects are created as described and released") {
    GraphBackend backend(device);
    const ObjectCounts before = device.live();
    const ObjectId texture = backend.create_texture("picture", {.size = {8, 4}, .format = Format::rgba16f});
    const ObjectId buffer = backend.create_buffer("list", {.count = 10, .stride = 12});
    CHECK(backend.texture(texture).desc() == TextureDesc{.size = {8, 4}, .format = Format::rgba16f});
    CHECK(backend.texture(texture).name() == texture);
    CHECK(backend.buffer(buffer).bytes() == 120);
    CHECK(device.live()[ObjectKind::texture] == 1);
    CHECK(device.live()[ObjectKind::buffer] == 1);
    backend.destroy_texture(texture);
    backend.destroy_buffer(buffer);
    CHECK(device.live() == before);
}

TEST_CASE_FIXTURE(GlFixture, "objects are bound at their binding points") {
    GraphBackend backend(device);
    const TextureDesc colour{.size = {8, 4}, .format = Format::rgba16f};
    const ObjectId sampled = backend.create_texture("sampled", colour);
    const ObjectId image = backend.create_texture("image", colour);
    const ObjectId list = backend.create_buffer("list", {.count = 10, .stride = 16});
    const ObjectId constants = backend.create_buffer("constants", {.count = 1, .stride = 16});
    backend.begin_pass("pass", 0, nullptr);
    backend.bind_texture(sampled, colour, {Usage::sampled, 2});
    backend.bind_texture(image, colour, {Usage::storage, 0});
    backend.bind_buffer(list, {Usage::storage, 5});
    backend.bind_buffer(constants, {Usage::uniform, 1});
    backend.bind_buffer(list, Usage::indirect);
    const auto bound = [&](GLenum what, GLuint index) {
        GLint name = -1;
        device.gl().GetIntegeri_v(what, index, &name);
        return static_cast<ObjectId>(name);
    };
    const auto texture_at = [&](GLuint unit, GLenum what) {
        device.gl().ActiveTexture(GL_TEXTURE0 + unit);
        GLint name = -1;
        device.gl().GetIntegerv(what, &name);
        return static_cast<ObjectId>(name);
    };
    CHECK(texture_at(2, GL_TEXTURE_BINDING_2D) == sampled);
    CHECK(texture_at(2, GL_SAMPLER_BINDING) == 0);
    CHECK(bound(GL_IMAGE_BINDING_NAME, 0) == image);
    CHECK(bound(GL_IMAGE_BINDING_FORMAT, 0) == GL_RGBA16F);
    CHECK(bound(GL_SHADER_STORAGE_BUFFER_BINDING, 5) == list);
    CHECK(bound(GL_UNIFORM_BUFFER_BINDING, 1) == constants);
    CHECK(texture_at(0, GL_DISPATCH_INDIRECT_BUFFER_BINDING) == list);
    CHECK(texture_at(0, GL_DRAW_INDIRECT_BUFFER_BINDING) == list);
    backend.end_pass();
}

TEST_CASE_FIXTURE(GlFixture, "a buffer is bound as texels of four words each, as many as shaders can reach") {
    GraphBackend backend(device);
    const ObjectCounts before = device.live();
    const ObjectId list = backend.create_buffer("list", {.count = 3, .stride = 48});
    backend.bind_buffer(list, {Usage::sampled, 2});
    device.gl().ActiveTexture(GL_TEXTURE2);
    const auto texels = static_cast<GLuint>(get(device, GL_TEXTURE_BINDING_BUFFER));
    const auto parameter = [&](GLenum what) {
        GLint value = 0;
        device.gl().GetTextureLevelParameteriv(texels, 0, what, &value);
        return value;
    };
    CHECK(parameter(GL_TEXTURE_WIDTH) == 3 * 48 / 16);
    CHECK(parameter(GL_TEXTURE_INTERNAL_FORMAT) == GL_RGBA32UI);
    backend.destroy_buffer(list);
    CHECK(device.live() == before);

    Limits limits = device.limits();
    limits.buffer_texels = 8;
    device.pretend(limits);
    const ObjectId large = backend.create_buffer("large", {.count = 3, .stride = 48});
    CHECK_THROWS_WITH_AS(backend.bind_buffer(large, {Usage::sampled, 2}),
                         "buffer \"large\": 9 texels, of which shaders of this driver reach 8", MemoryError);
}

TEST_CASE_FIXTURE(GlFixture, "a pass draws into its targets, from a known state") {
    GraphBackend backend(device);
    const std::array colours = {backend.create_texture("a", {.size = {4, 2}, .format = Format::r32f}),
                                backend.create_texture("b", {.size = {4, 2}, .format = Format::r32f})};
    const ObjectId depth = backend.create_texture("depth", {.size = {4, 2}, .format = Format::depth32f});
    device.gl().Enable(GL_DEPTH_TEST);
    device.gl().Enable(GL_BLEND);
    device.gl().DepthMask(GL_FALSE);

    PassTargets targets{.colour = colours, .depth = depth, .writes_depth = true, .size = {4, 2}};
    backend.begin_pass("pass", 3, &targets);
    CHECK(device.gl().IsEnabled(GL_DEPTH_TEST) == GL_FALSE);
    CHECK(device.gl().IsEnabled(GL_BLEND) == GL_FALSE);
    std::array<GLint, 4> viewport{};
    device.gl().GetIntegerv(GL_VIEWPORT, viewport.data());
    CHECK(viewport == std::array{0, 0, 4, 2});
    for (GLint i = 0; i < 2; ++i) {
        const std::array value = {static_cast<float>(i + 1), 0.0F, 0.0F, 0.0F};
        device.gl().ClearBufferfv(GL_COLOR, i, value.data());
    }
    const float middle = 0.5F;
    device.gl().ClearBufferfv(GL_DEPTH, 0, &middle);
    backend.end_pass();

    CHECK(backend.texture(colours[0]).read_floats() == std::vector<float>(8, 1.0F));
    CHECK(backend.texture(colours[1]).read_floats() == std::vector<float>(8, 2.0F));
    CHECK(backend.texture(depth).read_floats() == std::vector<float>(8, 0.5F));

    targets.writes_depth = false;
    backend.begin_pass("tests depth", 4, &targets);
    const float other = 0.25F;
    device.gl().ClearBufferfv(GL_DEPTH, 0, &other);
    backend.end_pass();
    CHECK(backend.texture(depth).read_floats() == std::vector<float>(8, 0.5F));
}

TEST_CASE_FIXTURE(GlFixture, "framebuffers are created once, and destroyed with their attachments") {
    GraphBackend backend(device);
    const TextureDesc desc{.size = {4, 4}, .format = Format::r32f};
    std::array target = {backend.create_texture("target", desc)};
    for (int frame = 0; frame < 5; ++frame) {
        clear_pass(device, backend, {.colour = target, .size = {4, 4}}, 1.0F);
    }
    CHECK(device.live()[ObjectKind::framebuffer] == 1);
    backend.destroy_texture(target[0]);
    CHECK(device.live()[ObjectKind::framebuffer] == 0);

    // The driver reuses the freed name: the framebuffer of the old texture must not be found for the new
    // one.
    target = {backend.create_texture("next", desc)};
    clear_pass(device, backend, {.colour = target, .size = {4, 4}}, 2.0F);
    CHECK(backend.texture(target[0]).read_floats() == std::vector<float>(16, 2.0F));
}

TEST_CASE_FIXTURE(GlFixture, "a digest depends on every layer, level and byte of an object") {
    GraphBackend backend(device);
    const auto fill = [&](ObjectId texture, std::uint32_t level, std::uint32_t layer, float value) {
        Framebuffer target(device, "layer");
        if (backend.texture(texture).desc().shape == TextureShape::flat) {
            target.attach_depth(texture, level);
        } else {
            target.attach_depth_layer(texture, layer, level);
        }
        target.bind();
        device.gl().ClearBufferfv(GL_DEPTH, 0, &value);
    };
    for (const TextureShape shape : {TextureShape::flat, TextureShape::array, TextureShape::cube_array}) {
        const std::uint32_t layers = shape == TextureShape::flat ? 1 : 6;
        const ObjectId texture = backend.create_texture(
            "depth",
            {.size = {4, 4}, .format = Format::depth32f, .shape = shape, .layers = layers, .mips = 2});
        for (std::uint32_t layer = 0; layer < layers; ++layer) {
            fill(texture, 0, layer, 0.25F);
            fill(texture, 1, layer, 0.25F);
        }
        const std::uint64_t before = backend.texture_digest(texture);
        CHECK(backend.texture_digest(texture) == before);
        for (const std::uint32_t level : {0U, 1U}) {
            fill(texture, level, layers - 1, 0.5F);
            CHECK(backend.texture_digest(texture) != before);
            fill(texture, level, layers - 1, 0.25F);
            CHECK(backend.texture_digest(texture) == before);
        }
    }

    const ObjectId buffer = backend.create_buffer("bytes", {.count = 11, .stride = 1});
    std::array<std::uint8_t, 11> bytes{};
    const auto digest = [&] {
        device.gl().NamedBufferSubData(buffer, 0, sizeof(bytes), bytes.data());
        return backend.buffer_digest(buffer);
    };
    const std::uint64_t before = digest();
    for (std::uint8_t& byte : bytes) {
        byte = 1;
        CHECK(digest() != before);
        byte = 0;
    }
    CHECK(digest() == before);
}

TEST_CASE_FIXTURE(GlFixture, "a pass resets dual-source blending, so that it may have several targets") {
    GraphBackend backend(device);
    const std::array colours = {backend.create_texture("a", {.size = {4, 2}, .format = Format::r32f}),
                                backend.create_texture("b", {.size = {4, 2}, .format = Format::r32f})};
    device.gl().BlendFunc(GL_ONE, GL_ONE_MINUS_SRC1_COLOR);
    const PassTargets targets{.colour = colours, .depth = 0, .size = {4, 2}};
    backend.begin_pass("pass", 0, &targets);
    GLint factor = 0;
    device.gl().GetIntegerv(GL_BLEND_DST_RGB, &factor);
    CHECK(factor == GL_ZERO);
    backend.end_pass();
}

TEST_CASE_FIXTURE(GlFixture, "passes are debug groups, and timed within frames") {
    GraphBackend backend(device);
    const GLint outside = get(device, GL_DEBUG_GROUP_STACK_DEPTH);
    backend.begin_pass("untimed", 0, nullptr);
    CHECK(get(device, GL_DEBUG_GROUP_STACK_DEPTH) == outside + 1);
    backend.end_pass();
    CHECK(get(device, GL_DEBUG_GROUP_STACK_DEPTH) == outside);

    backend.timer().begin_frame(9);
    backend.begin_pass("timed", 5, nullptr);
    backend.end_pass();
    backend.timer().end_frame();
    const auto times = backend.timer().finish();
    REQUIRE(times.size() == 1);
    CHECK(times[0].frame == 9);
    REQUIRE(times[0].passes.size() == 1);
    CHECK(times[0].passes[0].pass == 5);
}

TEST_CASE_FIXTURE(GlFixture, "each barrier has the bits that GL defines") {
    CHECK(barrier_bits(Barrier::none) == 0);
    CHECK(barrier_bits(Barrier::storage | Barrier::command) ==
          (GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT));
    CHECK(barrier_bits(Barrier::vertex_attrib) == GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::element) == GL_ELEMENT_ARRAY_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::uniform) == GL_UNIFORM_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::texture_fetch) == GL_TEXTURE_FETCH_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::image_access) == GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::texture_update) == GL_TEXTURE_UPDATE_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::buffer_update) == GL_BUFFER_UPDATE_BARRIER_BIT);
    CHECK(barrier_bits(Barrier::framebuffer) == GL_FRAMEBUFFER_BARRIER_BIT);
    GraphBackend backend(device);
    backend.barrier(Barrier::storage | Barrier::texture_fetch);
    CHECK(device.gl().GetError() == GL_NO_ERROR);
}

TEST_CASE_FIXTURE(GlFixture, "a host's graph draws with GL, whatever state the host and its passes leave") {
    GlBackend gl(context->get_proc());
    FrameGraph graph;
    const auto cleared = [&](std::string_view name, TextureHandle target, int width, float value) {
        return graph.add(name, [&](Pass& pass) {
            pass.run([this, value, width](Execution&) {
                device.gl().Enable(GL_SCISSOR_TEST);  // is off again before the next pass
                device.gl().Scissor(0, 0, width, 2);
                const std::array colour{value, value, value, value};
                device.gl().ClearBufferfv(GL_COLOR, 0, colour.data());
            });
            return pass.write(target, Usage::colour_target);
        });
    };
    const TextureHandle blank = graph.texture("picture", {{4, 2}, Format::r32f}, Lifetime::persistent);
    const TextureHandle picture = cleared("part", cleared("all", blank, 4, 3.0F), 1, 5.0F);
    graph.add("end", [&](Pass& pass) {
        pass.read(picture, Usage::copy);
        pass.side_effect();
        pass.run([this](Execution&) { CHECK(device.gl().IsEnabled(GL_SCISSOR_TEST) == GL_FALSE); });
    });
    GraphRuntime runtime(gl.backend());
    runtime.switch_to(compile(std::move(graph)).take());
    device.gl().Enable(GL_RASTERIZER_DISCARD);  // the host's, which would keep all from being cleared
    gl.begin_frame(7);
    runtime.run(World());
    gl.end_frame();
    std::vector<float> texels(8);
    device.gl().GetTextureSubImage(runtime.object(picture), 0, 0, 0, 0, 4, 2, 1, GL_RED, GL_FLOAT,
                                   8 * sizeof(float), texels.data());
    CHECK(texels == std::vector<float>{5, 3, 3, 3, 5, 3, 3, 3});
    device.gl().Finish();
    const std::vector<FrameTime> times = gl.take_times();
    REQUIRE(times.size() == 1);
    CHECK(times[0].frame == 7);
    CHECK(times[0].passes.size() == 3);
}

}  // TEST_SUITE("gl graph backend")
