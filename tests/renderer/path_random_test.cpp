#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iostream>
#include <limits>
#include <ostream>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("paths: random scenes") {

using namespace candela;

namespace {

// Scenes are described by integers, which RapidCheck can shrink: positions in steps of 5 cm, or indices into
// tables.
using Steps = std::array<int, 3>;

glm::vec3 metres(const Steps& steps) {
    return glm::vec3(steps[0], steps[1], steps[2]) * 0.05F;
}

struct LightPlan {
    int kind = 0;  // 0, 1: point, 2, 3: spot, 4: directional
    Steps from{};
    Steps towards{};
    int range = 0;
    int cone = 0;
};

struct ObjectPlan {
    int kind = 0;  // 0: square, 1: box, 2: soup, 3: blended square
    Steps place{};
    Steps towards{};
    int size = 1;
};

struct ScenePlan {
    std::vector<LightPlan> lights{};
    std::vector<ObjectPlan> objects{};
    Steps eye{};
    Steps towards{};
    bool orthographic = false;
    bool has_shadows = false;
    bool has_vpls = false;
    int tile = 0;
    int slices = 0;
    int interleave = 0;
};

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::array ranges{1.0F, 0.3F, 3.0F, 1e-3F, 1e6F, infinity};
constexpr std::array cones{0.7F, 0.05F, 0.3F, 1.2F, 1.5707963F};
constexpr std::array tiles{16U, 32U, 64U};
constexpr std::array slice_counts{24U, 2U, 64U};
constexpr std::array interleaves{Interleave::one, Interleave::two, Interleave::four, Interleave::eight};

template <class Table>
int index_of(const Table& table) {
    return *rc::gen::inRange(0, static_cast<int>(table.size()));
}
template <class Table>
auto entry(const Table& table, int index) {
    return table.at(static_cast<std::size_t>(index));
}

rc::Gen<Steps> steps(int reach) {
    return rc::gen::container<Steps>(rc::gen::inRange(-reach, reach + 1));
}

template <class T, class Make>
std::vector<T> several(int most, Make make) {
    return *rc::gen::resize(most, rc::gen::container<std::vector<T>>(rc::gen::exec(make)));
}

rc::Gen<ScenePlan> scene_plans() {
    return rc::gen::exec([] {
        const auto light = [] {
            return LightPlan{*rc::gen::inRange(0, 5), *steps(60), *steps(60), index_of(ranges),
                             index_of(cones)};
        };
        const auto object = [] {
            return ObjectPlan{*rc::gen::inRange(0, 4), *steps(40), *steps(40), *rc::gen::inRange(1, 20)};
        };
        return ScenePlan{.lights = several<LightPlan>(60, light),
                         .objects = several<ObjectPlan>(6, object),
                         .eye = *steps(60),
                         .towards = *steps(30),
                         .orthographic = *rc::gen::inRange(0, 4) == 1,
                         .has_shadows = *rc::gen::inRange(0, 3) == 1,
                         .has_vpls = *rc::gen::inRange(0, 3) == 1,
                         .tile = index_of(tiles),
                         .slices = index_of(slice_counts),
                         .interleave = index_of(interleaves)};
    });
}

/// Like `looking`, but for any two points.
Transform facing(const Steps& from, const Steps& towards) {
    const glm::vec3 here = metres(from);
    glm::vec3 there = metres(towards);
    if (here == there) there.z -= 1.0F;
    const glm::vec3 way = glm::abs(there - here);
    const bool upright = way.x + way.z < 0.01F * way.y;
    return looking(here, there, upright ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
}

void add_light(World& world, const LightPlan& plan) {
    const Transform pose = facing(plan.from, plan.towards);
    const float range = entry(ranges, plan.range);
    if (plan.kind < 2) {
        add(world, pose, PointLight{.range = range});
    } else if (plan.kind < 4) {
        add(world, pose, SpotLight{.range = range, .outer_cone = entry(cones, plan.cone)});
    } else {
        add(world, pose, DirectionalLight{.illuminance = 0.1F});
    }
}

std::shared_ptr<const Material> pane() {
    Material material;
    material.base_colour = {0.4F, 0.6F, 0.8F, 0.5F};
    material.double_sided = true;
    material.alpha_mode = AlphaMode::blend;
    return std::make_shared<const Material>(std::move(material));
}

void add_object(World& world, const ObjectPlan& plan) {
    Transform pose = facing(plan.place, plan.towards);
    pose.scale = glm::vec3(0.1F * static_cast<float>(plan.size));
    const auto grey = diffuse(glm::vec3(0.5F), true);
    const std::array meshes{square(1.0F, grey), box_inwards(1.0F, grey), soup(50, 3), square(1.0F, pane())};
    add(world, pose, MeshInstance{entry(meshes, plan.kind)});
}

Scene build(const ScenePlan& plan) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{box_inwards(3.5F, diffuse({0.5F, 0.6F, 0.7F}))});
    for (const ObjectPlan& object : plan.objects) add_object(scene.world, object);
    for (const LightPlan& light : plan.lights) add_light(scene.world, light);
    Camera camera{.vertical_fov = 1.2F};
    if (plan.orthographic) {
        camera = {.projection = Camera::Projection::orthographic, .half_height = 1.5F, .far_plane = 20.0F};
    }
    scene.camera = add(scene.world, facing(plan.eye, plan.towards), camera);
    return scene;
}

