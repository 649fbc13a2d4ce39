#include <doctest/doctest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr int steps = 24;

/// A renderer that lives through a sequence of edits, and the scene that they are done to.
class Sequence : public RenderFixture {
 protected:
    /// One edit at random; gives its name.
    std::string edit(std::mt19937& random) {
        World& world = scene.world;
        const auto draw = [&](int choices) {
            return static_cast<int>(random() % static_cast<unsigned>(choices));
        };
        const auto offset = [&] { return 0.1F * static_cast<float>(draw(9) - 4); };
        const auto shift = [&](Entity entity) {
            world.edit<Transform>(entity,
                                  [&](Transform& t) { t.translation += glm::vec3(offset(), 0, offset()); });
        };
        switch (draw(8)) {
            case 0:
                configuration.path = all_shading_paths.at(static_cast<std::size_t>(draw(7)));
                configure(configuration);
                return "path " + std::string(to_string(configuration.path));
            case 1:
                configuration.vpls.count = std::array{0U, 8U, 40U}.at(static_cast<std::size_t>(draw(3)));
                configuration.shadows.enabled = draw(2) == 0;
                configure(configuration);
                return "VPLs and shadows";
            case 2:
                size = std::array{glm::uvec2(40, 30), glm::uvec2(33, 21), glm::uvec2(64, 8)}.at(
                    static_cast<std::size_t>(draw(3)));
                return "resize";
            case 3:
                shift(scene.light);
                return "move the light";
            case 4:
                shift(scene.camera);
                return "move the camera";
            case 5:
                shift(block);
                return "move a mesh";
            case 6:
                extra.push_back(add(world, at({offset(), 1.0F + offset(), offset()}),
                                    PointLight{.intensity = 0.5F, .range = 0.8F}));
                return "add a light";
            default:
                if (extra.empty()) {
                    return "nothing";
                }
                world.destroy(extra.back());
                extra.pop_back();
                return "remove a light";
        }
    }

    Picture fresh_picture() {
        Renderer fresh(context->get_proc());
        REQUIRE(fresh.configure(configuration).empty());
        const RenderTarget target(device, size);
        fresh.render(scene.world, scene.camera, target.target());
        return target.read();
    }

    Scene scene = cornell_box();
    Entity block = last_mesh(scene.world);
    std::vector<Entity> extra;
    glm::uvec2 size{40, 30};
    Configuration configuration = [] {
        Configuration linear = linear_configuration();
        linear.vpls.count = 8;
        linear.shadows.cube_resolution = linear.shadows.map_resolution = 64;
        return linear;
    }();

 private:
    /// The last of the view: a block, which may move without opening the room.
    static Entity last_mesh(const World& world) {
        Entity last{};
        for (const auto& [entity, mesh] : world.view<MeshInstance>()) {
            last = entity;
        }
        return last;
    }
};

}  // namespace

TEST_SUITE("sequences") {
    TEST_CASE_FIXTURE(Sequence, "after any edits a frame is that of a fresh renderer, bit for bit") {
        configure(configuration);
        for (const unsigned seed : {1U, 2U, 3U}) {
            std::mt19937 random(seed);
            std::string history;
            for (int step = 0; step < steps; ++step) {
                history += edit(random) + "; ";
                CAPTURE(seed);
                CAPTURE(history);
                const bool same = render(scene, size) == fresh_picture();
                REQUIRE(same);
            }
        }
    }
}
