// Animations, against the formulas of glTF 2.0, appendix C, and figures with
// skeletons and morph targets, against positions that are worked out by hand
// and against a plain second implementation.

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include <candela/scene/animate.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/scene/tangents.hpp>
#include "tests/seed.hpp"

using namespace candela;

namespace {

constexpr float epsilon = std::numeric_limits<float>::epsilon();

AnimationSampler sampler_of(Interpolation interpolation, std::vector<float> times,
                            std::vector<float> values) {
    return {interpolation, std::make_shared<const std::vector<float>>(std::move(times)),
            std::make_shared<const std::vector<float>>(std::move(values))};
}

/// A world with an entity that a player moves with one channel.
struct Moving {
    World world;
    Entity target = world.create();
    Entity player = world.create();

    Moving(AnimatedProperty property, AnimationSampler sampler) {
        AnimationClip clip;
        clip.name = "move";
        clip.duration = sampler.times->back();
        clip.samplers.push_back(std::move(sampler));
        clip.channels.push_back({0, property, 0});
        AnimationPlayer playing;
        playing.animations = std::make_shared<const Animations>(
            Animations{{std::make_shared<const AnimationClip>(std::move(clip))}, {target}});
        world.set(player, playing);
    }

    /// The target's transform at a time.
    Transform at(double seconds) {
        world.edit<AnimationPlayer>(player, [&](AnimationPlayer& playing) { playing.time = seconds; });
        CHECK(apply_animation(world, player).empty());
        const auto* const transform = world.find<Transform>(target);
        return transform ? *transform : Transform{};
    }
    const AnimationPlayer& state() { return world.get<AnimationPlayer>(player); }
};

glm::quat turn(float degrees, const glm::vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

std::vector<float> numbers_of(const std::vector<glm::quat>& rotations) {
    std::vector<float> numbers;
    for (const glm::quat& q : rotations) numbers.insert(numbers.end(), {q.x, q.y, q.z, q.w});
    return numbers;
}

/// Between two rotations, radians.
double angle_between(const glm::quat& a, const glm::quat& b) {
    // The chord between unit quaternions, which stays exact for small angles.
    const glm::dquat da(a);
    const glm::dquat db(b);
    const double chord = std::min(glm::length(da - db), glm::length(da + db));
    return 4.0 * std::asin(std::min(0.5 * chord, 1.0));
}

/// A mesh of one primitive with these vertices and triangles.
Mesh mesh_of(std::vector<Vertex> vertices, std::vector<std::uint32_t> indices) {
    Mesh mesh;
    Primitive primitive;
    primitive.vertices = std::move(vertices);
    primitive.indices = std::move(indices);
    primitive.material = std::make_shared<const Material>();
    mesh.primitives.push_back(std::move(primitive));
    return mesh;
}

Vertex vertex_at(const glm::vec3& position, const glm::vec3& normal = {0, 0, 1}) {
    Vertex vertex{position, normal, glm::vec2(0.0F)};
    return vertex;
}

/// A figure with joints that a test places, and the result of its deformation.
struct Posed {
    World world;
    MeshDeformer deformer;
    Entity figure = world.create();
    std::vector<Entity> joints;

    explicit Posed(Mesh mesh, std::size_t joint_count) {
        Skin skin;
        for (std::size_t i = 0; i < joint_count; ++i) {
            joints.push_back(world.create());
            world.set(joints.back(), Transform{});
        }
        skin.joints = joints;
        world.set(figure, Transform{});
        world.set(figure, skin);
        world.set(figure, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    }

    const std::vector<Vertex>& vertices() {
        const AnimationFaults faults = deformer.update(world);
        for (const std::string& fault : faults) FAIL(fault);
        return world.get<DeformedMesh>(figure).vertices->at(0);
    }
};

std::vector<Influences> all_of_joint(std::size_t vertices, std::uint16_t joint) {
    return std::vector<Influences>(vertices, {glm::u16vec4(joint, 0, 0, 0), glm::vec4(1, 0, 0, 0)});
}

glm::vec3 random_vector(std::mt19937& random) {
    std::uniform_real_distribution<float> within(-1.0F, 1.0F);
    const float x = within(random);
    const float y = within(random);
    return {x, y, within(random)};
}

glm::quat random_rotation(std::mt19937& random) {
    const glm::vec3 axis = glm::normalize(random_vector(random) + glm::vec3(0.0F, 0.0F, 2.0F));
    return turn(180.0F * random_vector(random).x, axis);
}

}  // namespace

TEST_SUITE("animation") {
TEST_CASE("steps hold the value of the key before") {
    Moving moving(AnimatedProperty::translation,
                  sampler_of(Interpolation::step, {1, 2, 4}, {1, 0, 0, 2, 0, 0, 3, 0, 0}));
    using Expected = std::pair<double, float>;  // x after so many seconds
    for (const Expected& expected : std::vector<Expected>{
             {-1, 1.0F}, {0, 1.0F}, {1, 1.0F}, {1.99, 1.0F}, {2, 2.0F}, {3.9, 2.0F}, {4, 3.0F}, {9, 3.0F}}) {
        CAPTURE(expected.first);
        CHECK(moving.at(expected.first).translation == glm::vec3(expected.second, 0, 0));
    }
}

TEST_CASE("linear translations and scales are straight and clamped") {
    for (const AnimatedProperty property : {AnimatedProperty::translation, AnimatedProperty::scale}) {
        Moving moving(property, sampler_of(Interpolation::linear, {1, 3}, {2, 4, 8, 6, 0, 8}));
        const auto value = [&](double seconds) {
            const Transform transform = moving.at(seconds);
            return property == AnimatedProperty::scale ? transform.scale : transform.translation;
        };
        CHECK(value(0.0) == glm::vec3(2, 4, 8));
        CHECK(value(1.5) == glm::vec3(3, 3, 8));
        CHECK(value(2.0) == glm::vec3(4, 2, 8));
        CHECK(value(5.0) == glm::vec3(6, 0, 8));
    }
}

TEST_CASE("a quarter of the way to a turn by 90 degrees is a turn by 22.5") {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -1));
    for (const float sign : {1.0F, -1.0F}) {  // a quaternion and its negative are the same rotation
        const glm::quat end = sign * turn(90.0F, axis);
        Moving moving(AnimatedProperty::rotation,
                      sampler_of(Interpolation::linear, {0, 1}, numbers_of({turn(0.0F, axis), end})));
        for (const float share : {0.0F, 0.25F, 0.5F, 0.9F, 1.0F}) {
            // The roundings of a few floats.
            CHECK(angle_between(moving.at(static_cast<double>(share)).rotation, turn(90.0F * share, axis)) <=
                  8.0 * epsilon);
        }
    }
}

TEST_CASE("rotations that are nearly the same do not lose their precision") {
    const glm::vec3 axis(0, 1, 0);
    for (const float degrees : {1e-5F, 1e-3F, 0.02F, 0.1F}) {
        Moving moving(
            AnimatedProperty::rotation,
            sampler_of(Interpolation::linear, {0, 1}, numbers_of({turn(0.0F, axis), turn(degrees, axis)})));
        CHECK(angle_between(moving.at(0.5).rotation, turn(0.5F * degrees, axis)) <= 4.0 * epsilon);
    }
}

TEST_CASE("a cubic spline through a cubic polynomial is that polynomial") {
    const auto position = [](float t) {
        return glm::vec3(t * t * t - 2.0F * t, 3.0F * t * t + 1.0F, 5.0F - t - 0.5F * t * t * t);
    };
    const auto slope = [](float t) { return glm::vec3(3.0F * t * t - 2.0F, 6.0F * t, -1.0F - 1.5F * t * t); };
    std::vector<float> values;
    const std::vector<float> times{0.5F, 1.0F, 2.5F};
    for (const float t : times) {
        for (const glm::vec3& part : {slope(t), position(t), slope(t)}) {
            values.insert(values.end(), {part.x, part.y, part.z});
        }
    }
    Moving moving(AnimatedProperty::translation, sampler_of(Interpolation::cubic_spline, times, values));
    for (const float t : {0.5F, 0.6F, 0.75F, 1.0F, 1.25F, 2.0F, 2.4F, 2.5F}) {
        CAPTURE(t);
        // The terms of the spline are up to 20 large, four of them with a few
        // roundings each.
        CHECK(glm::distance(moving.at(static_cast<double>(t)).translation, position(t)) <=
              4.0F * 20.0F * 4.0F * epsilon);
    }
    CHECK(moving.at(0.0).translation == position(0.5F));
    CHECK(moving.at(9.0).translation == position(2.5F));
}

TEST_CASE("rotations of a cubic spline are of unit length") {
    const std::vector<float> none(4, 0.0F);
    std::vector<float> values;
    for (const glm::quat& q : {turn(0.0F, {1, 0, 0}), turn(120.0F, {1, 0, 0})}) {
        values.insert(values.end(), none.begin(), none.end());
        values.insert(values.end(), {q.x, q.y, q.z, q.w});
        values.insert(values.end(), none.begin(), none.end());
    }
    Moving moving(AnimatedProperty::rotation, sampler_of(Interpolation::cubic_spline, {0, 2}, values));
    CHECK(std::abs(glm::length(moving.at(0.7).rotation) - 1.0F) <= 2.0F * epsilon);
    // Halfway, without slopes, the sum is that of both ends, in the direction
    // of the mean turn.
    CHECK(angle_between(moving.at(1.0).rotation, turn(60.0F, {1, 0, 0})) <= 8.0 * epsilon);
}

TEST_CASE("morph weights of all interpolations") {
    Moving moving(AnimatedProperty::morph_weights,
                  sampler_of(Interpolation::linear, {0, 1}, {0, 1, 4, 2, 1, 0}));
    moving.at(0.25);
    CHECK(moving.world.get<MorphWeights>(moving.target).values == std::vector<float>{0.5F, 1.0F, 3.0F});
    CHECK_FALSE(moving.world.has<Transform>(moving.target));
    Moving spline(AnimatedProperty::morph_weights,
                  sampler_of(Interpolation::cubic_spline, {0, 2}, {9, 9, 1, 2, 0, 0, 0, 0, 3, 6, 9, 9}));
    spline.at(1.0);
    CHECK(spline.world.get<MorphWeights>(spline.target).values == std::vector<float>{2.0F, 4.0F});
}

TEST_CASE("as systems of a graph, players follow the host's clock and deform meshes in the same frame") {
    Moving moving(AnimatedProperty::morph_weights, sampler_of(Interpolation::linear, {0, 4}, {0, 1}));
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    MorphTarget raised;
    raised.positions.assign(3, glm::vec3(0, 0, 8));
    mesh.primitives[0].targets = {raised};
    moving.world.set(moving.target, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});

