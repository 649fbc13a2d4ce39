// Figures that an animation moves: with a skeleton, and with morph targets.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <candela/scene/animate.hpp>
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("animated figures") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{40, 30};
constexpr std::uint16_t joint_count = 3;
constexpr float segment = 0.3F;    // length of a part of the arm, metres
constexpr float thickness = 0.1F;  // half of it

/// How the joints pull the vertices of an arm.
enum class Bending : std::uint8_t {
    rigid,  ///< each part follows one joint
    soft    ///< where two parts meet, the vertices follow both
};

/// Of the lower end of a part, or of its upper end.
Influences influences_of(std::uint16_t part, bool is_upper, Bending bending) {
    const int beside = part + (is_upper ? 1 : -1);
    if (bending == Bending::rigid || beside < 0 || beside >= joint_count) {
        return {glm::u16vec4(part, 0, 0, 0), glm::vec4(1, 0, 0, 0)};
    }
    return {glm::u16vec4(part, beside, 0, 0), glm::vec4(0.5F, 0.5F, 0, 0)};
}

/// A box from y = 0 to y = `segment`.
Primitive part_of_arm(const std::shared_ptr<const Material>& material) {
    Primitive box = box_inwards(1.0F, material)->primitives.front();
    for (Vertex& vertex : box.vertices) {
        vertex.position = glm::vec3(thickness, 0.5F * segment, thickness) * vertex.position;
        vertex.position.y += 0.5F * segment;
        vertex.normal = -vertex.normal;
    }
    for (std::size_t i = 0; i < box.indices.size(); i += 3) std::swap(box.indices[i], box.indices[i + 1]);
    return box;
}

/// A part for each joint, one above the other.
std::shared_ptr<const Mesh> arm(const std::shared_ptr<const Material>& material, Bending bending) {
    Mesh mesh;
    for (std::uint16_t part = 0; part < joint_count; ++part) {
        Primitive box = part_of_arm(material);
        box.influences.emplace_back();
        for (Vertex& vertex : box.vertices) {
            const bool is_upper = vertex.position.y > 0.5F * segment;
            vertex.position.y += static_cast<float>(part) * segment;
            box.influences.front().push_back(influences_of(part, is_upper, bending));
        }
        mesh.primitives.push_back(std::move(box));
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// A square of 0.6 m that faces +Y, with two targets: a wave along x and one along z.
std::shared_ptr<const Mesh> cloth(const std::shared_ptr<const Material>& material) {
    constexpr std::uint32_t side = 6;
    constexpr float half = 0.3F, height = 0.1F, frequency = 10.0F;
    Primitive primitive{.vertices = {}, .indices = {}, .material = material};
    MorphTarget along_x, along_z;
    for (std::uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
        const glm::vec2 uv = glm::vec2(i % (side + 1), i / (side + 1)) / static_cast<float>(side);
        const glm::vec2 place = half * (2.0F * uv - 1.0F);
        primitive.vertices.push_back({{place.x, 0.0F, place.y}, {0, 1, 0}, uv});
        const glm::vec2 angle = frequency * place;
        const glm::vec2 lift = height * glm::sin(angle);
        const glm::vec2 slope = -height * frequency * glm::cos(angle);
        along_x.positions.emplace_back(0.0F, lift.x, 0.0F);
        along_x.normals.emplace_back(slope.x, 0.0F, 0.0F);
        along_z.positions.emplace_back(0.0F, lift.y, 0.0F);
        along_z.normals.emplace_back(0.0F, 0.0F, slope.y);
    }
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint32_t a = i + i / side;
        const std::uint32_t b = a + side + 1;
        for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) primitive.indices.push_back(corner);
    }
    primitive.targets = {along_x, along_z};
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    return std::make_shared<const Mesh>(std::move(mesh));
}

using Joints = std::array<Entity, joint_count>;

/// A joint for each part, each the child of the one below.
Joints add_joints(World& world, const Transform& root) {
    Joints joints{};
    joints[0] = add(world, root);
    for (std::size_t i = 1; i < joint_count; ++i) {
        joints[i] = add(world, Transform{.translation = {0, segment, 0}, .parent = joints[i - 1]});
    }
    return joints;
}

