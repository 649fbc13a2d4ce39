#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("transparent surfaces") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{96, 64};
constexpr double tolerance = 0.005;  // as for the closed forms: floats, and albedos in half floats

std::shared_ptr<const Material> glass(glm::vec3 albedo, float alpha, bool double_sided = false) {
    Material material;
    material.base_colour = glm::vec4(albedo, alpha);
    material.double_sided = double_sided;
    material.alpha_mode = AlphaMode::blend;
    return std::make_shared<const Material>(std::move(material));
}

/// A horizontal square pane around the y axis.
struct Pane {
    float height;  ///< metres
    float half;    ///< metres
    float albedo;
    float alpha;
};

Entity add_pane(Scene& scene, const Pane& pane) {
    return add(scene.world, at({0, pane.height, 0}),
               MeshInstance{square(pane.half, glass(glm::vec3(pane.albedo), pane.alpha))});
}

constexpr glm::dvec3 light_position(0.4, 4.0, -0.2);
constexpr double intensity = 30.0;  // candela

/// The radiance that a horizontal surface reflects at a point.
double reflected(double albedo, glm::dvec3 point) {
    const glm::dvec3 to_light = light_position - point;
    const double r = glm::length(to_light);
    return albedo / pi * intensity * to_light.y / (r * r * r);
}

/// The ground under a point light; panes are added between them.
Scene lit_ground() {
    Scene scene = ground();
    scene.world.set(scene.light, at(glm::vec3(light_position)));
    scene.world.set(scene.light, PointLight{.intensity = static_cast<float>(intensity)});
    return scene;
}

class Transparent : public RenderFixture {
 protected:
    Picture picture(const Scene& scene, ShadingPath path, bool indirect = false) {
        Configuration configuration = linear_configuration(path);
        configuration.indirect = indirect;
        configure(configuration);
        return render(scene, size);
    }

    /// Compares every pixel away from the rims of panes with L = α·lit + (1 - α)·behind, from the ground
    /// upwards.
    void check(const Scene& scene, std::vector<Pane> panes, double ground_albedo = 0.5) {
        std::ranges::sort(panes, {}, &Pane::height);
        const auto& camera = scene.world.get<Camera>(scene.camera);
        const auto& pose = scene.world.get<Transform>(scene.camera);
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            const Picture found = picture(scene, path);
            std::size_t covered = 0, wrong = 0;
            for (std::uint32_t i = 0; i < found.pixels.size(); ++i) {
                const PixelRay ray = pixel_ray(camera, pose, size, i % size.x, i / size.x);
                const auto point_at = [&](double height) {
                    return ray.origin + (height - ray.origin.y) / ray.direction.y * ray.direction;
                };
                double expected = reflected(ground_albedo, point_at(0.0));
                bool rim = false;
                for (const Pane& pane : panes) {
                    const glm::dvec3 point = point_at(static_cast<double>(pane.height));
                    const double inside =
                        static_cast<double>(pane.half) - std::max(std::abs(point.x), std::abs(point.z));
                    rim = rim || std::abs(inside) < 0.01;
                    if (inside < 0.0) continue;
                    const double alpha = static_cast<double>(pane.alpha);
                    expected =
                        alpha * reflected(static_cast<double>(pane.albedo), point) + (1.0 - alpha) * expected;
                    ++covered;
                }
                const double radiance = static_cast<double>(found.pixels[i].r);
                wrong += !rim && std::abs(radiance - expected) > tolerance * expected ? 1 : 0;
            }
            CHECK(covered > 300);
            CHECK(wrong == 0);
        }
    }
};

/// Radiance with its alpha, as written to the picture.
std::vector<glm::vec4> with_alpha(const gl::Functions& gl, Renderer& renderer, const Scene& scene,
                                  const RenderTarget& target) {
    renderer.render(scene.world, scene.camera, target.target());
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(size.x) * size.y);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, target.target().framebuffer);
    gl.ReadPixels(0, 0, static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y), GL_RGBA, GL_FLOAT,
                  pixels.data());
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return pixels;
}

}  // namespace

TEST_CASE_FIXTURE(Transparent, "a pane is blended with the background by its alpha") {
    for (const float alpha : {0.0F, 0.3F, 1.0F}) {
        CAPTURE(alpha);
        Scene scene = lit_ground();
        const Pane pane{.height = 1.0F, .half = 0.6F, .albedo = 0.9F, .alpha = alpha};
        add_pane(scene, pane);
        renderer.invalidate();
        check(scene, {pane});
    }
}

TEST_CASE_FIXTURE(Transparent,
                  "panes are drawn back to front, in any order of creation and after they move") {
    const Pane lower{.height = 0.5F, .half = 0.8F, .albedo = 0.2F, .alpha = 0.6F};
    const Pane upper{.height = 1.4F, .half = 0.5F, .albedo = 1.0F, .alpha = 0.4F};
    for (const bool lower_first : {true, false}) {
        CAPTURE(lower_first);
        Scene scene = lit_ground();
        const Entity first = add_pane(scene, lower_first ? lower : upper);
        const Entity second = add_pane(scene, lower_first ? upper : lower);
        renderer.invalidate();
        check(scene, {lower, upper});

        // They swap heights.
        const auto swap_height = [&](Entity entity, float height) {
            scene.world.set(entity, at({0, height, 0}));
        };
        swap_height(first, lower_first ? upper.height : lower.height);
        swap_height(second, lower_first ? lower.height : upper.height);
        Pane now_lower = upper, now_upper = lower;
        now_lower.height = lower.height;
        now_upper.height = upper.height;
        check(scene, {now_lower, now_upper});
    }
}