    FrameGraph graph;
    const AnimationSystems systems = add_animation(graph);
    GraphRuntime runtime;
    runtime.switch_to(compile(std::move(graph)).take());
    const auto ran_at = [&](double seconds) {
        runtime.set(systems.seconds, seconds);
        std::string names;
        for (const PassRecord& pass : runtime.run(moving.world).passes) {
            if (pass.ran) names += std::string(pass.name) + " ";
        }
        return names;
    };
    const auto depth = [&] {
        return moving.world.get<DeformedMesh>(moving.target).vertices->front().front().position.z;
    };
    CHECK(ran_at(10.0) == "animation deformation ");  // the clock begins where the host's is
    CHECK(depth() == 0.0F);
    CHECK(ran_at(11.0) == "animation deformation ");
    CHECK(depth() == 2.0F);
    CHECK(ran_at(11.0).empty());
    moving.world.edit<AnimationPlayer>(moving.player,
                                       [](AnimationPlayer& player) { player.playing = false; });
    CHECK(ran_at(12.0) == "animation ");
    CHECK(depth() == 2.0F);
    CHECK(runtime.value(systems.animation_faults).empty());

    moving.world.destroy(moving.target);
    moving.world.edit<AnimationPlayer>(moving.player, [](AnimationPlayer& player) { player.playing = true; });
    static_cast<void>(ran_at(13.0));
    CHECK(runtime.value(systems.animation_faults).size() == 1);
}