Entity add_arm(World& world, const Joints& joints, const std::shared_ptr<const Material>& material,
               Bending bending) {
    std::vector<glm::mat4> binds;
    for (std::size_t i = 0; i < joint_count; ++i) {
        const float height = segment * static_cast<float>(i);
        binds.push_back(glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, -height, 0.0F)));
    }
    // Its own place does not count.
    return add(world, at({0.1F, 0.2F, 0.3F}), MeshInstance{arm(material, bending)},
               Skin{{joints.begin(), joints.end()}, std::make_shared<const std::vector<glm::mat4>>(binds)});
}

std::shared_ptr<const std::vector<float>> shared(std::vector<float> numbers) {
    return std::make_shared<const std::vector<float>>(std::move(numbers));
}

/// From one value at 0 s to another at 1 s.
AnimationSampler from_to(std::vector<float> values, Interpolation interpolation = Interpolation::linear) {
    return {interpolation, shared({0.0F, 1.0F}), shared(std::move(values))};
}

/// From no turn to one around z, which bends an arm towards +X.
AnimationSampler bend(float radians) {
    const glm::quat end = glm::angleAxis(-radians, glm::vec3(0, 0, 1));
    return from_to({0, 0, 0, 1, end.x, end.y, end.z, end.w});
}

/// The Cornell box with an arm, which bends and moves, and a cloth, which waves.
struct Stage : Scene {
    explicit Stage(Interpolation of_weights = Interpolation::linear) : Scene(cornell_box()) {
        const Joints joints =
            add_joints(world, Transform{.translation = {-0.6F, 0.0F, 0.5F}, .scale = {1.0F, 0.9F, 1.1F}});
        add_arm(world, joints, diffuse({0.8F, 0.3F, 0.2F}), Bending::soft);
        const Entity sheet =
            add(world, at({0.3F, 1.0F, 0.4F}), MeshInstance{cloth(diffuse({0.2F, 0.5F, 0.8F}, true))},
                MorphWeights{{0.0F, 0.0F}});
        AnimationClip clip;
        clip.duration = 1.0F;
        clip.samplers = {from_to({-0.6F, 0, 0.5F, -0.4F, 0, 0.6F}), bend(1.2F), bend(0.8F),
                         from_to({0.2F, 0.0F, -0.5F, 1.0F}, of_weights)};
        clip.channels = {{0, AnimatedProperty::translation, 0},
                         {1, AnimatedProperty::rotation, 1},
                         {2, AnimatedProperty::rotation, 2},
                         {3, AnimatedProperty::morph_weights, 3}};
        AnimationPlayer playing;
        playing.animations = std::make_shared<const Animations>(
            Animations{.clips = {std::make_shared<const AnimationClip>(std::move(clip))},
                       .targets = {joints[0], joints[1], joints[2], sheet}});
        player = add(world, std::move(playing));
    }

    void advance(double seconds) {
        CHECK(advance_animations(world, seconds).empty());
        CHECK(deformer.update(world).empty());
    }

    Entity player;
    MeshDeformer deformer;
};

/// A grey room with an arm that stands on the floor, or is bent to an arch over the middle of the floor. A
/// lamp hangs above the middle.
struct ArchRoom : Scene {
    /// What the arm is.
    enum class Figure : std::uint8_t {
        skinned,
        boxes  ///< an entity for each part, which is its joint
    };

    explicit ArchRoom(const glm::vec3& albedo, Figure figure = Figure::skinned) {
        const std::shared_ptr<const Material> material = diffuse(albedo);
        add(world, Transform{}, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.6F)))});
        light = add(world, at({0.0F, 0.8F, 0.0F}), PointLight{});
        camera = add(world, looking({0.0F, -0.3F, 0.95F}, {0.0F, -1.0F, 0.0F}), Camera{.vertical_fov = 1.3F});
        joints = add_joints(world, Transform{.translation = {-0.6F, -1.0F, 0.0F}, .scale = glm::vec3(2.0F)});
        if (figure == Figure::skinned) {
            add_arm(world, joints, material, Bending::rigid);
        } else {
            for (const Entity joint : joints) {
                world.set(joint,
                          MeshInstance{std::make_shared<const Mesh>(Mesh{"part", {part_of_arm(material)}})});
            }
        }
        set_bend(0.0F);
    }

    void set_bend(float radians) {
        const glm::quat turn = glm::angleAxis(-radians, glm::vec3(0, 0, 1));
        world.edit<Transform>(joints[1], [&](Transform& joint) { joint.rotation = turn; });
        CHECK(deformer.update(world).empty());
    }

    Joints joints{};
    MeshDeformer deformer;
};

