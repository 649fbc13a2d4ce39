#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <limits>
#include <vector>

#include <candela/scene/scene_error.hpp>
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("edge cases") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{40, 30};

bool is_black(const Picture& picture) {
    return std::ranges::all_of(picture.pixels,
                               [](const glm::vec3& pixel) { return pixel == glm::vec3(0.0F); });
}

/// Whether no light gets into a box from -1 to 1. Shadow maps leak within one or two texels of a silhouette,
/// so pixels within 0.01 of the seams between walls are ignored.
bool is_dark_inside(const Scene& scene, const Picture& picture) {
    for (std::uint32_t i = 0; i < picture.pixels.size(); ++i) {
        const PixelRay ray =
            pixel_ray(scene.world.get<Camera>(scene.camera), scene.world.get<Transform>(scene.camera),
                      picture.size, i % picture.size.x, i / picture.size.x);
        const glm::dvec3 t = (glm::sign(ray.direction) - ray.origin) / ray.direction;
        const glm::dvec3 hit = glm::abs(ray.origin + std::min({t.x, t.y, t.z}) * ray.direction);
        const double second = hit.x + hit.y + hit.z - 1.0 - std::min({hit.x, hit.y, hit.z});
        if (second < 0.99 && picture.pixels[i] != glm::vec3(0.0F)) return false;
    }
    return true;
}

/// The Cornell box, `factor` times as large. Intensities are scaled by factor², so that it is as bright.
Scene scaled_cornell_box(float factor) {
    Scene scene = cornell_box();
    std::vector<Entity> all;
    for (const auto& [entity, transform] : scene.world.view<Transform>()) all.push_back(entity);
    for (const Entity entity : all) {
        scene.world.edit<Transform>(entity, [&](Transform& transform) {
            transform.translation *= factor;
            transform.scale *= factor;
        });
    }
    scene.world.edit<PointLight>(scene.light, [&](PointLight& light) { light.intensity *= factor * factor; });
    scene.world.edit<Camera>(scene.camera, [&](Camera& camera) { camera.near_plane *= factor; });
    return scene;
}

class EdgeCases : public RenderFixture {
 protected:
    /// Renders with both paths, which must agree.
    Picture render_both(const Scene& scene, Configuration configuration = linear_configuration()) {
        configuration.path = ShadingPath::forward;
        configure(configuration);
        renderer.invalidate();
        const Picture forward = render(scene, size);
        configuration.path = ShadingPath::deferred;
        configure(configuration);
        renderer.invalidate();
        Picture deferred = render(scene, size);
        CHECK(is_sane(deferred));
        CHECK(worst_error(forward, deferred, 1e-6) < 1e-3);
        return deferred;
    }
};

}  // namespace

TEST_CASE_FIXTURE(EdgeCases, "an empty world, also with lights only or surfaces only") {
    Scene scene;
    scene.camera = add(scene.world, Transform{}, Camera{});
    CHECK(is_black(render_both(scene)));
    CHECK(renderer.report().triangles == 0);

    SUBCASE("lights of every kind, no surfaces") {
        add(scene.world, Transform{}, PointLight{});
        add(scene.world, Transform{}, SpotLight{});
        add(scene.world, Transform{}, DirectionalLight{});
        CHECK(is_black(render_both(scene)));
        CHECK(renderer.report().lights.count == 3);
    }
    SUBCASE("surfaces, no lights") {
        add(scene.world, Transform{}, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F)))});
        CHECK(is_black(render_both(scene)));
        CHECK(renderer.report().lights.count == 0);
        CHECK(renderer.report().vpls->alive == 0);
    }
    SUBCASE("meshes without triangles") {
        const Primitive nothing{.vertices = {}, .indices = {}, .material = diffuse(glm::vec3(0.5F))};
        add(scene.world, Transform{}, MeshInstance{std::make_shared<const Mesh>(Mesh{"", {nothing}})});
        add(scene.world, Transform{}, MeshInstance{std::make_shared<const Mesh>(Mesh{"", {}})});
        add(scene.world, Transform{}, PointLight{});
        CHECK(is_black(render_both(scene)));
    }
}

