// The frame does not depend on the order of its passes, as long as it is one that their declarations allow.

#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("pass order") {

using namespace candela;

namespace {

class PassOrder : public PathFixture {
 protected:
    /// Three frames: the first one, one after the camera has moved, and one after a light has.
    std::vector<Picture> frames(std::string_view name, const Configuration& configuration,
                                std::optional<std::uint32_t> shuffle) {
        Scene scene = shipped_scene(name);
        TestedRenderer shuffled(context->get_proc(), {.shuffle_passes = shuffle});
        REQUIRE(shuffled.configure(configuration).empty());
        const RenderTarget target(device, {24, 18});
        std::vector<Picture> pictures;
        const auto render = [&] {
            shuffled.render(scene.world, scene.camera, target.target());
            pictures.push_back(target.read());
        };
        render();
        scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.x += 0.05F; });
        render();
        for (const Entity light : std::vector<Entity>(scene.world.entities<PointLight>().begin(),
                                                      scene.world.entities<PointLight>().end())) {
            scene.world.edit<PointLight>(light, [](PointLight& lamp) { lamp.intensity *= 1.5F; });
        }
        render();
        return pictures;
    }

    void check_orders(std::string_view name, Configuration configuration) {
        CAPTURE(name);
        configuration.vpls.count = 64;
        const std::vector<Picture> usual = frames(name, configuration, {});
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            CAPTURE(seed);
            CHECK(frames(name, configuration, seed) == usual);
        }
    }

    static constexpr std::uint32_t seeds = 3;
};

}  // namespace

TEST_CASE_FIXTURE(PassOrder, "any legal order of passes gives the same frames, bit for bit") {
    Configuration configuration = linear_configuration();
    check_orders("cornell", configuration);
    configuration.visibility.method = VplVisibility::maps;
    configuration.interleave = Interleave::four;
    check_orders("house", configuration);
    configuration.refinement.enabled = true;
    configuration.vpls.updates = 16;
    check_orders("two-rooms", configuration);
    configuration.path = ShadingPath::clustered_forward;
    configuration.tone_map.automatic_exposure = true;
    check_orders("metals", configuration);
    configuration.path = ShadingPath::tiled_deferred;
    check_orders("glass", configuration);
}

}  // TEST_SUITE("pass order")