Configuration lit(VplPlacement placement, VplVisibility visibility = VplVisibility::rays) {
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = placement;
    configuration.visibility.method = visibility;
    return configuration;
}

class FigureTests : public RenderFixture {
 protected:
    [[nodiscard]] std::vector<std::string> passes_that_ran() const {
        std::vector<std::string> names;
        for (const PassRecord& pass : renderer.last_passes()) {
            if (pass.ran) names.emplace_back(pass.name);
        }
        return names;
    }
};

/// The middle of the floor of an ArchRoom.
constexpr glm::dvec3 middle(0.0, -1.0, 0.0);

/// The pixel that sees the point.
glm::uvec2 pixel_of(const Scene& scene, const glm::dvec3& point) {
    const auto& camera = scene.world.get<Camera>(scene.camera);
    const auto& pose = scene.world.get<Transform>(scene.camera);
    glm::uvec2 nearest(0);
    double least = 2.0;
    for (std::uint32_t y = 0; y < size.y; ++y) {
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const PixelRay ray = pixel_ray(camera, pose, size, x, y);
            const double off =
                glm::distance(glm::normalize(ray.direction), glm::normalize(point - ray.origin));
            if (off >= least) continue;
            least = off;
            nearest = {x, y};
        }
    }
    return nearest;
}

}  // namespace

TEST_CASE_FIXTURE(FigureTests, "each frame of a motion is that of a new renderer, bit for bit") {
    // Also with surfels: they stay on their triangles, and where they are on these follows from the mesh
    // as it is without any motion.
    Configuration as_shipped;
    as_shipped.vpls.count = 64;
    for (const Configuration& configuration :
         {lit(VplPlacement::paths), lit(VplPlacement::surfels), as_shipped}) {
        configure(configuration);
        Stage stage;
        stage.advance(0.0);
        Picture last = render(stage, size);
        CHECK(is_sane(last));
        for (int frame = 0; frame < 6; ++frame) {
            CAPTURE(frame);
            stage.advance(0.22);  // past the end once
            Picture now = render(stage, size);
            CHECK(now != last);
            CHECK(now == from_scratch(stage, size));
            last = std::move(now);
        }
        CHECK(last == fresh_picture(stage, size));
    }
}

TEST_CASE_FIXTURE(FigureTests, "lights and cameras are not uploaded again while a figure moves") {
    configure(lit(VplPlacement::surfels));
    Stage stage;
    stage.advance(0.0);
    static_cast<void>(render(stage, size));
    for (int frame = 0; frame < 3; ++frame) {
        stage.advance(0.2);
        static_cast<void>(render(stage, size));
        CHECK(ran("surfel-visibility"));
        CHECK_FALSE(ran("light-upload"));
        CHECK_FALSE(ran("view-upload"));
    }
}

TEST_CASE_FIXTURE(FigureTests, "while no figure moves, nothing but the copy to the target runs") {
    Configuration configuration = lit(VplPlacement::surfels, VplVisibility::maps);
    configuration.refinement.enabled = false;
    configure(configuration);
    const std::vector<std::string> only_copy{"tone-map"};
    Stage stage;
    stage.advance(0.3);
    const Picture picture = render(stage, size);
    const auto stands = [&] {
        CHECK(render(stage, size) == picture);
        CHECK(passes_that_ran() == only_copy);
    };
    stage.world.edit<AnimationPlayer>(stage.player, [](auto& player) { player.playing = false; });
    stage.advance(0.3);
    stands();
    stage.world.edit<AnimationPlayer>(stage.player, [](auto& player) {
        player.playing = true;
        player.speed = 0.0;
    });
    stage.advance(0.3);
    stands();
    // A whole round. Its time has no rounding: 0.25 + 1 - 1.
    stage.world.edit<AnimationPlayer>(stage.player, [](auto& player) {
        player.speed = 1.0;
        player.time = 0.25;
    });
    stage.advance(0.0);
    const Picture quarter = render(stage, size);
    CHECK(quarter != picture);
    stage.advance(1.0);
    CHECK(render(stage, size) == quarter);
    CHECK(passes_that_ran() == only_copy);
}

