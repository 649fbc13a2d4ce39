#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/scene_error.hpp>
#include "tests/renderer/path_fixture.hpp"
#include "tests/uploads.hpp"

TEST_SUITE("deformed meshes") {

using namespace candela;

namespace {

constexpr glm::uvec2 deformed_size{40, 30};

/// A square of 2 m in the plane y = 0 that faces +Y, of `side`² cells.
std::shared_ptr<const Mesh> cloth(std::uint32_t side, std::shared_ptr<const Material> material) {
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::move(material)};
    for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
        const glm::vec2 uv = glm::vec2(i % (side + 1), i / (side + 1)) / static_cast<float>(side);
        primitive.vertices.push_back({{2.0F * uv.x - 1.0F, 0.0F, 2.0F * uv.y - 1.0F}, {0, 1, 0}, uv});
    }
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint32_t a = i + i / side;
        const std::uint32_t b = a + side + 1;
        for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) primitive.indices.push_back(corner);
    }
    return std::make_shared<const Mesh>(Mesh{"cloth", {std::move(primitive)}});
}

using VertexChange = std::function<void(Vertex&)>;

DeformedMesh deformed(const Mesh& mesh, const VertexChange& change) {
    DeformedMesh::Vertices vertices;
    for (const Primitive& primitive : mesh.primitives) {
        vertices.push_back(primitive.vertices);
        for (Vertex& vertex : vertices.back()) change(vertex);
    }
    return {std::make_shared<const DeformedMesh::Vertices>(std::move(vertices))};
}

/// A wave in the cloth.
VertexChange wave(float phase) {
    return [phase](Vertex& vertex) {
        const float angle = 4.0F * vertex.position.x + phase;
        vertex.position.y += 0.2F * std::sin(angle);
        vertex.normal = glm::normalize(glm::vec3(-0.8F * std::cos(angle), 1.0F, 0.0F));
    };
}

/// A cloth above the ground, under a light.
struct ClothScene : Scene {
    explicit ClothScene(const std::shared_ptr<const Mesh>& mesh) : Scene(ground()) {
        world.set(light, at({0.3F, 2.0F, 0.4F}));
        world.set(light, PointLight{.intensity = 2.0F});
        cloth = add(world, Transform{.translation = {0.2F, 0.6F, 0}, .scale = {0.4F, 0.5F, 0.4F}},
                    MeshInstance{mesh});
    }
    Entity cloth;
};

Configuration lit(VplPlacement placement, VplVisibility visibility) {
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = placement;
    configuration.visibility.method = visibility;
    return configuration;
}

std::shared_ptr<const Material> see_through() {
    Material material;
    material.base_colour = {0.2F, 0.6F, 0.9F, 0.5F};
    material.double_sided = true;
    material.alpha_mode = AlphaMode::blend;
    return std::make_shared<const Material>(std::move(material));
}

}  // namespace

