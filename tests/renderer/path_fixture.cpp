#include "tests/renderer/path_fixture.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <candela/scene/gltf.hpp>
#include "sandbox/files/shipped_file.hpp"

namespace candela {

Scene shipped_scene(std::string_view name) {
    Scene scene;
    import_gltf(sandbox::shipped_file("scenes", std::string(name) + ".gltf"), scene.world);
    for (const auto& [entity, camera] : scene.world.view<Camera>()) {
        scene.camera = entity;
    }
    return scene;
}

Scene cluttered_room() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{box_inwards(2.0F, diffuse({0.6F, 0.5F, 0.4F}))});
    add(scene.world, Transform{.scale = glm::vec3(1.2F)}, MeshInstance{soup(200, 1)});
    scene.camera = add(scene.world, at(eye), Camera{.vertical_fov = 1.0F, .near_plane = 0.05F});
    return scene;
}

void add_ranged_lights(World& world, int count, float range) {
    const auto spread = [](int i, float step) { return std::fmod(static_cast<float>(i) * step, 1.0F); };
    for (int i = 0; i < count; ++i) {
        const glm::vec3 place(spread(i, 0.618F), spread(i, 0.382F), spread(i, 0.755F));
        const glm::vec3 position = 3.0F * place - 1.5F;
        const glm::vec3 colour(spread(i, 0.57F), spread(i, 0.31F), 0.2F + spread(i, 0.83F));
        const Transform pose = looking(position, 4.0F * glm::vec3(place.z, place.x, place.y) - 2.0F);
        if (i % 2 == 0) {
            add(world, pose, PointLight{.colour = colour, .range = range, .casts_shadow = false});
        } else {
            add(world, pose,
                SpotLight{.colour = colour,
                          .range = 2.0F * range,
                          .inner_cone = 0.1F,
                          .outer_cone = 0.2F + 1.3F * place.y,
                          .casts_shadow = false});
        }
    }
}

PathError PathFixture::worst_path(const Scene& scene, glm::uvec2 size, Configuration base) {
    renderer.invalidate();
    base.path = ShadingPath::forward;
    configure(base);
    const Picture reference = render(scene, size);
    CHECK(is_sane(reference));
    PathError worst{.reference_mean = mean(reference)};
    const double floor = std::max(1e-4 * worst.reference_mean, 1e-30);
    for (const ShadingPath path : all_shading_paths) {
        if (path == ShadingPath::forward) continue;
        base.path = path;
        configure(base);
        const double error = worst_error(render(scene, size), reference, floor);
        if (error > worst.error) {
            worst.error = error;
            worst.path = path;
        }
    }
    return worst;
}

void PathFixture::check_paths(const Scene& scene, glm::uvec2 size, const Configuration& base) {
    CAPTURE(size.x);
    CAPTURE(size.y);
    CAPTURE(base.indirect);
    const PathError worst = worst_path(scene, size, base);
    CAPTURE(to_string(worst.path));
    CHECK(worst.error < path_tolerance);
    CHECK(worst.reference_mean > 0.0);
}

Configuration direct_only() {
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configuration.shadows.enabled = false;
    return configuration;
}

}  // namespace candela
