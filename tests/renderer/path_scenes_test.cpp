#include <doctest/doctest.h>

#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr glm::uvec2 small{100, 70};  // not a multiple of the tile size

class PathScenes : public PathFixture {
 protected:
    void check_scene(const Scene& scene) {
        check_paths(scene, small, direct_only());
        check_paths(scene, small, few_vpls());
    }
};

}  // namespace

TEST_SUITE("paths: scenes") {
    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: boxes and rooms") {
        for (const char* name : {"cornell", "corner", "two-rooms", "furnace"}) {
            CAPTURE(name);
            check_scene(shipped_scene(name));
        }
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: blended surfaces") {
        check_scene(shipped_scene("glass"));
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: many lights in a hall") {
        Configuration with_vpls = few_vpls();
        with_vpls.shadows.enabled = false;
        const Scene scene = shipped_scene("hall-256");
        check_paths(scene, small, direct_only());
        check_paths(scene, small, with_vpls);
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: many lights between fins") {
        check_paths(shipped_scene("fins"), small, direct_only());
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: lights with shadows") {
        Scene scene = cluttered_room();
        add(scene.world, at({0.5F, 1.0F, 0.0F}), PointLight{.range = 3.0F});
        add(scene.world, looking({-1, 1, 1}, {0, 0, 0}), SpotLight{.intensity = 4.0F, .range = 4.0F});
        add(scene.world, looking({1, 1.5F, 1}, {0, 0, 0}), DirectionalLight{.illuminance = 0.3F});
        check_scene(scene);
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: targets of all shapes") {
        Scene scene = cluttered_room();
        add_ranged_lights(scene.world, 40, 0.8F);
        for (const glm::uvec2 size : {glm::uvec2(333, 217), glm::uvec2(1, 1), glm::uvec2(4096, 1),
                                      glm::uvec2(1, 300), glm::uvec2(16, 16), glm::uvec2(17, 15)}) {
            check_paths(scene, size, direct_only());
        }
    }

    TEST_CASE_FIXTURE(PathScenes, "every path gives the picture of forward: cells of all sizes") {
        Scene scene = cluttered_room();
        add_ranged_lights(scene.world, 40, 0.8F);
        for (const std::uint32_t tile_size : {16U, 32U, 64U}) {
            for (const std::uint32_t slices : {2U, 64U}) {
                CAPTURE(tile_size);
                CAPTURE(slices);
                Configuration configuration = direct_only();
                configuration.lists = {.tile_size = tile_size, .slices = slices};
                check_paths(scene, small, configuration);
            }
        }
    }
}
