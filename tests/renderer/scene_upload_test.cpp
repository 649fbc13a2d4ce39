#include <doctest/doctest.h>

#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include "renderer/gl/graph_backend.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("scene upload") {

using namespace candela;

namespace {

/// Uploads a world, and returns the number of draws in each group.
std::vector<std::uint32_t> group_sizes(const gl::GetProc& get_proc, const World& world) {
    Gpu gpu(get_proc, gl::ShaderLibrary(gl::embedded_shaders()), {.debug_output = true});
    gl::GraphBackend backend(gpu.device());
    GraphRuntime runtime(backend);
    std::vector<std::uint32_t> sizes;
    FrameGraph graph;
    const SceneData scene = add_scene_upload(graph, gpu);
    graph.add("groups", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.side_effect();
        pass.run([&sizes, layout = scene.layout](Execution& run) {
            for (const SceneLayout::Group& group : run.value(layout).groups) {
                sizes.push_back(group.draw_count);
            }
        });
    });
    runtime.switch_to(compile(std::move(graph)).take());
    runtime.run(world);
    return sizes;
}

/// Adds a square with the default material, as `change` changes it.
template <class Change>
void add_square(World& world, Change change, Transform transform = {}) {
    auto material = std::make_shared<Material>();
    change(*material);
    add(world, transform, MeshInstance{square(0.5F, material)});
}

std::shared_ptr<const Image> grey() {
    return std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {glm::u8vec4(128, 128, 128, 255)}});
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "materials that differ in factors are drawn in one call") {
    World world;
    const auto image = grey();
    for (const float shade : {0.2F, 0.5F, 0.8F}) {
        add_square(world, [&](Material& material) {
            material.base_colour = glm::vec4(shade);
            material.base_colour_texture = image;
        });
    }
    CHECK(group_sizes(context->get_proc(), world) == std::vector<std::uint32_t>{3});
}

TEST_CASE_FIXTURE(GlFixture, "materials that bind something else, and mirrored meshes, are drawn apart") {
    World world;
    const auto image = grey();
    const auto plain = [](Material&) {};
    add_square(world, plain);
    add_square(world, plain, {.scale = {-1.0F, 1.0F, 1.0F}});
    add_square(world, [&](Material& material) { material.base_colour_texture = image; });
    add_square(world, [&](Material& material) { material.base_colour_texture = grey(); });
    add_square(world, [&](Material& material) { material.emissive = glm::vec3(1.0F); });
    add_square(world, [&](Material& material) {
        material.emissive = glm::vec3(1.0F);
        material.emissive_texture = image;
    });
    add_square(world, [&](Material& material) { material.double_sided = true; });
    add_square(world, [&](Material& material) { material.alpha_mode = AlphaMode::mask; });
    CHECK(group_sizes(context->get_proc(), world) == std::vector<std::uint32_t>(8, 1));
}

}  // TEST_SUITE("scene upload")
