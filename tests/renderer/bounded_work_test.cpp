// Software drivers silently end all loops of a shader invocation after 65,535 iterations in total. Sums over
// more VPLs, lights and tree nodes than that must still be complete.

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("bounded work") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{4, 3};

/// A view of the back wall so narrow that the light of a VPL is the same in the whole picture.
Scene patch_of_wall() {
    Scene scene = cornell_box();
    scene.camera =
        add(scene.world, looking({0.1F, 1.3F, 1.0F}, {0.15F, 1.25F, -1.0F}), Camera{.vertical_fov = 1e-4F});
    return scene;
}

/// Lights `first` to `last` (exclusive) of a sequence of dim ones around the middle of the ground.
Scene lit_ground(std::uint32_t first, std::uint32_t last, float range) {
    Scene scene = ground();
    for (std::uint32_t i = first; i < last; ++i) {
        const auto k = static_cast<float>(i);
        const glm::vec2 place = glm::fract(k * glm::vec2(0.7548777F, 0.5698403F)) - 0.5F;
        add(scene.world, at({place.x, 1.0F, place.y}),
            PointLight{.intensity = 1e-3F, .range = range, .casts_shadow = false});
    }
    return scene;
}

Picture sum(const std::vector<Picture>& parts) {
    Picture sum{parts.front().size, std::vector<glm::vec3>(parts.front().pixels.size())};
    for (const Picture& part : parts) {
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
    }
    return sum;
}

class BoundedWork : public PathFixture {
 protected:
    Picture picture(const Scene& scene, const Configuration& configuration, glm::uvec2 of_size = size) {
        configure(configuration);
        renderer.invalidate();  // the scene may have the address of the previous one
        return render(scene, of_size);
    }

    void check_vpls(std::uint32_t count, VplVisibility method) {
        const Scene scene = patch_of_wall();
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.vpls = {.placement = VplPlacement::paths, .count = count, .bounces = 2};
        configuration.visibility.method = method;
        // Each of the 64 classes gathers so few VPLs that no bound applies, and on a plane they add up to all
        // VPLs.
        configuration.interleave = Interleave::eight;
        constexpr glm::uvec2 whole_classes{8, 8};
        const Picture shared = picture(scene, configuration, whole_classes);
        CHECK(mean(shared) > 0.01);
        configuration.interleave = Interleave::one;
        for (const ShadingPath path : {ShadingPath::deferred, ShadingPath::forward}) {
            CAPTURE(to_string(path));
            configuration.path = path;
            // The light of the nearest VPL varies by 1e-4 over the picture, and 70,000 floats are added up in
            // another order.
            CHECK(worst_error(picture(scene, configuration, whole_classes), shared, 1e-12) < 1e-3);
        }
    }

    void check_lights(float range) {
        constexpr std::uint32_t lights = 70'000;
        constexpr std::uint32_t part = 14'000;
        std::vector<Picture> parts;
        for (std::uint32_t first = 0; first < lights; first += part) {
            parts.push_back(picture(lit_ground(first, first + part, range), direct_only()));
        }
        const Picture expected = sum(parts);
        CHECK(mean(expected) > 0.01);
        const Scene scene = lit_ground(0, lights, range);
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            Configuration configuration = direct_only();
            configuration.path = path;
            // Each of so many equal terms is rounded to half a unit in the last place of the sum so far: at
            // most 7e4 · 2⁻²⁵.
            CHECK(worst_error(picture(scene, configuration), expected, 1e-12) < 2.5e-3);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(BoundedWork, "shading evaluates all VPLs, however many there are") {
    check_vpls(70'000, VplVisibility::none);
}

TEST_CASE_FIXTURE(BoundedWork, "shading evaluates all VPLs with rays, each of which traverses a tree") {
    check_vpls(8192, VplVisibility::rays);
}

TEST_CASE_FIXTURE(BoundedWork, "every path shades with all lights, however many light every surface") {
    check_lights(std::numeric_limits<float>::infinity());
}

TEST_CASE_FIXTURE(BoundedWork, "every path shades with all lights, however long their lists are") {
    check_lights(16.0F);
}

TEST_CASE_FIXTURE(BoundedWork, "blended surfaces, which no two draws can shade in turn, have all lights") {
    constexpr std::uint32_t most = 40'000;
    constexpr float range = std::numeric_limits<float>::infinity();
    const auto behind_a_pane = [&](Scene scene) {
        Material pane;
        pane.base_colour.a = 0.5F;
        pane.alpha_mode = AlphaMode::blend;
        add(scene.world, at({0, 0.5F, 0}),
            MeshInstance{square(8.0F, std::make_shared<const Material>(pane))});
        return scene;
    };
    std::vector<Picture> parts;
    for (std::uint32_t first = 0; first < most; first += most / 8) {
        parts.push_back(picture(behind_a_pane(lit_ground(first, first + most / 8, range)), direct_only()));
    }
    const Picture whole = picture(behind_a_pane(lit_ground(0, most, range)), direct_only());
    CHECK(mean(whole) > 0.01);
    // 40,000 roundings of at most 2⁻²⁵ of the sum each.
    CHECK(worst_error(whole, sum(parts), 1e-12) < 1.3e-3);
}

TEST_CASE_FIXTURE(BoundedWork,
                  "paths lose no flux even if nearly every ray must be tested against nearly all triangles") {
    Scene scene = furnace_box(0.5F);
    add(scene.world, at({0, 0, 0}), MeshInstance{soup(3000, 1, 1.5F)});
    Configuration configuration = linear_configuration();
    configuration.vpls = {.placement = VplPlacement::paths, .count = 512, .bounces = 8};
    static_cast<void>(picture(scene, configuration));
    const EnergyAccount flux = renderer.report().vpls->flux;
    const glm::dvec3 rest = flux.emitted - flux.absorbed - flux.escaped - flux.truncated - flux.roulette;
    CHECK(flux.emitted.g > 1.0);
    CHECK(glm::abs(rest.g) < 1e-4 * flux.emitted.g);  // sums of a few hundred floats
}

}  // TEST_SUITE("bounded work")