TEST_CASE("players loop, end, run backwards and rest") {
    Moving moving(AnimatedProperty::translation,
                  sampler_of(Interpolation::linear, {0, 4}, {0, 0, 0, 4, 0, 0}));
    const auto x = [&] { return moving.world.get<Transform>(moving.target).translation.x; };
    const auto edit = [&](const std::function<void(AnimationPlayer&)>& change) {
        moving.world.edit<AnimationPlayer>(moving.player, change);
    };
    CHECK(advance_animations(moving.world, 1.5).empty());
    CHECK(x() == 1.5F);
    CHECK(advance_animations(moving.world, 3.0).empty());
    CHECK(moving.state().time == 0.5);
    CHECK(x() == 0.5F);
    edit([](AnimationPlayer& player) { player.speed = -2.0; });
    CHECK(advance_animations(moving.world, 1.0).empty());
    CHECK(moving.state().time == 2.5);
    edit([](AnimationPlayer& player) { player.looping = false; });
    CHECK(advance_animations(moving.world, 9.0).empty());
    CHECK(moving.state().time == 0.0);
    CHECK_FALSE(moving.state().playing);
    edit([](AnimationPlayer& player) {
        player.speed = 1.0;
        player.playing = true;
    });
    CHECK(advance_animations(moving.world, 9.0).empty());
    CHECK(x() == 4.0F);
    CHECK_FALSE(moving.state().playing);

    moving.world.set(moving.target, Transform{{7, 7, 7}});  // dragged by a user, while nothing plays
    const Tick before = moving.world.revision();
    CHECK(advance_animations(moving.world, 1.0).empty());
    CHECK(moving.world.revision() == before);
}

TEST_CASE("only what changes is edited, and the parent stays") {
    Moving moving(AnimatedProperty::translation,
                  sampler_of(Interpolation::step, {0, 1, 2}, {1, 0, 0, 2, 0, 0, 2, 0, 0}));
    const Entity parent = moving.world.create();
    moving.world.set(moving.target,
                     Transform{.rotation = turn(30.0F, {0, 1, 0}), .scale = glm::vec3(2), .parent = parent});
    CHECK(advance_animations(moving.world, 0.25).empty());
    const Tick before = moving.world.changed<Transform>(moving.target);
    CHECK(advance_animations(moving.world, 0.25).empty());
    CHECK(moving.world.changed<Transform>(moving.target) == before);
    CHECK(advance_animations(moving.world, 0.75).empty());
    CHECK(moving.world.changed<Transform>(moving.target) > before);
    CHECK(moving.world.get<Transform>(moving.target) == Transform{.translation = {2, 0, 0},
                                                                  .rotation = turn(30.0F, {0, 1, 0}),
                                                                  .scale = glm::vec3(2),
                                                                  .parent = parent});
}