TEST_CASE_FIXTURE(EdgeCases, "without indirect light, VPLs or bounces the picture is the direct light") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.show = Show::direct;
    const Picture direct = render_both(scene, configuration);
    configuration.show = Show::total;
    configuration.vpls.count = 0;
    CHECK(render_both(scene, configuration) == direct);
    configuration.vpls = {.count = 256, .bounces = 0};
    CHECK(render_both(scene, configuration) == direct);
    CHECK(renderer.report().vpls->alive == 0);
    configuration.indirect = false;
    CHECK(render_both(scene, configuration) == direct);
    CHECK_FALSE(renderer.report().vpls);
}

TEST_CASE_FIXTURE(EdgeCases, "a light exactly on a surface, an edge and a corner") {
    Scene scene = furnace_box(0.5F);
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = VplPlacement::paths;
    for (const glm::vec3 position :
         {glm::vec3(1, 0.2F, 0.1F), glm::vec3(1, 1, 0.1F), glm::vec3(1, 1, 1), glm::vec3(0, 0, 0.9F)}) {
        CAPTURE(position.x);
        scene.world.set(scene.light, at(position));
        const Picture picture = render_both(scene, configuration);
        CHECK(mean(picture) > 1e-3);
        // All light is accounted for, wherever it went.
        const EnergyAccount flux = renderer.report().vpls->flux;
        const glm::dvec3 sum = flux.absorbed + flux.escaped + flux.truncated + flux.roulette;
        CHECK(std::abs(sum.r / flux.emitted.r - 1.0) < 1e-3);
    }
}

TEST_CASE_FIXTURE(EdgeCases,
                  "a light outside a closed box leaves the inside dark, with direct light and VPLs") {
    Scene scene = furnace_box(0.5F);
    scene.world.set(scene.light, at({0.3F, 1.5F, 0.2F}));
    Configuration configuration = linear_configuration();
    configuration.show = Show::direct;
    CHECK(is_dark_inside(scene, render_both(scene, configuration)));
    // The backs of the walls, which the light reaches, reflect nothing.
    configuration.show = Show::total;
    CHECK(is_dark_inside(scene, render_both(scene, configuration)));
    scene.world.remove<PointLight>(scene.light);
    scene.world.set(scene.light, looking({0.3F, 1.5F, 0.2F}, {0, 0, 0}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 5.0F});
    CHECK(is_dark_inside(scene, render_both(scene, configuration)));
    scene.world.remove<DirectionalLight>(scene.light);
    scene.world.set(scene.light, SpotLight{.intensity = 5.0F});
    CHECK(is_dark_inside(scene, render_both(scene, configuration)));
}

TEST_CASE_FIXTURE(EdgeCases, "targets of one pixel, one row and one column") {
    Scene scene = cornell_box();
    for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
        configure(linear_configuration(path));
        for (const glm::uvec2 odd :
             {glm::uvec2(1, 1), glm::uvec2(4096, 1), glm::uvec2(1, 300), glm::uvec2(7, 5)}) {
            // The box fills the whole width.
            const float aspect = static_cast<float>(odd.x) / static_cast<float>(odd.y);
            scene.world.set(scene.camera, Camera{.vertical_fov = 0.6F / std::max(aspect, 1.0F)});
            const Picture picture = render(scene, odd);
            CHECK(is_sane(picture));
            CHECK(mean(picture) > 0.01);
        }
        // The single pixel has the same centre as the middle pixel of 3 × 3. Drivers may round corners to
        // 1/256 of either: some thousandths of the picture, over which the light changes about once.
        CHECK(worst_error({{1, 1}, {render(scene, {3, 3}).at(1, 1)}}, render(scene, {1, 1}), 1e-4) < 1e-2);
    }
}

TEST_CASE_FIXTURE(EdgeCases, "invalid targets are refused, and the next frame is correct") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const std::uint32_t too_many = device.limits().texture_size + 1;
    for (const glm::uvec2 bad : {glm::uvec2(0, 5), glm::uvec2(5, 0), glm::uvec2(too_many, 5)}) {
        CHECK_THROWS_AS(renderer.render(scene.world, scene.camera, {0, bad}), gl::GlError);
    }
    CHECK(render(scene, size) == before);
}

