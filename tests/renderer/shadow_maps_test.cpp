#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("shadow maps") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{160, 120};

/// A square occluder, parallel to the ground.
struct Occluder {
    glm::dvec3 centre{0.0, 0.5, 0.0};
    double half = 0.4;
};

/// The line from a light to a point of the ground.
struct LightRay {
    glm::dvec3 from;
    glm::dvec3 direction;  ///< to the point on the ground at parameter 1
};

bool blocked(const Occluder& occluder, const LightRay& ray) {
    const double t = (occluder.centre.y - ray.from.y) / ray.direction.y;
    const glm::dvec3 off = glm::abs(ray.from + t * ray.direction - occluder.centre);
    return t > 0.0 && t < 1.0 && std::max(off.x, off.z) < occluder.half;
}

class ShadowMapTests : public RenderFixture {
 protected:
    ShadowMapTests() {
        // Seen from below the occluder, so that it hides no part of the ground.
        occluded_.world.set(occluded_.camera, looking({0.0F, 0.45F, 0.9F}, {0.0F, 0.0F, 0.1F}));
        occluder_entity_ =
            add(occluded_.world, at(glm::vec3(occluder_.centre)),
                MeshInstance{square(static_cast<float>(occluder_.half), diffuse(glm::vec3(0.5F), true))});
    }

    template <class Light>
    void light_up(const Transform& pose, const Light& light) {
        for (Scene* scene : {&scene_, &occluded_}) {
            scene->world.remove<PointLight>(scene->light);
            scene->world.remove<SpotLight>(scene->light);
            scene->world.remove<DirectionalLight>(scene->light);
            scene->world.set(scene->light, pose);
            scene->world.set(scene->light, light);
        }
    }

    void shadows(bool enabled, std::uint32_t resolution) {
        Configuration configuration = linear_configuration();
        configuration.indirect = false;
        configuration.shadows = {
            .enabled = enabled, .cube_resolution = resolution, .map_resolution = resolution};
        configure(configuration);
    }

    Picture picture(const Scene& scene) {
        renderer.invalidate();
        return render(scene, size);
    }

    /// Compares the shadow with the analytic one: no light inside, all light outside, and the edge within a
    /// margin. `astray(ray, u, v)` returns the ray moved by the margin, in the direction (u, v) of the map.
    template <class Ray, class Astray>
    void check_shadow(std::uint32_t resolution, const Ray& ray_to, const Astray& astray) {
        shadows(false, resolution);
        const Picture lit = picture(occluded_);
        shadows(true, resolution);
        const Picture shadowed = picture(occluded_);
        std::size_t dark = 0, bright = 0, edge = 0, wrong = 0;
        const auto& camera = occluded_.world.get<Camera>(occluded_.camera);
        const auto& pose = occluded_.world.get<Transform>(occluded_.camera);
        for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
            const PixelRay view = pixel_ray(camera, pose, size, i % size.x, i / size.x);
            const glm::dvec3 point = view.origin - view.origin.y / view.direction.y * view.direction;
            const LightRay ray = ray_to(point);
            std::size_t hits = 0;
            constexpr int around = 16;
            for (int k = 0; k < around; ++k) {
                const double angle = 2.0 * std::numbers::pi * k / around;
                // On the border of a square of half width 1, including its corners.
                const double to_border = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
                const double u = std::cos(angle) / to_border, v = std::sin(angle) / to_border;
                hits += blocked(occluder_, astray(ray, u, v)) ? 1 : 0;
            }
            const float visible = lit.pixels[i].r > 0.0F ? shadowed.pixels[i].r / lit.pixels[i].r : 1.0F;
            if (hits == around) {
                ++dark;
                wrong += visible == 0.0F ? 0 : 1;
            } else if (hits == 0) {
                ++bright;
                wrong += visible == 1.0F ? 0 : 1;
            } else {
                ++edge;
            }
        }
        CAPTURE(resolution);
        CHECK(dark > 200);
        CHECK(bright > 2000);
        CHECK(edge > 0);
        CHECK(wrong == 0);
    }

    Occluder occluder_;
    Entity occluder_entity_;
    Scene scene_ = ground();
    Scene occluded_ = ground();
};

/// The margin of the edge along each axis of the map.
constexpr double texels = 2.0;

}  // namespace

