#include "sandbox/scene/studio.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/color_space.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/editing/history.hpp"
#include "sandbox/editing/scene_rays.hpp"
#include "sandbox/scene/environment.hpp"

namespace candela::sandbox {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

float mean_of(const Image& image) {
    double sum = 0.0;
    for (const glm::u8vec4 texel : image.texels) {
        const glm::vec3 linear = glm::convertSRGBToLinear(glm::vec3(texel) / 255.0F);
        sum += static_cast<double>(std::max({linear.r, linear.g, linear.b}));
    }
    return image.texels.empty() ? 0.0F : static_cast<float>(sum / static_cast<double>(image.texels.size()));
}

/// Of the strongest channel.
float mean_emission(const Material& material) {
    const glm::vec3 factor = material.emissive;
    const float strongest = std::max({factor.r, factor.g, factor.b});
    if (strongest == 0.0F || !material.emissive_texture) return strongest;
    return strongest * mean_of(*material.emissive_texture);
}

/// World space, metres; the front is counter-clockwise.
struct EmittingTriangle {
    glm::vec3 a;
    glm::vec3 ab;
    glm::vec3 ac;
    bool double_sided;
};

/// The surfaces of a world that emit light.
struct Emission {
    std::vector<EmittingTriangle> triangles;
    std::vector<double> flux;        ///< of each, lm
    std::vector<LitObject> objects;  ///< all of the world, not lit yet
};

/// Of the last of the objects.
void add_primitive(const Primitive& primitive, const glm::mat4& to_world, Emission& emission) {
    const float radiance = mean_emission(*primitive.material);
    const auto place = [&](std::uint32_t vertex) {
        return glm::vec3(to_world * glm::vec4(primitive.vertices[vertex].position, 1.0F));
    };
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        const glm::vec3 a = place(primitive.indices[i]);
        const glm::vec3 ab = place(primitive.indices[i + 1]) - a, ac = place(primitive.indices[i + 2]) - a;
        const double area = 0.5 * static_cast<double>(glm::length(glm::cross(ab, ac)));
        emission.objects.back().area += area;
        if (radiance == 0.0F || area == 0.0) continue;
        const double sides = primitive.material->double_sided ? 2.0 : 1.0;
        emission.triangles.push_back({a, ab, ac, primitive.material->double_sided});
        emission.flux.push_back(sides * static_cast<double>(radiance * pi) * area);
    }
}

Emission emission_of(const World& world) {
    Emission emission;
    WorldMatrices matrices(world);
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        emission.objects.push_back({.entity = entity});
        for (const Primitive& primitive : instance.mesh->primitives) {
            add_primitive(primitive, matrices(entity), emission);
        }
    }
    return emission;
}

/// Draws rays of the light that triangles emit.
class EmittedRays {
 public:
    explicit EmittedRays(const Emission& emission)
        : emission_(&emission), triangle_(emission.flux.begin(), emission.flux.end()) {}

    Ray operator()() {
        const EmittingTriangle& triangle = emission_->triangles[triangle_(random_)];
        const float root = std::sqrt(unit_(random_));
        const float along = unit_(random_);
        const glm::vec3 point = triangle.a + root * (1.0F - along) * triangle.ab + root * along * triangle.ac;
        glm::vec3 normal = glm::normalize(glm::cross(triangle.ab, triangle.ac));
        if (triangle.double_sided && unit_(random_) < 0.5F) normal = -normal;
        // Directions by the cosine: a point on the unit sphere that touches the surface.
        const float z = 2.0F * unit_(random_) - 1.0F;
        const float angle = 2.0F * pi * unit_(random_);
        const float radius = std::sqrt(1.0F - z * z);
        const glm::vec3 on_sphere(radius * std::cos(angle), radius * std::sin(angle), z);
        const glm::vec3 direction = normal + 0.999F * on_sphere;
        const float size = glm::length(triangle.ab) + glm::length(triangle.ac);
        return {point + 1e-4F * size * normal, glm::normalize(direction)};
    }

 private:
    const Emission* emission_;
    std::mt19937 random_{1};  // the same sequence everywhere
    std::discrete_distribution<std::size_t> triangle_;
    std::uniform_real_distribution<float> unit_{0.0F, 1.0F};
};

bool has_lights(const World& world) {
    std::size_t lights = world.count<Environment>();
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) { lights += world.count<Light>(); });
    return lights > 0;
}