TEST_CASE_FIXTURE(EdgeCases, "lights that emit nothing change nothing") {
    Scene scene = cornell_box();
    const Picture one = render_both(scene);
    add(scene.world, Transform{}, PointLight{.intensity = 0.0F});
    add(scene.world, Transform{}, SpotLight{.colour = glm::vec3(0.0F)});
    add(scene.world, Transform{}, DirectionalLight{.illuminance = 0.0F});
    CHECK(render_both(scene) == one);
    CHECK(renderer.report().lights.count == 1);
}

TEST_CASE_FIXTURE(EdgeCases, "a light without a Transform shines from the origin") {
    Scene scene = furnace_box(0.5F);
    scene.world.set(scene.light, Transform{});
    const Picture with = render_both(scene);
    scene.world.remove<Transform>(scene.light);
    CHECK(render_both(scene) == with);
}

TEST_CASE_FIXTURE(EdgeCases, "tiny and huge scenes look the same as a scene of usual size") {
    const Picture usual = render_both(scaled_cornell_box(1.0F));
    for (const float factor : {0.01F, 1000.0F}) {
        CAPTURE(factor);
        const Picture picture = render_both(scaled_cornell_box(factor));
        CHECK(std::abs(mean(picture) / mean(usual) - 1.0) < 2e-3);
        // Rounding puts pixels on edges, and texels of shadow maps, on either side: less than 1 % of the
        // pixels.
        std::size_t off = 0;
        for (std::size_t i = 0; i < usual.pixels.size(); ++i) {
            const glm::vec3 d = glm::abs(picture.pixels[i] - usual.pixels[i]);
            if (d.r + d.g + d.b > 0.01F * (usual.pixels[i].r + usual.pixels[i].g + usual.pixels[i].b)) {
                ++off;
            }
        }
        CHECK(off * 100 < usual.pixels.size());
    }
}

TEST_CASE_FIXTURE(EdgeCases, "brightness is linear up to huge intensities, which tone-map to white") {
    Scene scene = cornell_box();
    const Picture usual = render_both(scene);
    Picture lit = usual;
    for (glm::vec3& pixel : lit.pixels) pixel = glm::vec3(glm::greaterThan(pixel, glm::vec3(0.0F)));
    for (const float factor : {1e-12F, 1e20F, 1e30F}) {
        CAPTURE(factor);
        scene = cornell_box();
        scene.world.edit<PointLight>(scene.light, [&](PointLight& light) { light.intensity *= factor; });
        Picture picture = render_both(scene);
        for (glm::vec3& pixel : picture.pixels) pixel /= factor;
        CHECK(worst_error(picture, usual, 1e-6) < 1e-3);
        if (factor < 1.0F) continue;
        Configuration curve = linear_configuration();
        curve.tone_map.enabled = true;
        configure(curve);
        // All lit pixels are white, not black or random, as they would be if the tone curve divided
        // infinity by itself.
        CHECK(worst_error(render(scene, size), lit, 1.0) < 1e-5);
    }
}

TEST_CASE_FIXTURE(EdgeCases,
                  "an entity that is not a camera is an EntityError, and the renderer still works") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const Entity doomed = add(scene.world, Transform{}, Camera{});
    scene.world.destroy(doomed);
    const RenderTarget target(device, size);
    CHECK_THROWS_AS(renderer.render(scene.world, doomed, target.target()), EntityError);
    CHECK_THROWS_AS(renderer.render(scene.world, scene.light, target.target()), EntityError);
    CHECK_THROWS_AS(renderer.render(scene.world, Entity{}, target.target()), EntityError);
    CHECK(render(scene, size) == before);
    CHECK(renderer.take_frames(true).size() == 2);
}

TEST_CASE_FIXTURE(EdgeCases, "a cycle in the hierarchy is a SceneError, and the renderer still works") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const Transform pose = scene.world.get<Transform>(scene.light);
    scene.world.edit<Transform>(scene.light, [&](Transform& transform) { transform.parent = scene.light; });
    const RenderTarget target(device, size);
    CHECK_THROWS_AS(renderer.render(scene.world, scene.camera, target.target()), SceneError);
    scene.world.set(scene.light, pose);
    CHECK(render(scene, size) == before);
}

