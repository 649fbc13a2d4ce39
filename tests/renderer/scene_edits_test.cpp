// Meshes, images and materials that come and go: what is uploaded, and what memory is taken.

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "tests/renderer/path_fixture.hpp"
#include "tests/seed.hpp"
#include "tests/uploads.hpp"

TEST_SUITE("scene edits") {

using namespace candela;

namespace {

constexpr glm::uvec2 picture_size{40, 30};

std::shared_ptr<const Material> textured(std::uint32_t texture_size, std::uint32_t seed) {
    std::mt19937 random(seed);
    Image image{.width = texture_size, .height = texture_size, .texels = {}};
    for (std::uint32_t i = 0; i < texture_size * texture_size; ++i) {
        const auto texel = static_cast<std::uint32_t>(random());
        image.texels.emplace_back(texel & 255U, texel >> 8U & 255U, texel >> 16U & 255U, texel >> 24U);
    }
    Material material;
    material.base_colour_texture = std::make_shared<const Image>(std::move(image));
    material.double_sided = true;
    material.alpha_mode = seed % 4 == 0 ? AlphaMode::mask : AlphaMode::opaque;
    return std::make_shared<const Material>(std::move(material));
}

Scene lit_ground() {
    Scene scene = ground();
    scene.world.set(scene.light, at({0.3F, 2.0F, 0.4F}));
    scene.world.set(scene.light, PointLight{.intensity = 2.0F});
    return scene;
}

Configuration traced(VplPlacement placement) {
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = placement;
    configuration.visibility.method = VplVisibility::rays;
    return configuration;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "only what comes or moves is uploaded") {
    TestedRenderer renderer(Uploads::counting(context->get_proc()));
    Configuration configuration = traced(VplPlacement::paths);
    REQUIRE(renderer.configure(configuration).empty());
    Scene scene = lit_ground();
    add(scene.world, at({0, 1, 0}), MeshInstance{soup(20'000, 3)});
    add(scene.world, at({1, 1, 0}), MeshInstance{square(0.5F, textured(512, 1))});
    const RenderTarget target(device, picture_size);
    const auto uploaded = [&] {
        static_cast<void>(Uploads::take());
        renderer.render(scene.world, scene.camera, target.target());
        return Uploads::take();
    };
    // 20,000 triangles: 60,000 vertices and indices, 96 bytes for each triangle traced. The rest is less:
    // nodes of the hierarchy and 1 MiB of texels.
    const std::uint64_t all = uploaded();
    CHECK(all > 60'000 * (sizeof(Vertex) + 4) + 20'000 * 96);

    // A box of 12 triangles, and tables that do not depend on the number of triangles.
    constexpr std::uint64_t little = 100'000;
    static_assert(little < 60'000 * sizeof(Vertex) / 20);
    const Entity box =
        add(scene.world, at({0, 0.3F, 1}), MeshInstance{box_inwards(0.2F, diffuse({1, 0, 0}))});
    CHECK(uploaded() < little);
    scene.world.set(box, at({0.2F, 0.3F, 1}));
    CHECK(uploaded() < little);
    scene.world.set(box, MeshInstance{square(0.2F, textured(32, 2))});
    CHECK(uploaded() < little);
    scene.world.destroy(box);
    CHECK(uploaded() < little);

    renderer.invalidate();
    CHECK(uploaded() > all / 2);
}

TEST_CASE_FIXTURE(GlFixture, "what is uploaded when a thing comes or goes does not depend on how many stay") {
    const auto uploads_among = [&](std::uint32_t things) {
        TestedRenderer renderer(Uploads::counting(context->get_proc()));
        REQUIRE(renderer.configure(direct_only()).empty());
        Scene scene = ground();  // without lights, whose shadow maps list all that casts shadows
        const MeshInstance small{box_inwards(0.01F, diffuse({0.2F, 0.4F, 0.8F}))};
        const auto place = [](std::uint32_t i) {
            return at({0.04F * static_cast<float>(i % 64) - 1.3F, 0.5F, -0.04F * static_cast<float>(i / 64)});
        };
        std::vector<Entity> all;
        for (std::uint32_t i = 0; i < things; ++i) all.push_back(add(scene.world, place(i), small));
        const RenderTarget target(device, picture_size);
        const auto uploaded = [&] {
            static_cast<void>(Uploads::take());
            renderer.render(scene.world, scene.camera, target.target());
            return Uploads::take();
        };
        static_cast<void>(uploaded());
        std::vector<std::uint64_t> bytes;
        for (std::uint32_t i = 0; i < 9; ++i) {
            scene.world.destroy(all[things / 10 * (i + 1)]);
            bytes.push_back(uploaded());
            static_cast<void>(add(scene.world, place(things / 2 + 3 * i), small));
            bytes.push_back(uploaded());
        }
        std::ranges::nth_element(bytes, bytes.begin() + 9);
        return bytes[9];
    };
    // The way up the hierarchy is longer by the logarithm to base 2 of 16: four nodes of 64 bytes, in as many
    // wide nodes. A list of all would be 16 times as long.
    CHECK(uploads_among(8000) < uploads_among(500) + 2000);
}

TEST_CASE_FIXTURE(PathFixture, "light does not leak through a wall under which the floor has moved") {
    // Which part of a floor's cell lies behind the wall changes, though nothing has moved near the rays
    // that find it: they run 0.15 m above the floor, and the floor is flat.
    Scene scene = lit_ground();
    const Entity floor =
        add(scene.world, at({0, 0.05F, 0}), MeshInstance{square(1.0F, diffuse({0.9F, 0.5F, 0.2F}))});
    const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1));
    add(scene.world, Transform{.translation = {0.3F, 0.55F, 0}, .rotation = upright},
        MeshInstance{square(0.5F, diffuse(glm::vec3(0.5F), true))});
    Configuration configuration = traced(VplPlacement::surfels);
    configuration.vpls.count = 200;
    configure(configuration);
    static_cast<void>(render(scene, picture_size));
    for (const float x : {0.2F, 0.45F, -0.3F}) {
        CAPTURE(x);
        scene.world.set(floor, at({x, 0.05F, 0}));
        CHECK(render(scene, picture_size) == from_scratch(scene, picture_size));
    }
}

TEST_CASE_FIXTURE(PathFixture,
                  "whatever comes, goes and takes the place of others, a frame is that of a new renderer") {
    std::mt19937 random(test_seed(41));
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
    Material glass;
    glass.base_colour = {0.3F, 0.5F, 0.9F, 0.5F};
    glass.alpha_mode = AlphaMode::blend;
    // Opaque, masked and blended, with images and without.
    const std::vector meshes{box_inwards(0.15F, diffuse({0.9F, 0.2F, 0.2F})),
                             box_inwards(0.2F, diffuse({0.2F, 0.9F, 0.2F}, true)),
                             square(0.3F, textured(8, 1)), square(0.25F, textured(8, 4)),
                             square(0.2F, std::make_shared<const Material>(glass))};
    const auto anywhere = [&] {
        const auto along = [&] { return 0.1F * static_cast<float>(below(16)) - 0.75F; };
        const float x = along(), z = along();
        // Some are mirrored.
        return Transform{.translation = {x, 0.3F + 0.1F * static_cast<float>(below(6)), z},
                         .scale = {below(3) == 0 ? -1.0F : 1.0F, 1.0F, 1.0F}};
    };
    Scene scene = lit_ground();
    Configuration configuration = traced(VplPlacement::paths);
    configuration.vpls.count = 8;
    configure(configuration);
    std::vector<Entity> things;
    for (int frame = 0; frame < 40; ++frame) {
        for (std::uint32_t i = below(3); i > 0 && !things.empty(); --i) {
            const auto gone = things.begin() + below(static_cast<std::uint32_t>(things.size()));
            scene.world.destroy(*gone);
            things.erase(gone);
        }
        for (std::uint32_t i = below(things.size() < 10 ? 5 : 2); i > 0; --i) {
            const auto& mesh = meshes[below(static_cast<std::uint32_t>(meshes.size()))];
            things.push_back(add(scene.world, anywhere(), MeshInstance{mesh}));
        }
        if (!things.empty() && below(2) == 0) {
            scene.world.set(things[below(static_cast<std::uint32_t>(things.size()))], anywhere());
        }
        CAPTURE(frame);
        const bool same = render(scene, picture_size) == from_scratch(scene, picture_size);
        REQUIRE(same);
    }
}

TEST_CASE_FIXTURE(PathFixture,
                  "which of two surfaces at the same place is hit depends on the entities alone") {
    Scene scene = lit_ground();
    const Entity spare = scene.world.create();  // its index is smaller than those of the surfaces
    const auto red = square(0.6F, diffuse({0.9F, 0.1F, 0.1F}, true));
    const auto blue = square(0.6F, diffuse({0.1F, 0.1F, 0.9F}, true));
    // They stand on the ground, which their light falls on.
    const Transform upright{.translation = {-0.3F, 0.5F, 0},
                            .rotation = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 0, 1))};
    add(scene.world, upright, MeshInstance{red});
    const Entity hidden = add(scene.world, upright, MeshInstance{blue});
    configure(traced(VplPlacement::paths));
    const Picture before = render(scene, picture_size);
    // Another one comes in its place, in the list of the world, too, with the spare's index.
    scene.world.destroy(hidden);
    scene.world.destroy(spare);
    const Entity shown = add(scene.world, upright, MeshInstance{blue});
    REQUIRE(shown.index == spare.index);
    const Picture now = render(scene, picture_size);
    CHECK(now != before);
    CHECK(now == from_scratch(scene, picture_size));
    // Whoever has the index of the one before gets ids of its own.
    add(scene.world, at({0.4F, 0.9F, 0}), MeshInstance{red});
    CHECK(render(scene, picture_size) == from_scratch(scene, picture_size));
}

TEST_CASE_FIXTURE(PathFixture, "a hierarchy that is built again after a move may be larger than it was") {
    // A few things come at a time, seven times as many as were there. When all of them move, the hierarchy
    // over them is built again.
    Scene scene = lit_ground();
    const Entity large = add(scene.world, at({0, 1, 0}), MeshInstance{soup(3000, 5)});
    const MeshInstance small{box_inwards(0.02F, diffuse({0.8F, 0.4F, 0.2F}))};
    std::mt19937 random(7);
    const auto anywhere = [&] {
        std::uniform_real_distribution<float> along(-0.9F, 0.9F);
        const float x = along(random), y = along(random);
        return at({x, 1.0F + y, along(random)});
    };
    std::vector<Entity> things;
    for (int i = 0; i < 100; ++i) things.push_back(add(scene.world, anywhere(), small));
    configure(traced(VplPlacement::paths));
    static_cast<void>(render(scene, picture_size));
    scene.world.destroy(large);
    while (things.size() < 700) {
        static_cast<void>(render(scene, picture_size));
        for (std::size_t i = things.size() / 5; i > 0; --i)
            things.push_back(add(scene.world, anywhere(), small));
    }
    static_cast<void>(render(scene, picture_size));
    for (const Entity thing : things) scene.world.set(thing, anywhere());
    CHECK(render(scene, picture_size) == from_scratch(scene, picture_size));
}

TEST_CASE_FIXTURE(GlFixture, "what is gone takes no memory for long") {
    TestedRenderer renderer(context->get_proc());
    REQUIRE(renderer.configure(direct_only()).empty());
    Scene scene = lit_ground();
    const RenderTarget target(device, picture_size);
    const auto bytes = [&] {
        renderer.render(scene.world, scene.camera, target.target());
        return renderer.report().memory.buffer_bytes;
    };
    Entity mesh = add(scene.world, at({0, 1, 0}), MeshInstance{soup(5000, 0)});
    static_cast<void>(bytes());
    std::uint64_t most = 0;
    std::uint64_t first = 0;
    for (std::uint32_t i = 1; i < 20; ++i) {
        const Entity next = add(scene.world, at({0, 1, 0}), MeshInstance{soup(5000, i)});
        most = std::max(most, bytes());
        scene.world.destroy(std::exchange(mesh, next));
        const std::uint64_t now = bytes();
        first = i == 1 ? now : first;
    }
    // Two are in the world at a time; buffers may be twice as large as what is in them, and grow by half.
    CHECK(most <= 3 * first);
}

}  // TEST_SUITE("scene edits")