TEST_CASE("faults of players are told, and the rest still plays") {
    Moving moving(AnimatedProperty::translation, sampler_of(Interpolation::linear, {0}, {1, 2, 3}));
    moving.world.set(moving.player, Name{"walk"});
    const auto fault_of = [&](const std::function<void(AnimationClip&, AnimationPlayer&)>& change) {
        World world = moving.world;
        AnimationPlayer player = world.get<AnimationPlayer>(moving.player);
        AnimationClip clip = *player.animations->clips[0];
        clip.channels.insert(clip.channels.begin(),
                             clip.channels[0]);  // the one that is changed
        change(clip, player);
        player.animations = std::make_shared<const Animations>(
            Animations{{std::make_shared<const AnimationClip>(clip)}, player.animations->targets});
        world.set(moving.player, player);
        const AnimationFaults faults = advance_animations(world, 0.0);
        return faults.size() == 1 ? faults[0] : std::to_string(faults.size()) + " faults";
    };
    const std::string in_channel = "entity \"walk\": channel 0 of its clip 0: ";
    CHECK(fault_of([](auto&, auto& player) { player.clip = 3; }) ==
          "entity \"walk\": its clip 3 does not exist");
    CHECK(fault_of([](auto&, auto& player) { player.time = NAN; }) ==
          "entity \"walk\": its time is not finite");
    CHECK(fault_of([](auto& clip, auto&) { clip.channels[0].target = 7; }) ==
          in_channel + "its target 7 no longer exists");
    CHECK(fault_of([](auto& clip, auto&) { clip.channels[0].sampler = 7; }) ==
          in_channel + "its sampler 7 does not exist");
    CHECK(fault_of([](auto& clip, auto&) { clip.channels[0].property = AnimatedProperty::rotation; }) ==
          in_channel + "its sampler has 3 numbers for 1 keys");
    CHECK(fault_of([](auto& clip, auto&) {
              clip.samplers.push_back({});
              clip.channels[0].sampler = 1;
          }) == in_channel + "its sampler has no keys");
    moving.world.destroy(moving.target);
    CHECK(advance_animations(moving.world, 0.0) ==
          AnimationFaults{in_channel + "its target 0 no longer exists"});
}

}  // TEST_SUITE("animation")

TEST_SUITE("deformation") {
TEST_CASE("two joints bend a bar") {
    // Along x from 0 to 2, the second joint at x = 1. In the middle, half of
    // each joint.
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 1, 0}, {0, 1, 0}), vertex_at({2, 0, 0}),
                         vertex_at({2, 1, 0}, {1, 0, 0})},
                        {0, 1, 2, 2, 1, 3});
    mesh.primitives[0].influences = {{{{0, 0, 0, 0}, {1, 0, 0, 0}},
                                      {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}},
                                      {{1, 0, 0, 0}, {1, 0, 0, 0}},
                                      {{1, 0, 0, 0}, {1, 0, 0, 0}}}};
    Posed posed(std::move(mesh), 2);
    Skin skin = posed.world.get<Skin>(posed.figure);
    skin.inverse_bind_matrices = std::make_shared<const std::vector<glm::mat4>>(
        std::vector<glm::mat4>{glm::mat4(1.0F), glm::translate(glm::mat4(1.0F), glm::vec3(-1, 0, 0))});
    posed.world.set(posed.figure, skin);
    // The second joint, a child of the first, turns by 90 degrees around z.
    posed.world.set(posed.joints[1], Transform{.translation = {1, 0, 0},
                                               .rotation = turn(90.0F, {0, 0, 1}),
                                               .scale = glm::vec3(1),
                                               .parent = posed.joints[0]});
    const std::vector<Vertex>& bent = posed.vertices();
    // The roundings of a few products of numbers up to 2.
    constexpr float tolerance = 8.0F * epsilon;
    CHECK(glm::distance(bent[0].position, {0, 0, 0}) <= tolerance);
    // (1, 1) turned around (1, 0) is (0, 0); the mean of both.
    CHECK(glm::distance(bent[1].position, {0.5F, 0.5F, 0}) <= tolerance);
    CHECK(glm::distance(bent[2].position, {1, 1, 0}) <= tolerance);
    CHECK(glm::distance(bent[3].position, {0, 1, 0}) <= tolerance);
    // Half of 0 and half of 90 degrees turn by 45.
    CHECK(glm::distance(bent[1].normal, glm::normalize(glm::vec3(-1, 1, 0))) <= tolerance);
    CHECK(glm::distance(bent[3].normal, {0, 1, 0}) <= tolerance);

    // The first joint moves both.
    posed.world.set(posed.joints[0],
                    Transform{.translation = {0, 0, 5}, .rotation = turn(180.0F, {0, 0, 1})});
    CHECK(glm::distance(posed.vertices()[2].position, {-1, -1, 5}) <= tolerance);
}

