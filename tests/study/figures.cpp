#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <candela/scene/animate.hpp>
#include <candela/scene/components.hpp>
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"

namespace candela::study {
namespace {

constexpr std::uint32_t limbs = 6;
constexpr std::uint32_t joints_of_limb = 10;
constexpr std::uint32_t joints = limbs * joints_of_limb;
constexpr std::uint32_t rings = 50;  // of the mesh, which has 2 · rings · rings triangles
constexpr std::size_t keys = 30;     // one second of motion
constexpr double frame_seconds = 1.0 / 60.0;

/// A tube along y, whose vertices follow four joints each: of the limb of their column those two that are
/// next to their row, and the same two of the next limb.
Primitive tube() {
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::make_shared<const Material>()};
    std::vector<Influences>& influences = primitive.influences.emplace_back();
    for (std::uint32_t i = 0; i <= rings; ++i) {
        for (std::uint32_t j = 0; j <= rings; ++j) {
            const glm::vec2 uv = glm::vec2(j, i) / static_cast<float>(rings);
            const float around = 6.2831853F * uv.x;
            const glm::vec3 normal(std::sin(around), 0.0F, std::cos(around));
            primitive.vertices.push_back({0.2F * normal + glm::vec3(0.0F, uv.y, 0.0F), normal, uv});
            const std::uint32_t limb = j * limbs / (rings + 1);
            const std::uint32_t first = limb * joints_of_limb + i * (joints_of_limb - 1) / (rings + 1);
            const std::uint32_t beside = (first + joints_of_limb) % joints;
            influences.push_back(
                {glm::u16vec4(first, first + 1, beside, beside + 1), {0.4F, 0.3F, 0.2F, 0.1F}});
            if (i == rings || j == rings) continue;
            const std::uint32_t a = i * (rings + 1) + j, b = a + rings + 1;
            primitive.indices.insert(primitive.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    return primitive;
}

/// Turns each joint to and fro, once a second, by an angle of its own.
std::shared_ptr<const AnimationClip> sway(std::uint32_t seed) {
    AnimationClip clip;
    clip.name = "sway";
    clip.duration = 1.0F;
    std::vector<float> times;
    for (std::size_t key = 0; key < keys; ++key) {
        times.push_back(static_cast<float>(key) / static_cast<float>(keys - 1));
    }
    const auto shared_times = std::make_shared<const std::vector<float>>(std::move(times));
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        std::vector<float> values;
        for (const float time : *shared_times) {
            const float phase = static_cast<float>(seed + joint);
            const float half_angle = 0.05F * std::sin(6.2831853F * time + phase);
            values.insert(values.end(), {std::sin(half_angle), 0.0F, 0.0F, std::cos(half_angle)});
        }
        clip.samplers.push_back({.interpolation = candela::Interpolation::linear,
                                 .times = shared_times,
                                 .values = std::make_shared<const std::vector<float>>(std::move(values))});
        clip.channels.push_back({.target = joint, .property = AnimatedProperty::rotation, .sampler = joint});
    }
    return std::make_shared<const AnimationClip>(std::move(clip));
}

/// A chain of joints for each limb, 0.1 m from one to the next.
std::vector<Entity> add_skeleton(World& world, Entity figure) {
    std::vector<Entity> all;
    for (std::uint32_t i = 0; i < joints; ++i) {
        const bool is_first = i % joints_of_limb == 0;
        const Entity joint = world.create();
        world.set(joint, Transform{.translation = {0.0F, is_first ? 0.0F : 0.1F, 0.0F},
                                   .parent = is_first ? figure : all.back()});
        all.push_back(joint);
    }
    return all;
}

/// From the mesh's space to that of each joint: joints start on the axis, 0.1 m apart.
std::shared_ptr<const std::vector<glm::mat4>> inverse_bind_matrices() {
    std::vector<glm::mat4> matrices(joints, glm::mat4(1.0F));
    for (std::uint32_t i = 0; i < joints; ++i) {
        matrices[i][3].y = -0.1F * static_cast<float>(i % joints_of_limb);
    }
    return std::make_shared<const std::vector<glm::mat4>>(std::move(matrices));
}

void add_figures(World& world, const FigureStudy& study) {
    const auto mesh = std::make_shared<const Mesh>(Mesh{"tube", {tube()}});
    const auto matrices = inverse_bind_matrices();
    const std::shared_ptr<const AnimationClip> shared = sway(0);
    for (std::uint32_t i = 0; i < study.figures; ++i) {
        const Entity figure = world.create();
        world.set(figure, Transform{.translation = {static_cast<float>(i), 0.0F, 0.0F}});
        world.set(figure, MeshInstance{mesh});
        const std::vector<Entity> skeleton = add_skeleton(world, figure);
        world.set(figure, Skin{skeleton, matrices});
        AnimationPlayer player;
        player.animations =
            std::make_shared<const Animations>(Animations{{study.own_clips ? sway(i) : shared}, skeleton});
        player.time = 0.01 * i;
        world.set(figure, player);
    }
}

}  // namespace

int figures(const FigureStudy& study) {
    using Clock = std::chrono::steady_clock;
    const auto milliseconds = [](Clock::duration d) {
        return std::chrono::duration<double, std::milli>(d).count();
    };
    World world;
    add_figures(world, study);
    MeshDeformer deformer;
    std::vector<double> advancing, deforming, frames;
    for (int round = 0; round <= study.rounds; ++round) {
        const Clock::time_point start = Clock::now();
        const AnimationFaults unplayed = advance_animations(world, frame_seconds);
        const Clock::time_point advanced = Clock::now();
        const AnimationFaults shapeless = deformer.update(world);
        const Clock::time_point deformed = Clock::now();
        if (!unplayed.empty() || !shapeless.empty()) {
            fmt::print(stderr, "candela-study: figures: {}\n", unplayed.empty() ? shapeless[0] : unplayed[0]);
            return 2;
        }
        if (round == 0) continue;  // this one allocates
        advancing.push_back(milliseconds(advanced - start));
        deforming.push_back(milliseconds(deformed - advanced));
        frames.push_back(milliseconds(deformed - start));
    }
    fmt::print(
        "{} figures of {} triangles and {} joints, {}: {:.2f} ms a frame ({:.2f} for animations, "
        "{:.2f} for meshes), medians of {}; the shortest {:.2f}\n",
        study.figures, 2 * rings * rings, joints, study.own_clips ? "a clip each" : "one clip",
        median(frames), median(advancing), median(deforming), study.rounds,
        *std::min_element(frames.begin(), frames.end()));
    return 0;
}

}  // namespace candela::study