TEST_CASE_FIXTURE(RenderFixture, "a deformed mesh looks like a mesh with its vertices") {
    for (const auto& material : {diffuse({0.8F, 0.3F, 0.2F}, true), see_through()}) {
        configure(lit(VplPlacement::paths, VplVisibility::rays));
        const auto mesh = cloth(6, material);
        ClothScene scene(mesh);
        const Picture flat = render(scene, deformed_size);
        for (const float phase : {0.0F, 1.0F}) {
            const DeformedMesh waving = deformed(*mesh, wave(phase));
            scene.world.set(scene.cloth, waving);
            Mesh changed = *mesh;
            changed.primitives.front().vertices = waving.vertices->front();
            const ClothScene wanted(std::make_shared<const Mesh>(std::move(changed)));
            CHECK(render(scene, deformed_size) == from_scratch(wanted, deformed_size));
        }
        scene.world.remove<DeformedMesh>(scene.cloth);
        CHECK(render(scene, deformed_size) == flat);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "a mesh is seen where its vertices are, also if it was made elsewhere") {
    configure(lit(VplPlacement::paths, VplVisibility::rays));
    const auto mesh = cloth(6, diffuse({0.8F, 0.3F, 0.2F}, true));
    Mesh aside = *mesh;
    for (Vertex& vertex : aside.primitives.front().vertices) vertex.position.x += 50.0F;  // out of the view
    ClothScene scene(std::make_shared<const Mesh>(std::move(aside)));
    scene.world.set(scene.cloth, deformed(*mesh, [](Vertex&) {}));
    CHECK(render(scene, deformed_size) == from_scratch(ClothScene(mesh), deformed_size));
}

TEST_CASE_FIXTURE(RenderFixture, "a mesh whose vertices turn is lit like one that turns") {
    // The surfels are the same ones, moved by the triangles or by the item.
    configure(lit(VplPlacement::surfels, VplVisibility::rays));
    const auto mesh = cloth(6, diffuse({0.8F, 0.3F, 0.2F}, true));
    const glm::quat turn = glm::angleAxis(0.5F, glm::normalize(glm::vec3(1, 2, 3)));
    ClothScene turned(mesh);
    turned.world.set(turned.cloth,
                     Transform{.translation = {0.2F, 0.8F, 0}, .rotation = turn, .scale = glm::vec3(0.4F)});
    ClothScene with_vertices(mesh);
    with_vertices.world.set(with_vertices.cloth,
                            Transform{.translation = {0.2F, 0.8F, 0}, .scale = glm::vec3(0.4F)});
    with_vertices.world.set(with_vertices.cloth, deformed(*mesh, [&](Vertex& vertex) {
                                vertex.position = turn * vertex.position;
                                vertex.normal = turn * vertex.normal;
                            }));
    // Rounding of positions, about 1e-7, moves the outlines of shadows, which rays decide: few pixels
    // differ.
    const Picture a = render(turned, deformed_size);
    const Picture b = render(with_vertices, deformed_size);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        different += glm::length(a.pixels[i] - b.pixels[i]) > 1e-3F * glm::length(a.pixels[i]) ? 1 : 0;
    }
    CHECK(different * 50 < a.pixels.size());
}

TEST_CASE_FIXTURE(RenderFixture, "a mesh that is stretched reflects as much as a mesh of that size") {
    Configuration configuration = lit(VplPlacement::surfels, VplVisibility::rays);
    configuration.vpls.count = 1024;
    configuration.show = Show::indirect;
    configure(configuration);
    const auto mesh = cloth(6, diffuse({0.8F, 0.8F, 0.8F}, true));
    ClothScene large(mesh);
    ClothScene stretched(mesh);
    const Transform pose{.translation = {0.2F, 0.6F, 0}};
    large.world.set(large.cloth, pose);
    // Lit from below, the cloth lights the ground.
    large.world.set(large.light, at({0.2F, 0.3F, 0.0F}));
    stretched.world.set(stretched.light, at({0.2F, 0.3F, 0.0F}));
    stretched.world.set(stretched.cloth,
                        Transform{.translation = pose.translation, .scale = glm::vec3(0.4F)});
    stretched.world.set(stretched.cloth, deformed(*mesh, [](Vertex& vertex) { vertex.position /= 0.4F; }));
    // It has a sixth as many surfels, each six times as large. Light of so few is off by some percent.
    const double ratio = mean(render(stretched, deformed_size)) / mean(render(large, deformed_size));
    CHECK(std::abs(ratio - 1.0) < 0.15);
}

TEST_CASE_FIXTURE(GlFixture, "only the deformed vertices, and their triangles for tracing, are uploaded") {
    TestedRenderer renderer(Uploads::counting(context->get_proc()));
    REQUIRE(renderer.configure(lit(VplPlacement::paths, VplVisibility::rays)).empty());
    const auto mesh = cloth(20, diffuse(glm::vec3(0.5F), true));
    ClothScene scene(mesh);
    add(scene.world, at({0, 1, 0}), MeshInstance{soup(20'000, 3)});
    const RenderTarget target(device, deformed_size);
    const auto uploaded = [&] {
        static_cast<void>(Uploads::take());
        renderer.render(scene.world, scene.camera, target.target());
        return Uploads::take();
    };
    const std::uint64_t all = uploaded();
    scene.world.set(scene.cloth, deformed(*mesh, wave(0.0F)));
    static_cast<void>(uploaded());
    scene.world.set(scene.cloth, deformed(*mesh, wave(1.0F)));
    // 441 vertices of 40 bytes, 800 triangles of 80, at most 1,600 nodes of 32, and the top of the
    // hierarchy, which is of that size.
    const std::uint64_t cloth_only = uploaded();
    CHECK(cloth_only > 441 * 40 + 800 * 80);
    CHECK(cloth_only < 250'000);
    CHECK(all > 3'000'000);
}

}  // TEST_SUITE("deformed meshes")