TEST_CASE(
    "joints that all move rigidly move the figure rigidly, whatever "
    "the weights") {
    std::mt19937 random(test_seed(70));
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    std::vector<Vertex> vertices;
    std::vector<Influences> first;
    std::vector<Influences> second;
    for (std::size_t i = 0; i < 200; ++i) {
        Vertex vertex = vertex_at(random_vector(random), glm::normalize(random_vector(random)));
        vertex.tangent = packed_tangent(glm::vec4(glm::normalize(random_vector(random)), -1.0F));
        vertices.push_back(vertex);
        for (std::vector<Influences>* const set : {&first, &second}) {
            Influences influences;
            for (int k = 0; k < 4; ++k) {
                influences.joints[k] = static_cast<std::uint16_t>(random() % 5);
                influences.weights[k] = share(random);  // the sums are not 1
            }
            set->push_back(influences);
        }
    }
    Mesh mesh = mesh_of(vertices, {0, 1, 2});
    mesh.primitives[0].influences = {first, second};
    Posed posed(mesh, 5);
    const Transform moved{.translation = {3, -2, 1}, .rotation = random_rotation(random)};
    for (const Entity joint : posed.joints) posed.world.set(joint, moved);
    const glm::mat4 matrix = local_matrix(moved);
    const std::vector<Vertex>& result = posed.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        // Eight terms with a rounding each, of numbers below 5.
        constexpr float tolerance = 8.0F * 5.0F * epsilon;
        CHECK(glm::distance(result[i].position, glm::vec3(matrix * glm::vec4(vertices[i].position, 1.0F))) <=
              tolerance);
        CHECK(glm::distance(result[i].normal, glm::mat3(matrix) * vertices[i].normal) <= tolerance);
        const glm::vec4 tangent = unpacked_tangent(result[i].tangent);
        const glm::vec3 before(unpacked_tangent(vertices[i].tangent));
        // Both are rounded to steps of 1/32767.
        CHECK(glm::distance(glm::vec3(tangent), glm::mat3(matrix) * before) <= 2.0F / 32767.0F);
        CHECK(tangent.w == -1.0F);
    }
}

TEST_CASE(
    "under any scale, normals stay perpendicular to the faces and in "
    "front of them") {
    std::mt19937 random(test_seed(71));
    for (int round = 0; round < 50; ++round) {
        std::vector<Vertex> corners;
        for (int k = 0; k < 3; ++k) corners.push_back(vertex_at(random_vector(random)));
        const auto face = [](const std::vector<Vertex>& of) {
            return glm::normalize(glm::cross(glm::dvec3(of[1].position) - glm::dvec3(of[0].position),
                                             glm::dvec3(of[2].position) - glm::dvec3(of[0].position)));
        };
        for (Vertex& corner : corners) corner.normal = glm::vec3(face(corners));
        Mesh mesh = mesh_of(corners, {0, 1, 2});
        mesh.primitives[0].influences = {all_of_joint(3, 0)};
        Posed posed(mesh, 1);
        // Flat, mirrored, tiny and huge ones too.
        const float size = std::vector<float>{1.0F, 1e-12F, 1e6F}[static_cast<std::size_t>(round % 3)];
        const glm::vec3 scale = size * glm::vec3(round % 2 == 0 ? -0.3F : 2.0F, 0.7F, 3.0F);
        posed.world.set(posed.joints[0], Transform{.rotation = random_rotation(random), .scale = scale});
        const std::vector<Vertex> result = posed.vertices();
        for (const Vertex& corner : result) {
            // Positions are rounded to floats, in triangles that may be thin and
            // are stretched by 10.
            CHECK(glm::distance(glm::dvec3(corner.normal), face(result)) <= 1e-3);
            CHECK(std::abs(glm::length(corner.normal) - 1.0F) <= 4.0F * epsilon);
        }
    }
}

TEST_CASE("a joint that flattens the figure still gives normals") {
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    mesh.primitives[0].influences = {all_of_joint(3, 0)};
    Posed posed(mesh, 1);
    posed.world.set(posed.joints[0], Transform{.rotation = turn(90.0F, {1, 0, 0}), .scale = {1, 1, 0}});
    // The normal (0, 0, 1), turned.
    CHECK(glm::distance(posed.vertices()[0].normal, {0, -1, 0}) <= 4.0F * epsilon);
    posed.world.set(posed.joints[0], Transform{.scale = glm::vec3(0)});
    CHECK(posed.vertices()[0].normal == glm::vec3(0, 0, 1));
}

