#include <doctest/doctest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/scene/lights.hpp>

TEST_SUITE("kinds of lights") {

using namespace candela;

namespace {

struct ThreeLights {
    World world;
    Entity lamp = world.create();
    Entity both = world.create();
    Entity nothing = world.create();

    ThreeLights() {
        world.set(lamp, PointLight{.intensity = 2.0F});
        world.set(both, SpotLight{.intensity = 3.0F});
        world.set(both, DirectionalLight{.illuminance = 5.0F});
    }
    std::vector<float> strengths_of(Entity entity) const {
        std::vector<float> strengths;
        visit_lights_of(world, entity, [&](const auto& light) { strengths.push_back(strength_of(light)); });
        return strengths;
    }
};

}  // namespace

TEST_CASE("each kind has traits, and they are visited in the order of AnyLight") {
    std::vector<std::string> names;
    std::map<std::string, std::string> units;
    for_each_light_kind([&](const auto& kind) {
        names.emplace_back(kind.name);
        units[kind.name] = kind.unit;
    });
    CHECK(names == std::vector<std::string>{"point light", "spot light", "directional light"});
    CHECK(units["point light"] == "candela");
    CHECK(units["directional light"] == "lux");
    CHECK(light_traits<DirectionalLight>.range == nullptr);
}

TEST_CASE_FIXTURE(ThreeLights, "the lights of a world are visited kind by kind, with their entities") {
    std::vector<std::pair<Entity, float>> found;
    visit_lights(world,
                 [&](Entity entity, const auto& light) { found.emplace_back(entity, strength_of(light)); });
    CHECK(found == std::vector<std::pair<Entity, float>>{{lamp, 2.0F}, {both, 3.0F}, {both, 5.0F}});
}

TEST_CASE_FIXTURE(ThreeLights, "an entity may have a light of each kind, or none") {
    CHECK(strengths_of(lamp) == std::vector{2.0F});
    CHECK(strengths_of(both) == std::vector{3.0F, 5.0F});
    CHECK(strengths_of(nothing).empty());
}

TEST_CASE_FIXTURE(ThreeLights, "the lights of an entity are edited, and no others") {
    edit_lights_of(world, both, [](auto& light) { strength_of(light) *= 2.0F; });
    CHECK(strengths_of(both) == std::vector{6.0F, 10.0F});
    CHECK(strengths_of(lamp) == std::vector{2.0F});
}

}  // TEST_SUITE("kinds of lights")
