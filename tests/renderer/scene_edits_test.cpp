// Meshes, images and materials that come and go: what is uploaded, and the pictures.

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "tests/renderer/path_fixture.hpp"
#include "tests/seed.hpp"
#include "tests/uploads.hpp"

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

/// Random additions, removals and moves of meshes above the ground, each of which may be anything from two
/// to a thousand triangles, with an image or without.
class MeshEdits {
 public:
    MeshEdits(World& world, unsigned seed) : world_(&world), random_(seed) {}

    void next() {
        const std::uint32_t choice = draw(8);
        if (meshes_.empty() || choice < 3) {
            meshes_.push_back(add(*world_, somewhere(), MeshInstance{mesh()}));
        } else if (choice == 3) {
            // Coincides with another one.
            const Entity other = any();
            meshes_.push_back(add(*world_, world_->get<Transform>(other),
                                  MeshInstance{square(0.3F, diffuse(colour(), true))}));
        } else if (choice < 6) {
            const auto gone = meshes_.begin() + draw(static_cast<std::uint32_t>(meshes_.size()));
            world_->destroy(*gone);
            meshes_.erase(gone);
        } else if (choice == 6) {
            world_->set(any(), somewhere());
        } else {
            world_->set(any(), MeshInstance{mesh()});
        }
    }

 private:
    std::uint32_t draw(std::uint32_t choices) { return static_cast<std::uint32_t>(random_()) % choices; }
    float number() { return 0.01F * static_cast<float>(draw(100)); }
    glm::vec3 colour() {
        const float r = number(), g = number();
        return {r, g, number()};
    }
    Entity any() { return meshes_[draw(static_cast<std::uint32_t>(meshes_.size()))]; }

    Transform somewhere() {
        const float x = number() - 0.5F, y = 0.2F + 0.5F * number(), angle = 6.0F * number();
        return {.translation = {x, y, number() - 0.5F},
                .rotation = glm::angleAxis(angle, glm::normalize(glm::vec3(1, 2, 1))),
                .scale = {draw(4) == 0 ? -0.3F : 0.3F, 0.3F, 0.3F}};
    }

    std::shared_ptr<const Mesh> mesh() {
        switch (draw(5)) {
            case 0:
                return soup(draw(1000) + 1, draw(1000), 0.2F);
            case 1:
                return box_inwards(0.5F, diffuse(colour(), true));
            case 2:  // shares its material with others
                return square(1.0F, shared_);
            case 3:  // shares all with others
                return shared_mesh_;
            default:
                return square(1.0F, textured(4U << draw(5), draw(1000)));
        }
    }

    World* world_;
    std::mt19937 random_;
    std::vector<Entity> meshes_;
    std::shared_ptr<const Material> shared_ = textured(16, 1);
    std::shared_ptr<const Mesh> shared_mesh_ = square(0.7F, shared_);
};

Scene lit_ground() {
    Scene scene = ground();
    scene.world.set(scene.light, at({0.3F, 2.0F, 0.4F}));
    scene.world.set(scene.light, PointLight{.intensity = 2.0F});
    return scene;
}

Configuration traced(VplPlacement placement) {
    Configuration configuration = few_vpls();
    configuration.vpls.placement = placement;
    configuration.visibility.method = VplVisibility::rays;
    return configuration;
}

}  // namespace

TEST_SUITE("scene edits") {
    TEST_CASE_FIXTURE(RenderFixture, "after random edits of meshes the picture is that of a new renderer") {
        for (const VplPlacement placement : {VplPlacement::paths, VplPlacement::surfels}) {
            CAPTURE(placement);
            configure(traced(placement));
            Scene scene = lit_ground();
            MeshEdits edits(scene.world, test_seed(11));
            for (int frame = 0; frame < 25; ++frame) {
                CAPTURE(frame);
                edits.next();
                if (frame % 3 == 0) edits.next();
                REQUIRE(render(scene, picture_size) == fresh_picture(scene, picture_size));
            }
        }
    }

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
        // 20,000 triangles: 60,000 vertices and indices, 80 bytes for each triangle traced. The rest is less:
        // nodes of the hierarchy and 1 MiB of texels.
        const std::uint64_t all = uploaded();
        CHECK(all > 60'000 * (sizeof(Vertex) + 4) + 20'000 * 80);

        // A box of 12 triangles, and tables that do not depend on the number of triangles: of them, the top
        // of the hierarchy has the most, at least 2 · 1,024 nodes of 32 bytes.
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
}