TEST_CASE(
    "the entity's own transform does not move a figure, and weights of "
    "zero follow the first joint") {
    Mesh mesh = mesh_of({vertex_at({1, 2, 3}), vertex_at({2, 2, 3}), vertex_at({1, 3, 3})}, {0, 1, 2});
    mesh.primitives[0].influences = {std::vector<Influences>(3, {glm::u16vec4(1, 0, 0, 0), glm::vec4(0.0F)})};
    Posed posed(mesh, 2);
    posed.world.set(posed.joints[1], Transform{{10, 0, 0}});
    posed.world.set(
        posed.figure,
        Transform{.translation = {5, 6, 7}, .rotation = turn(40.0F, {0, 1, 0}), .scale = glm::vec3(2, 2, 4)});
    const glm::mat4 world = world_matrix(posed.world, posed.figure);
    const glm::vec3 seen(world * glm::vec4(posed.vertices()[0].position, 1.0F));
    // The inverse and the product of matrices with numbers below 20.
    CHECK(glm::distance(seen, {11, 2, 3}) <= 20.0F * 16.0F * epsilon);
}

TEST_CASE("the fast loop agrees with plain matrices in double precision") {
    std::mt19937 random(test_seed(72));
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    constexpr std::size_t joint_count = 40;
    std::vector<Vertex> vertices;
    std::vector<std::vector<Influences>> sets(2);
    for (std::size_t i = 0; i < 500; ++i) {
        vertices.push_back(vertex_at(random_vector(random), glm::normalize(random_vector(random))));
        for (std::vector<Influences>& set : sets) {
            Influences influences;
            for (int k = 0; k < 4; ++k) {
                influences.joints[k] = static_cast<std::uint16_t>(random() % joint_count);
                influences.weights[k] = random() % 3 == 0 ? 0.0F : share(random);
            }
            set.push_back(influences);
        }
        sets[0].back().weights[0] += 0.1F;  // one at least
    }
    Mesh mesh = mesh_of(vertices, {0, 1, 2});
    mesh.primitives[0].influences = sets;
    Posed posed(mesh, joint_count);
    std::vector<glm::mat4> binds;
    std::vector<glm::dmat4> moves;
    for (const Entity joint : posed.joints) {
        posed.world.set(joint, Transform{.translation = random_vector(random),
                                         .rotation = random_rotation(random),
                                         .scale = 1.0F + 0.5F * random_vector(random)});
        binds.push_back(
            local_matrix({.translation = random_vector(random), .rotation = random_rotation(random)}));
    }
    Skin skin = posed.world.get<Skin>(posed.figure);
    skin.inverse_bind_matrices = std::make_shared<const std::vector<glm::mat4>>(binds);
    posed.world.set(posed.figure, skin);
    for (std::size_t i = 0; i < joint_count; ++i) {
        moves.push_back(glm::dmat4(world_matrix(posed.world, posed.joints[i])) * glm::dmat4(binds[i]));
    }
    const std::vector<Vertex>& result = posed.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::dmat4 mean(0.0);
        double sum = 0.0;
        for (const std::vector<Influences>& set : sets) {
            for (int k = 0; k < 4; ++k) {
                mean += static_cast<double>(set[i].weights[k]) * moves[set[i].joints[k]];
                sum += static_cast<double>(set[i].weights[k]);
            }
        }
        mean /= sum;
        const glm::dvec3 position(mean * glm::dvec4(glm::dvec3(vertices[i].position), 1.0));
        // Products of matrices with numbers below 8, and sums of 8 and 4 terms.
        constexpr double tolerance = 32.0 * 8.0 * epsilon;
        CHECK(glm::distance(glm::dvec3(result[i].position), position) <= tolerance);
        const glm::dmat3 linear(mean);
        const double volume = glm::determinant(linear);
        if (std::abs(volume) < 0.05) continue;  // where means of turns nearly cancel, errors grow
        const glm::dvec3 normal =
            glm::normalize(glm::transpose(glm::inverse(linear)) * glm::dvec3(vertices[i].normal));
        const double side = volume < 0.0 ? -1.0 : 1.0;
        // Divided by lengths that are up to 20 times smaller than the numbers.
        CHECK(glm::distance(glm::dvec3(result[i].normal), side * normal) <= 20.0 * tolerance);
    }
}