Configuration configuration_of(const ScenePlan& plan) {
    Configuration configuration = linear_configuration();
    configuration.indirect = plan.has_vpls;
    configuration.interleave = entry(interleaves, plan.interleave);
    configuration.shadows = {
        .enabled = plan.has_shadows, .cube_resolution = 16, .map_resolution = 32, .budget_mib = 1};
    configuration.lists = {.tile_size = entry(tiles, plan.tile), .slices = entry(slice_counts, plan.slices)};
    return configuration;
}

std::ostream& operator<<(std::ostream& out, const Steps& steps) {
    return out << '(' << steps[0] << ' ' << steps[1] << ' ' << steps[2] << ')';
}

std::ostream& operator<<(std::ostream& out, const ScenePlan& plan) {
    out << "eye " << plan.eye << " towards " << plan.towards << (plan.orthographic ? " orthographic" : "")
        << (plan.has_shadows ? " shadows" : "") << (plan.has_vpls ? " VPLs interleaved by " : "")
        << to_string(entry(interleaves, plan.interleave)) << ", tiles of " << entry(tiles, plan.tile)
        << ", slices " << entry(slice_counts, plan.slices) << '\n';
    for (const LightPlan& l : plan.lights) {
        out << "light " << l.kind << ' ' << l.from << " towards " << l.towards << " range "
            << entry(ranges, l.range) << " cone " << entry(cones, l.cone) << '\n';
    }
    for (const ObjectPlan& o : plan.objects) {
        out << "object " << o.kind << ' ' << o.place << " towards " << o.towards << " size " << o.size
            << '\n';
    }
    return out;
}

/// rc::check with fewer than its 100 rounds, because each takes about a second with a software driver.
template <class Property>
bool holds(int rounds, Property property) {
    rc::detail::TestParams params = rc::detail::configuration().testParams;
    params.maxSuccess = std::min(params.maxSuccess, rounds);
    const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata{}, params);
    rc::detail::printResultMessage(result, std::cerr);
    std::cerr << '\n';
    return result.template is<rc::detail::SuccessResult>();
}

}  // namespace

TEST_CASE_FIXTURE(PathFixture, "every path gives the picture of forward: random scenes") {
    const auto measure = [&](const ScenePlan& plan) {
        return worst_path(build(plan), {64, 48}, configuration_of(plan));
    };
    // Random scenes may be dark; this one must not be.
    const ScenePlan lit{.lights = {{.from = {0, 20, 0}, .range = 5}}, .eye = {0, 0, 40}};
    CHECK(measure(lit).reference_mean > 0.0);
    CHECK(holds(15, [&] {
        const ScenePlan plan = *scene_plans();
        const PathError worst = measure(plan);
        RC_LOG() << plan << to_string(worst.path) << " is off by " << worst.error << '\n';
        RC_ASSERT(worst.error < path_tolerance);
    }));
}

}  // TEST_SUITE("paths: random scenes")