TEST_CASE_FIXTURE(ShadowMapTests, "a point light's shadow, also across the edges of the cube") {
    // From the first light, the shadow is on the face below it; from the second, on two faces next to
    // that one and on the edge between them.
    for (const glm::dvec3 light : {glm::dvec3(0.2, 2.0, 0.1), glm::dvec3(0.9, 1.2, 0.8)}) {
        light_up(at(glm::vec3(light)), PointLight{});
        for (const std::uint32_t resolution : {128U, 512U}) {
            check_shadow(
                resolution,
                [&](glm::dvec3 p) {
                    return LightRay{light, p - light};
                },
                [&](LightRay ray, double u, double v) {
                    // The texels of a face are squares of 2 / resolution at distance 1 along its axis.
                    const glm::dvec3 a = glm::abs(ray.direction);
                    const int axis = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
                    const double step = texels * 2.0 / resolution * a[axis];
                    ray.direction[(axis + 1) % 3] += step * u;
                    ray.direction[(axis + 2) % 3] += step * v;
                    return ray;
                });
        }
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "a spot light's shadow") {
    const glm::dvec3 light(0.8, 2.0, 0.3);
    const Transform pose = looking(glm::vec3(light), {0.0F, 0.0F, -0.1F});
    light_up(pose, SpotLight{.intensity = 2.0F, .inner_cone = 0.7F, .outer_cone = 0.8F});
    for (const std::uint32_t resolution : {128U, 512U}) {
        check_shadow(
            resolution,
            [&](glm::dvec3 p) {
                return LightRay{light, p - light};
            },
            [&](LightRay ray, double u, double v) {
                const glm::dquat turn(pose.rotation);
                const double depth = glm::dot(ray.direction, turn * glm::dvec3(0, 0, -1));
                // The map covers the cone with a margin of two texels on each side.
                const double texel = 2.0 * std::tan(0.8) * (1.0 + 4.0 / resolution) / resolution;
                ray.direction += texels * texel * depth * (turn * glm::dvec3(u, v, 0));
                return ray;
            });
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "a directional light's shadow has a sharp edge, however wide a texel") {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(-0.5, -1.0, -0.3));
    const glm::dvec3 right = glm::normalize(glm::cross(direction, glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(right, direction);
    light_up(looking({0, 0, 0}, glm::vec3(direction)), DirectionalLight{});
    // A pixel is about 6 mm wide, a texel 11 mm to 18 cm. Rays start 8e-5 m above the ground (2e-5 of the
    // scene's scale), and positions are rounded to 1e-6 m.
    constexpr double margin = 2e-4;
    for (const std::uint32_t resolution : {64U, 256U, 1024U}) {
        check_shadow(
            resolution,
            [&](glm::dvec3 p) {
                return LightRay{p - 4.0 * direction, 4.0 * direction};
            },
            [&](LightRay ray, double u, double v) {
                ray.from += margin * (u * right + v * up);
                return ray;
            });
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "a single plane does not shadow itself, however it is lit") {
    struct Slant {
        float height, distance;
    };
    for (const Slant& slant : {Slant{2.0F, 0.5F}, Slant{0.5F, 1.5F}, Slant{0.1F, 3.0F}, Slant{0.02F, 3.5F}}) {
        for (const int kind : {0, 1, 2}) {
            const Transform pose = looking({slant.distance, slant.height, 0.4F * slant.distance}, {0, 0, 0});
            if (kind == 0) light_up(pose, PointLight{});
            if (kind == 1) light_up(pose, SpotLight{.outer_cone = 1.0F});
            if (kind == 2) light_up(pose, DirectionalLight{});
            for (const std::uint32_t resolution : {16U, 100U, 1024U}) {
                CAPTURE(slant.height);
                CAPTURE(kind);
                CAPTURE(resolution);
                shadows(false, resolution);
                const Picture lit = picture(scene_);
                shadows(true, resolution);
                CHECK(mean(lit) > 0.0);
                CHECK(picture(scene_) == lit);
            }
        }
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "from any distance, a light reaches what faces it, and nothing in a room") {
    Scene room;
    add(room.world, at({0.0F, 1.0F, 0.0F}), MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F), true))});
    room.camera = add(room.world, looking({-0.8F, 1.7F, -0.7F}, {0.3F, 0.6F, 0.4F}), Camera{});
    const glm::vec3 direction = glm::normalize(glm::vec3(0.8F, 0.5F, 0.33F));
    for (const float distance : {2.0F, 30.0F, 500.0F, 1e4F, 1e5F}) {
        for (const int kind : {0, 1, 2}) {
            CAPTURE(distance);
            CAPTURE(kind);
            const Transform pose = looking(glm::vec3(0.0F, 1.0F, 0.0F) + distance * direction, {0, 1, 0});
            const float intensity = distance * distance;
            for (Scene* scene : {&scene_, &room}) {
                if (scene->world.alive(scene->light)) scene->world.destroy(scene->light);
                scene->light = add(scene->world, pose);
                if (kind == 0) scene->world.set(scene->light, PointLight{.intensity = intensity});
                if (kind == 1) scene->world.set(scene->light, SpotLight{.intensity = intensity});
                if (kind == 2) scene->world.set(scene->light, DirectionalLight{});
            }
            shadows(false, 512);
            const Picture lit = picture(scene_);
            CHECK(mean(lit) > 0.01);
            CHECK(mean(picture(room)) > 0.01);
            shadows(true, 512);
            CHECK(picture(scene_) == lit);
            CHECK(mean(picture(room)) == 0.0);
        }
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "a light that casts no shadow lights occluded surfaces") {
    light_up(at({0.2F, 2.0F, 0.1F}), PointLight{.casts_shadow = false});
    shadows(true, 128);
    const Picture with = picture(occluded_);
    shadows(false, 128);
    CHECK(picture(occluded_) == with);
    light_up(at({0.2F, 2.0F, 0.1F}), PointLight{});
    shadows(true, 128);
    CHECK(picture(occluded_) != with);
}

TEST_CASE_FIXTURE(ShadowMapTests, "only changed shadow views are rendered again, and the others stay valid") {
    renderer.verify(false);  // which renders all views
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configuration.shadows = {.cube_resolution = 64, .map_resolution = 64};
    configure(configuration);
    World& world = occluded_.world;
    const Entity first = add(world, at({0.2F, 2.0F, 0.1F}), PointLight{.intensity = 3.0F});
    const Entity second = add(world, at({-0.4F, 1.5F, 0.3F}), PointLight{.intensity = 2.0F});
    const Entity spot = add(world, looking({1, 2, 1}, {0, 0, 0}), SpotLight{});
    const Entity other_spot = add(world, looking({-1, 2, 1}, {0, 0, 0}), SpotLight{.intensity = 0.5F});
    const Entity sun = add(world, looking({1, 3, 0}, {0, 0, 0}), DirectionalLight{.illuminance = 0.1F});
    Entity extra{};
    const auto move = [&](Entity entity) {
        world.edit<Transform>(entity, [](Transform& pose) { pose.translation.x += 0.1F; });
    };
    struct Edit {
        const char* name;
        std::function<void()> apply;
        std::uint32_t views;
    };
    const std::vector<Edit> edits = {
        {"first frame", [] {}, 6 + 6 + 1 + 1 + 1},
        {"point light moves", [&] { move(first); }, 6},
        {"the other moves", [&] { move(second); }, 6},
        {"spot moves", [&] { move(spot); }, 1},
        {"two move", [&] { move(spot), move(first); }, 7},
        {"sun turns",
         [&] {
             world.set(sun, looking({2, 3, 0}, {0, 0, 0}));
         },
         1},
        {"colour changes", [&] { world.edit<PointLight>(first, [](auto& l) { l.colour.g = 0.5F; }); }, 0},
        // The brighter one is first, so the two change places.
        {"order changes", [&] { world.edit<PointLight>(second, [](auto& l) { l.intensity = 9; }); }, 12},
        // Another number of layers needs another texture; the cube maps stay.
        {"spot added",
         [&] {
             extra = add(world, looking({0, 2, 1}, {0, 0, 0}), SpotLight{});
         },
         4},
        {"spot goes", [&] { world.destroy(extra); }, 3},
        {"mesh moves", [&] { move(occluder_entity_); }, 6 + 6 + 1 + 1 + 1},
        {"dimmest light goes", [&] { world.remove<SpotLight>(other_spot); }, 2},
    };
    for (const Edit& edit : edits) {
        CAPTURE(edit.name);
        edit.apply();
        const Picture shown = render(occluded_, size);
        CHECK((ran("shadow-maps") ? renderer.report().lights.shadow_views : 0) == edit.views);
        TestedRenderer fresh(context->get_proc());
        REQUIRE(fresh.configure(configuration).empty());
        const RenderTarget target(device, size);
        fresh.render(world, occluded_.camera, target.target());
        CHECK(target.read() == shown);
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "walls do not shadow each other at their common edge") {
    // A closed convex room has no shadows. At this size, the edges between walls run through pixel
    // centres.
    const Scene furnace = shipped_scene("furnace");
    for (const std::uint32_t resolution : {64U, 256U}) {
        shadows(false, resolution);
        renderer.invalidate();
        const Picture lit = render(furnace, {320, 240});
        shadows(true, resolution);
        CHECK(render(furnace, {320, 240}) == lit);
    }
}

TEST_CASE_FIXTURE(ShadowMapTests, "lights for which the texture has no layers left have no map") {
    Scene scene = ground();
    for (int i = 0; i < 400; ++i) add(scene.world, at({0, 1, 0}), PointLight{.intensity = 0.1F});
    shadows(true, 16);
    static_cast<void>(picture(scene));
    // 2,048 layers, six per cube map.
    CHECK(renderer.report().lights.with_map == 341);
    CHECK(renderer.report().lights.without_map == 59);
}

}  // TEST_SUITE("shadow maps")