TEST_CASE_FIXTURE(Transparent, "panes are also sorted for an orthographic camera") {
    const Pane lower{.height = 0.5F, .half = 0.8F, .albedo = 0.2F, .alpha = 0.6F};
    const Pane upper{.height = 1.4F, .half = 0.5F, .albedo = 1.0F, .alpha = 0.4F};
    Scene scene = lit_ground();
    add_pane(scene, upper);
    add_pane(scene, lower);
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 1.5F,
                                         .near_plane = 0.0F,
                                         .far_plane = 10.0F});
    check(scene, {lower, upper});
}

TEST_CASE_FIXTURE(Transparent, "the far side of a double-sided surface is drawn before the near one") {
    // A box seen from directly above. Its top and bottom are at different distances from the light.
    // Mirroring it reverses the order of its triangles.
    for (const float mirror : {1.0F, -1.0F}) {
        CAPTURE(mirror);
        Scene scene = lit_ground();
        add(scene.world, Transform{.translation = {0, 1.0F, 0}, .scale = {1, mirror, 1}},
            MeshInstance{box_outwards(0.6F, glass(glm::vec3(0.8F), 0.5F, true))});
        scene.world.set(scene.camera, looking({0, 3, 0}, {0, 0, 0}, {0, 0, 1}));
        scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                             .half_height = 1.5F,
                                             .near_plane = 0.0F,
                                             .far_plane = 10.0F});
        renderer.invalidate();
        const Pane bottom{.height = 0.4F, .half = 0.6F, .albedo = 0.8F, .alpha = 0.5F};
        const Pane top{.height = 1.6F, .half = 0.6F, .albedo = 0.8F, .alpha = 0.5F};
        check(scene, {bottom, top});
    }
}

TEST_CASE_FIXTURE(Transparent,
                  "backs of single-sided panes, and panes behind opaque surfaces, are not drawn") {
    const Scene without = lit_ground();
    Scene with = lit_ground();
    add(with.world,
        Transform{.translation = {0, 1, 0}, .rotation = glm::angleAxis(3.14159265F, glm::vec3(1, 0, 0))},
        MeshInstance{square(0.6F, glass(glm::vec3(0.9F), 0.5F))});
    add(with.world, at({0, -0.5F, 0}), MeshInstance{square(0.6F, glass(glm::vec3(0.9F), 0.5F))});
    for (const ShadingPath path : all_shading_paths) {
        renderer.invalidate();
        const Picture expected = picture(without, path);
        renderer.invalidate();
        CHECK(picture(with, path) == expected);
    }
}

TEST_CASE_FIXTURE(Transparent,
                  "a pane over the background is blended with black, and its pixels have an alpha of 1") {
    Scene scene = lit_ground();
    Scene empty;
    empty.camera = add(empty.world, scene.world.get<Transform>(scene.camera), Camera{});
    add(empty.world, at(glm::vec3(light_position)), PointLight{.intensity = static_cast<float>(intensity)});
    add_pane(empty, {.height = 1.0F, .half = 0.6F, .albedo = 0.9F, .alpha = 0.3F});
    check(empty, {{.height = 1.0F, .half = 0.6F, .albedo = 0.9F, .alpha = 0.3F}}, 0.0);

    const RenderTarget target(device, size);
    for (const ShadingPath path : all_shading_paths) {
        configure(linear_configuration(path));
        renderer.invalidate();
        std::size_t covered = 0;
        for (const glm::vec4& pixel : with_alpha(device.gl(), renderer, empty, target)) {
            CHECK(pixel.a == (pixel.r > 0.0F ? 1.0F : 0.0F));
            covered += pixel.a == 1.0F ? 1 : 0;
        }
        CHECK(covered > 300);
        add_pane(scene, {.height = 1.0F, .half = 0.6F, .albedo = 0.9F, .alpha = 0.3F});
        renderer.invalidate();
        for (const glm::vec4& pixel : with_alpha(device.gl(), renderer, scene, target)) {
            CHECK(pixel.a == 1.0F);
        }
    }
}

TEST_CASE_FIXTURE(Transparent,
                  "light passes through panes: shadows, VPLs and the number of triangles do not change") {
    const Scene without = lit_ground();
    Scene with = lit_ground();
    add_pane(with, {.height = 3.5F, .half = 2.0F, .albedo = 0.9F, .alpha = 0.9F});  // above the camera
    for (const ShadingPath path : all_shading_paths) {
        renderer.invalidate();
        const Picture expected = picture(without, path, true);
        const Report report = renderer.report();
        renderer.invalidate();
        CHECK(picture(with, path, true) == expected);
        CHECK(renderer.report().triangles == report.triangles);
        CHECK(renderer.report().vpls->alive == report.vpls->alive);
        CHECK(renderer.report().vpls->flux.absorbed == report.vpls->flux.absorbed);
    }
}

}  // TEST_SUITE("transparent surfaces")