TEST_CASE_FIXTURE(EdgeCases, "the memory budget limits the number of shadow maps, but not shadows") {
    Scene scene = cornell_box();
    add(scene.world, looking({0, 1.5F, 1}, {0, 0, 0}), SpotLight{.intensity = 0.5F});
    add(scene.world, looking({0, 1.5F, 1}, {0, 0, 0}), SpotLight{.intensity = 0.6F, .casts_shadow = false});
    Configuration configuration = linear_configuration();
    // A cube map of 512² texels takes 6 MiB, a map of 1024² takes 4 MiB.
    configuration.shadows = {.cube_resolution = 512, .map_resolution = 1024};
    struct Case {
        std::uint32_t budget, with, without;
    };
    configure(configuration);
    const Picture shadowed = render(scene, size);
    for (const Case& c : {Case{0, 0, 2}, Case{3, 0, 2}, Case{4, 1, 1}, Case{6, 1, 1}, Case{10, 2, 0}}) {
        CAPTURE(c.budget);
        configuration.shadows.budget_mib = c.budget;
        configure(configuration);
        // Where a map decides, a ray would decide the same.
        CHECK(render(scene, size) == shadowed);
        const LightReport lights = renderer.report().lights;
        CHECK(lights.count == 3);
        CHECK(lights.with_map == c.with);
        CHECK(lights.without_map == c.without);
    }
    configuration.shadows.enabled = false;
    configure(configuration);
    CHECK(render(scene, size) != shadowed);
    CHECK(renderer.report().lights.with_map == 0);
    CHECK(renderer.report().lights.without_map == 0);
}

TEST_CASE_FIXTURE(EdgeCases, "the sun has no map of a world of millions of triangles, and the same shadows") {
    Scene scene = ground();
    scene.world.set(scene.light, looking({0, 1, 1}, {0, 0, 0}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 5.0F});
    const auto sphere = sphere_inwards(0.3F, 5, diffuse(glm::vec3(0.5F)));
    add(scene.world, at({0.1F, 2.4F, 2.6F}), MeshInstance{sphere});  // behind the camera; it sees the shadow
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const Picture mapped = render(scene, size);
    CHECK(renderer.report().lights.with_map == 1);
    // 841 more of 20,480 triangles, behind the camera and in the box around the others, which rays start by.
    for (int i = 0; i < 29 * 29; ++i) {
        Transform place =
            at({0.2F * static_cast<float>(i % 29) - 2.8F, 0.1F, 0.05F * static_cast<float>(i / 29) + 2.5F});
        place.scale = glm::vec3(0.2F);
        add(scene.world, place, MeshInstance{sphere});
    }
    // Where a map decides, a ray would decide the same.
    CHECK(render(scene, size) == mapped);
    CHECK(renderer.report().lights.without_map == 1);
    scene.world.set(scene.light, DirectionalLight{.illuminance = 5.0F, .casts_shadow = false});
    CHECK(render(scene, size) != mapped);
}

TEST_CASE_FIXTURE(EdgeCases, "hundreds of lights all contribute, even those without a shadow map") {
    Scene scene = ground();
    scene.world.set(scene.light, at({0.4F, 1.0F, -0.2F}));
    scene.world.set(scene.light, PointLight{.intensity = 1.0F});
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configuration.shadows = {.cube_resolution = 16, .budget_mib = 1};
    const Picture one = render_both(scene, configuration);
    for (int i = 0; i < 299; ++i) {
        add(scene.world, at({0.4F, 1.0F, -0.2F}), PointLight{.intensity = 1.0F});
    }
    Picture many = render_both(scene, configuration);
    for (glm::vec3& pixel : many.pixels) pixel /= 300.0F;
    // A sum of 300 floats. A cube map of 16² takes 6 KiB: 170 of them fill the budget.
    CHECK(worst_error(many, one, 1e-6) < 1e-4);
    CHECK(renderer.report().lights.with_map == 170);
    CHECK(renderer.report().lights.without_map == 130);
}

}  // TEST_SUITE("edge cases")