/// Brighter than its surroundings above, darker below; at the horizon much darker than what it lights, so
/// that white things are seen before it.
std::shared_ptr<const SkyPicture> studio_picture() {
    constexpr std::uint32_t height = 32, width = 2 * height;
    constexpr float top = 1.0F, horizon = 0.25F, bottom = 0.08F;
    SkyPicture picture{width, height, {}};
    for (std::uint32_t row = 0; row < height; ++row) {
        const float up = std::cos(pi * (static_cast<float>(row) + 0.5F) / static_cast<float>(height));
        const float radiance =
            up > 0.0F ? horizon + (top - horizon) * up * up : horizon + (horizon - bottom) * up;
        picture.texels.insert(picture.texels.end(), width, glm::vec3(radiance));
    }
    return std::make_shared<const SkyPicture>(std::move(picture));
}

/// Of a camera's view; horizontal, unit.
glm::vec3 forward_of(const World& world) {
    const std::vector<Entity> all = cameras(world);
    if (all.empty()) return {0.0F, 0.0F, -1.0F};
    const glm::vec3 looks(-world_matrix(world, all.front())[2]);
    const glm::vec3 level(looks.x, 0.0F, looks.z);
    return glm::length(level) > 1e-3F * glm::length(looks) ? glm::normalize(level) : glm::vec3(0, 0, -1);
}

}  // namespace

std::vector<LitObject> light_by_emission(const World& world) {
    Emission emission = emission_of(world);
    if (emission.triangles.empty()) return {};
    SceneRays surfaces;
    surfaces.update_and_wait(world);
    EmittedRays rays(emission);
    constexpr int count = 1024;
    std::map<Entity, int> met;
    for (int i = 0; i < count; ++i) {
        if (const auto hit = surfaces.first_hit(rays())) ++met[hit->entity];
    }
    const double flux = std::reduce(emission.flux.begin(), emission.flux.end()) / count;  // of a ray
    for (LitObject& object : emission.objects) {
        const double irradiance = object.area > 0.0 ? flux * met[object.entity] / object.area : 0.0;
        object.radiance = irradiance / std::numbers::pi;
    }
    return std::move(emission.objects);
}

bool is_lit(const World& world) {
    if (has_lights(world)) return true;
    // A helmet with a glowing visor has 0.001, objects in rooms with lamps mostly 0.1 and more.
    constexpr double least = 0.02;
    // A bulb around a filament is lit well, and hides it from all else.
    constexpr double least_share = 1.0 / 3.0;
    double area = 0.0;
    double lit = 0.0;
    for (const LitObject& object : light_by_emission(world)) {
        area += object.area;
        if (object.radiance > least) lit += object.area;
    }
    return area > 0.0 && lit >= least_share * area;
}

std::vector<Entity> touched_by_studio(Scene& scene) {
    if (scene.studio.empty()) scene.studio = {scene.world.create(), scene.world.create()};
    std::vector<Entity> touched = scene.studio;
    const Entity sky = environment_entity(scene.world);
    if (sky != Entity{} && sky != scene.studio.front()) touched.push_back(sky);
    return touched;
}

void add_studio(Scene& scene) {
    World& world = scene.world;
    const std::vector<Entity> touched = touched_by_studio(scene);
    for (const Entity entity : touched) {
        if (world.has<Environment>(entity)) world.remove<Environment>(entity);
    }
    const Entity sky = scene.studio[0], key = scene.studio[1];
    world.set(sky, Name{"studio sky"});
    world.set(sky, Environment{.radiance = glm::vec3(1.0F), .picture = studio_picture()});
    const glm::vec3 forward = forward_of(world);
    const glm::vec3 right = glm::cross(forward, glm::vec3(0, 1, 0));
    const glm::vec3 shines = glm::normalize(forward + 0.6F * right - glm::vec3(0, 1.2F, 0));
    world.set(key, Name{"studio light"});
    world.set(key, Transform{.rotation = glm::quatLookAt(shines, glm::vec3(0, 1, 0))});
    world.set(key, DirectionalLight{.illuminance = 2.0F});
}

void remove_studio(Scene& scene) {
    for (const Entity entity : scene.studio) set_state(scene.world, entity, {});
}

bool has_studio(const Scene& scene) {
    return !scene.studio.empty() && scene.world.has<DirectionalLight>(scene.studio.back());
}

void light_if_dark(Scene& scene) {
    if (is_lit(scene.world)) return;
    add_studio(scene);
    scene.warnings.emplace_back(
        "the scene has no light that lights it: a studio does, a soft sky and a light");
}

}  // namespace candela::sandbox