TEST_CASE("morph targets add up in proportion to their weights") {
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    const glm::vec3 none(0.0F);
    mesh.primitives[0].targets = {{{{1, 0, 0}, {0, 2, 0}, none}, {{1, 0, 0}, none, none}, {}},
                                  {{none, {0, 0, 4}, {0, 0, 4}}, {}, {}}};
    World world;
    MeshDeformer deformer;
    const Entity entity = world.create();
    world.set(entity, MeshInstance{std::make_shared<const Mesh>(mesh)});
    const auto deformed = [&](std::vector<float> weights) {
        world.set(entity, MorphWeights{std::move(weights)});
        CHECK(deformer.update(world).empty());
        return world.get<DeformedMesh>(entity).vertices->at(0);
    };
    CHECK(deformed({}) == mesh.primitives[0].vertices);
    CHECK(deformed({0, 0}) == mesh.primitives[0].vertices);
    const std::vector<Vertex> both = deformed({0.5F, -0.25F});
    CHECK(both[0].position == glm::vec3(0.5F, 0, 0));
    CHECK(both[1].position == glm::vec3(1, 1, -1));
    CHECK(both[2].position == glm::vec3(0, 1, -1));
    CHECK(glm::distance(both[0].normal, glm::normalize(glm::vec3(0.5F, 0, 1))) <= 2.0F * epsilon);
    CHECK(both[1].normal == glm::vec3(0, 0, 1));
    CHECK(deformed({1, 0, 9, 9})[1].position == glm::vec3(1, 2, 0));  // what has no target does nothing

    // A joint moves what the targets have shaped.
    Mesh skinned = mesh;
    skinned.primitives[0].influences = {all_of_joint(3, 0)};
    Posed posed(skinned, 1);
    posed.world.set(
        posed.joints[0],
        Transform{.translation = {0, 0, 1}, .rotation = turn(90.0F, {0, 0, 1}), .scale = glm::vec3(1)});
    posed.world.set(posed.figure, MorphWeights{{1, 0}});
    CHECK(glm::distance(posed.vertices()[1].position, {-2, 1, 1}) <= 8.0F * epsilon);
}

TEST_CASE("meshes are deformed only when something about them has changed") {
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    mesh.primitives[0].influences = {all_of_joint(3, 0)};
    Posed posed(mesh, 1);
    World& world = posed.world;
    const Entity other = world.create();
    posed.vertices();
    const auto tick = [&] {
        posed.vertices();
        return world.changed<DeformedMesh>(posed.figure);
    };
    Tick last = tick();
    CHECK(tick() == last);
    world.set(other, Transform{{1, 2, 3}});  // of no joint
    CHECK(tick() == last);
    const auto changes = [&](const std::function<void()>& change) {
        change();
        const Tick now = tick();
        const bool has_changed = now != last;
        last = now;
        return has_changed;
    };
    CHECK(changes([&] { world.set(posed.joints[0], Transform{{1, 0, 0}}); }));
    CHECK_FALSE(changes([&] { world.set(posed.joints[0], Transform{{1, 0, 0}}); }));
    CHECK_FALSE(changes([&] { world.set(posed.figure, MorphWeights{{1}}); }));  // the mesh has no targets
    CHECK(changes([&] { world.set(posed.figure, MeshInstance{std::make_shared<const Mesh>(mesh)}); }));
    CHECK(changes([&] { world.remove<DeformedMesh>(posed.figure); }));
    World copy = world;  // for example one to undo to
    world.set(posed.joints[0], Transform{{2, 0, 0}});
    CHECK(posed.vertices()[0].position == glm::vec3(2, 0, 0));
    world = copy;
    CHECK(posed.vertices()[0].position == glm::vec3(1, 0, 0));

    world.remove<Skin>(posed.figure);
    world.remove<MorphWeights>(posed.figure);
    CHECK(posed.deformer.update(world).empty());
    CHECK_FALSE(world.has<DeformedMesh>(posed.figure));
}

TEST_CASE(
    "vertices that somebody holds never change, and released ones are "
    "not taken for old ones") {
    Mesh mesh = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    mesh.primitives[0].influences = {all_of_joint(3, 0)};
    Posed posed(mesh, 1);
    std::vector<std::shared_ptr<const DeformedMesh::Vertices>> held;
    std::weak_ptr<const DeformedMesh::Vertices> released;
    for (int i = 0; i < 12; ++i) {
        const auto x = static_cast<float>(i);
        posed.world.set(posed.joints[0], Transform{{x, 0, 0}});
        posed.vertices();
        CHECK(released.expired());
        if (i % 3 == 0)
            held.push_back(posed.world.get<DeformedMesh>(posed.figure).vertices);
        else
            released = posed.world.get<DeformedMesh>(posed.figure).vertices;
        if (i % 3 == 0) released.reset();
    }
    for (std::size_t i = 0; i < held.size(); ++i) {
        CHECK((*held[i])[0][0].position.x == static_cast<float>(3 * i));
    }
}

