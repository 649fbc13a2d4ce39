#include <doctest/doctest.h>

#include <array>
#include <memory>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "tests/memory.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("lifetime") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{16, 12};

/// One of 48 configurations.
Configuration numbered_configuration(std::uint32_t i) {
    Configuration configuration;
    configuration.path = static_cast<ShadingPath>(i % 2);
    configuration.show = static_cast<Show>(i / 2 % 3);
    configuration.vpls = {.count = 4U << (i / 6 % 2), .bounces = 1 + i / 6 % 2};
    configuration.shadows.cube_resolution = 16U << (i / 12 % 2);
    configuration.shadows.map_resolution = 32;
    configuration.tone_map.enabled = i / 24 % 2 == 0;
    configuration.indirect = i % 5 != 0;
    return configuration;
}

}  // namespace

TEST_CASE_FIXTURE(RenderFixture,
                  "hundreds of configurations and target sizes leak neither objects nor memory") {
    const Scene scene = cornell_box();
    const RenderTarget target(device, size);
    // Waits for each frame, because the number of time queries in use depends on the number of frames in
    // flight.
    const auto draw = [&](const Target& to) {
        renderer.render(scene.world, scene.camera, to);
        static_cast<void>(renderer.take_frames(true));
    };
    const auto round = [&](std::uint32_t switches, std::uint32_t resizes) {
        for (std::uint32_t i = 0; i < switches; ++i) {
            configure(numbered_configuration(i));
            draw(target.target());
        }
        for (std::uint32_t i = 0; i < resizes; ++i) {
            draw({target.target().framebuffer, {1 + i % 16, 1 + i % 12}});
        }
        // The free pool, and the sizes that buffers have grown to, must be the same at the end of each
        // round: two graphs without indirect light leave nothing of it.
        for (const std::uint32_t without_indirect : {0U, 5U}) {
            configure(numbered_configuration(without_indirect));
            draw(target.target());
        }
        configure(linear_configuration());
        draw(target.target());
        draw(target.target());
    };
    round(96, 48);  // every configuration and every size once, to fill pools and the driver's caches
    const gl::ObjectCounts before = device_of(renderer).live();
    const std::uint64_t memory_before = test::resident_bytes();
    round(480, 96);
    CHECK(device_of(renderer).live() == before);
    // Allows for fragmentation by the allocator. A leak of one small object per switch would not show
    // here, but is counted above. AddressSanitizer delays freeing memory, and finds leaks by itself. What a
    // GPU's driver keeps in this process is its own affair.
    if (test::is_sanitized || !device.limits().software) return;
    CHECK(test::resident_bytes() < memory_before + (4U << 20U));
}

TEST_CASE_FIXTURE(RenderFixture, "a sky, a sun and a lamp that come and go leak no objects") {
    Scene scene = cornell_box();
    Configuration small = linear_configuration();
    small.vpls.count = 8;
    configure(small);
    const auto picture = std::make_shared<const SkyPicture>(
        SkyPicture{64, 32, std::vector(std::size_t{64} * 32, glm::vec3(0.5F))});
    const auto come_and_go = [&] {
        const Entity sky = add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = picture});
        const Entity sun = add(scene.world, looking({0, 1, 3}, {0, 0, 0}), DirectionalLight{});
        const Entity lamp = add(scene.world, upside_down_at({0.0F, 1.5F, 0.0F}),
                                MeshInstance{square(0.2F, emitter(glm::vec3(1.0F)))});
        static_cast<void>(render(scene, size));
        for (const Entity entity : {sky, sun, lamp}) {
            scene.world.destroy(entity);
            static_cast<void>(render(scene, size));
        }
        static_cast<void>(renderer.take_frames(true));
    };
    come_and_go();  // fills the free pool
    const gl::ObjectCounts before = device_of(renderer).live();
    come_and_go();
    CHECK(device_of(renderer).live() == before);
}

TEST_CASE_FIXTURE(RenderFixture, "removing a mesh frees its texture, and nothing leaks") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const auto come_and_go = [&] {
        Material material;
        material.base_colour_texture = std::make_shared<const Image>(
            Image{.width = 64, .height = 64, .texels = std::vector(64 * 64, glm::u8vec4(200))});
        const auto mesh = square(0.5F, std::make_shared<const Material>(material));
        const std::uint32_t textures = device_of(renderer).live()[gl::ObjectKind::texture];
        const Entity extra = add(scene.world, at({0, 0.5F, 0.5F}), MeshInstance{mesh});
        CHECK(render(scene, size) != before);
        CHECK(device_of(renderer).live()[gl::ObjectKind::texture] == textures + 1);
        scene.world.destroy(extra);
        CHECK(render(scene, size) == before);
        static_cast<void>(renderer.take_frames(true));
    };
    come_and_go();  // buffers grow and keep their size
    const gl::ObjectCounts objects = device_of(renderer).live();
    for (int i = 0; i < 4; ++i) come_and_go();
    CHECK(device_of(renderer).live() == objects);
}

TEST_CASE_FIXTURE(RenderFixture, "two renderers share a context and a target without affecting each other") {
    configure(linear_configuration());
    TestedRenderer other(context->get_proc());
    REQUIRE(other.configure(linear_configuration(ShadingPath::forward)).empty());
    Scene scene = cornell_box();
    Scene box = furnace_box(0.5F);
    const Picture alone = render(scene, size);
    const RenderTarget target(device, size);
    Picture box_alone;
    for (int i = 0; i < 3; ++i) {
        other.render(box.world, box.camera, target.target());
        const Picture picture = target.read();
        if (i > 0) CHECK(picture == box_alone);
        box_alone = picture;
        CHECK(mean(picture) > 0.01);
        CHECK(render(scene, size) == alone);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "renderers in two contexts can be used in turns") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture alone = render(scene, size);
    const auto second = make_current_context();
    {
        TestedRenderer other(second->get_proc());
        REQUIRE(other.configure(linear_configuration()).empty());
        for (int i = 0; i < 3; ++i) {
            second->make_current();
            const RenderTarget target(device_of(other), size);
            other.render(scene.world, scene.camera, target.target());
            CHECK(target.read() == alone);
            context->make_current();
            renderer.invalidate();
            CHECK(render(scene, size) == alone);
            second->make_current();
        }
    }
    context->make_current();
}

}  // TEST_SUITE("lifetime")