TEST_CASE_FIXTURE(FigureTests, "an arm of stiff parts looks like boxes that stand on its joints") {
    // Lit, with its shadow, and with the light that it blocks and reflects.
    configure(lit(VplPlacement::paths));
    ArchRoom skinned({0.8F, 0.4F, 0.2F});
    ArchRoom boxes({0.8F, 0.4F, 0.2F}, ArchRoom::Figure::boxes);
    for (const float radians : {0.0F, 0.7F, 1.4F}) {
        CAPTURE(radians);
        skinned.set_bend(radians);
        boxes.set_bend(radians);
        // Rounding of positions, about 1e-7, moves the outlines of shadows: few pixels differ.
        const Picture a = render(skinned, size);
        const Picture b = render(boxes, size);
        CHECK(mean(b) > 0.0);
        std::size_t different = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) {
            different += glm::length(a.pixels[i] - b.pixels[i]) > 1e-3F * glm::length(b.pixels[i]) ? 1 : 0;
        }
        CHECK(different * 50 < a.pixels.size());
    }
}

TEST_CASE_FIXTURE(FigureTests, "a figure casts its shadow where it is") {
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    ArchRoom room(glm::vec3(0.5F));
    const glm::uvec2 pixel = pixel_of(room, middle);
    // Radiance of a Lambertian floor of albedo 0.6, 1.8 m under a light of 1 cd: 0.6/π · 1/1.8². A
    // pixel away from the point, 0.1 m, the light is weaker by (1 + (0.1 / 1.8)²)^-2, less than 1 %.
    const double wanted = 0.6 / glm::pi<double>() / (1.8 * 1.8);
    const auto floor_at = [&](float radians) {
        room.set_bend(radians);
        return render(room, size).at(pixel.x, pixel.y).g;
    };
    CHECK(std::abs(static_cast<double>(floor_at(0.0F)) / wanted - 1.0) < 0.01);
    CHECK(floor_at(glm::half_pi<float>()) == 0.0F);
    CHECK(std::abs(static_cast<double>(floor_at(0.15F)) / wanted - 1.0) < 0.01);
}

TEST_CASE_FIXTURE(FigureTests, "a figure blocks and reflects indirect light where it is") {
    for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
        Configuration configuration = lit(placement);
        configuration.vpls.count = 512;
        configuration.show = Show::indirect;
        configure(configuration);
        const auto floor_under = [&](const glm::vec3& albedo, float radians) {
            ArchRoom room(albedo);
            room.set_bend(radians);
            const glm::uvec2 pixel = pixel_of(room, middle);
            return render(room, size).at(pixel.x, pixel.y);
        };
        constexpr auto arch = glm::half_pi<float>();
        const glm::vec3 beside_black = floor_under(glm::vec3(0.0F), 0.0F);
        const glm::vec3 under_black = floor_under(glm::vec3(0.0F), arch);
        const glm::vec3 under_red = floor_under({0.9F, 0.0F, 0.0F}, arch);
        // An arch of 1.2 m by 0.4 m, 0.4 m above the point, hides 41 % of the cosine-weighted
        // hemisphere, and its shadow darkens the room. If that part was only a fourth as bright as the
        // rest, a seventh would be missing.
        CHECK(under_black.g < 0.9F * beside_black.g);
        // Of the light that the floor and the walls send to its underside, 0.9 come back.
        CHECK(under_red.r > 1.1F * under_black.r);
        // It reflects no green: green light has the same ways as with a black arch. Surfels store light
        // with 11 bits. Paths are others when some go on where they ended.
        if (placement == VplPlacement::surfels) {
            CHECK(std::abs(under_red.g - under_black.g) < 1e-3F * under_black.g);
        }
    }
}

}  // TEST_SUITE("animated figures")