TEST_CASE("faults of figures are told, and others are still deformed") {
    Mesh good = mesh_of({vertex_at({0, 0, 0}), vertex_at({1, 0, 0}), vertex_at({0, 1, 0})}, {0, 1, 2});
    good.primitives[0].influences = {all_of_joint(3, 1)};
    using Change = std::function<void(Posed&, Mesh&, Skin&)>;
    const auto fault_of = [&](const Change& change) {
        Posed posed(good, 2);
        World& world = posed.world;
        world.set(posed.figure, Name{"figure"});
        Mesh mesh = good;
        Skin skin = world.get<Skin>(posed.figure);
        const Entity whole = world.create();
        world.set(whole, skin);
        world.set(whole, MeshInstance{std::make_shared<const Mesh>(good)});
        skin.joints.push_back(world.create());
        change(posed, mesh, skin);
        world.set(posed.figure, skin);
        world.set(posed.figure, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
        const AnimationFaults faults = posed.deformer.update(world);
        CHECK(posed.deformer.update(world) == faults);
        CHECK(world.has<DeformedMesh>(whole));
        CHECK_FALSE(world.has<DeformedMesh>(posed.figure));
        return faults.empty() ? "no fault" : faults[0];
    };
    const std::string whose = "entity \"figure\": ";
    CHECK(fault_of([](Posed& posed, Mesh&, Skin& skin) {
              skin.joints[1] = posed.world.create();
              posed.world.destroy(skin.joints[1]);
          }) == whose + "joint 1 of its skin no longer exists");
    CHECK(fault_of([](Posed&, Mesh&, Skin& skin) { skin.joints.resize(1); }) ==
          whose + "its mesh needs 2 joints, but its skin has 1");
    CHECK(fault_of([](Posed&, Mesh&, Skin& skin) {
              skin.inverse_bind_matrices = std::make_shared<const std::vector<glm::mat4>>(2);
          }) == whose + "its skin has 3 joints, but 2 inverse bind matrices");
    CHECK(fault_of([](Posed& posed, Mesh&, Skin&) {
              posed.world.set(posed.figure, Transform{.scale = {1, 0, 1}});
          }) == whose + "its world matrix, in whose space it is deformed, has no inverse");
    CHECK(fault_of([](Posed&, Mesh& mesh, Skin&) { mesh.primitives[0].influences[0].resize(2); }) ==
          whose + "primitive 0 of its mesh: 2 influences for 3 vertices");
    CHECK(fault_of([](Posed&, Mesh& mesh, Skin&) {
              mesh.primitives[0].influences[0][2].weights.y = -0.5F;
          }) == whose +
                    "primitive 0 of its mesh: vertex 2: a weight is "
                    "negative or not finite");
    CHECK(fault_of([](Posed&, Mesh& mesh, Skin&) {
              mesh.primitives[0].targets = {{{glm::vec3(0)}, {}, {}}};
          }) == whose +
                    "primitive 0 of its mesh: morph target 0 does not have "
                    "as many offsets as vertices");
    CHECK(fault_of([](Posed& posed, Mesh& mesh, Skin&) {
              mesh.primitives[0].targets = {{}};
              posed.world.set(posed.figure, MorphWeights{{1.0F, NAN}});
          }) == whose + "weight 1 of its morph targets is not finite");
    CHECK(fault_of([](Posed& posed, Mesh&, Skin& skin) {
              posed.world.set(skin.joints[2], Name{"hip"});
              posed.world.set(skin.joints[2], Transform{.parent = skin.joints[2]});
              skin.joints[1] = skin.joints[2];
          }) == whose + "entity \"hip\": its parents form a cycle");
}

TEST_CASE("vertices that are split for tangents keep their joints and offsets") {
    // Two triangles whose texture is mirrored between them: the shared vertices
    // are split.
    Mesh mesh =
        mesh_of({vertex_at({0, 0, 0}), vertex_at({0, 1, 0}), vertex_at({1, 0, 0}), vertex_at({-1, 0, 0})},
                {0, 2, 1, 0, 1, 3});
    Primitive& primitive = mesh.primitives[0];
    primitive.vertices[1].uv = {0, 1};
    primitive.vertices[2].uv = {1, 0};
    primitive.vertices[3].uv = {1, 0};
    primitive.influences = {all_of_joint(4, 0)};
    primitive.targets = {{{}, {}, {}}};
    for (std::uint16_t i = 0; i < 4; ++i) {
        primitive.influences[0][i].joints[0] = i;
        primitive.targets[0].positions.emplace_back(primitive.vertices[i].position);
    }
    derive_tangents(primitive);
    REQUIRE(primitive.vertices.size() == 6);
    REQUIRE(primitive.influences[0].size() == 6);
    REQUIRE(primitive.targets[0].positions.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(primitive.targets[0].positions[i] == primitive.vertices[i].position);
        CHECK(primitive.influences[0][i] ==
              primitive.influences[0][i < 4 ? i : (primitive.vertices[i].position.y == 1.0F ? 1U : 0U)]);
    }
}

}  // TEST_SUITE("deformation")
