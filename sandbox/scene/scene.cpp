#include "sandbox/scene/scene.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/gltf.hpp>
#include <candela/scene/gltf_export.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/candela_private.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

std::string list_cameras(const World& world, const std::vector<Entity>& all) {
    std::vector<std::string> names;
    names.reserve(all.size());
    for (const Entity camera : all) {
        names.push_back(fmt::format("{} '{}'", names.size(), name_of(world, camera)));
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Entity find_camera(const World& world, const std::vector<Entity>& all, const std::string& wanted) {
    const auto is_wanted = [&](Entity camera) { return name_of(world, camera) == wanted; };
    const auto named = std::find_if(all.begin(), all.end(), is_wanted);
    if (named != all.end()) return *named;
    const std::optional<std::size_t> index = parse_index(wanted);
    if (index && *index < all.size()) return all[*index];
    throw SceneError(fmt::format("no camera '{}'; the scene has {}", wanted, list_cameras(world, all)));
}

/// Looks from above and slightly to the right, just far enough back to see the whole scene.
Entity add_framing_camera(World& world, float aspect) {
    const glm::vec3 away = glm::normalize(glm::vec3(0.4F, 0.3F, 1.0F));
    const Bounds scene = bounds(world);
    const float radius = scene.radius > 0.0F ? scene.radius : 1.0F;
    Camera camera;
    const float half_height = std::tan(camera.vertical_fov * 0.5F);
    const float half_angle = std::atan(half_height * std::min(aspect, 1.0F));
    camera.near_plane = radius * 1e-3F;

    const Entity entity = world.create();
    world.set(entity, Name{"whole scene"});
    world.set(entity, Transform{.translation = scene.centre + away * (radius / std::sin(half_angle)),
                                .rotation = glm::quatLookAt(-away, glm::vec3(0.0F, 1.0F, 0.0F))});
    world.set(entity, camera);
    return entity;
}

bool has_area(const Primitive& primitive) {
    const auto corner = [&](std::size_t index) {
        return primitive.vertices[primitive.indices[index]].position;
    };
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        const glm::vec3 a = corner(i);
        if (glm::cross(corner(i + 1) - a, corner(i + 2) - a) != glm::vec3(0.0F)) return true;
    }
    return false;
}

}  // namespace

std::string why_nothing_is_seen(const Scene& scene) {
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        if (std::ranges::any_of(instance.mesh->primitives, has_area)) return "";
    }
    return fmt::format("{}: there is nothing to see: it has no triangle with an area", scene.path.string());
}

std::optional<std::size_t> parse_index(const std::string& text) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole ? std::optional(index) : std::nullopt;
}

bool is_shipped(const std::string& folder, const fs::path& file) {
    std::error_code ignored;
    return fs::equivalent(file, shipped_file(folder, file.filename().string()), ignored);
}

std::vector<fs::path> shipped_scenes() {
    std::vector<fs::path> scenes;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(shipped_file("scenes", ""), ignored)) {
        if (entry.path().extension() == ".gltf") scenes.push_back(entry.path());
    }
    std::ranges::sort(scenes);
    return scenes;
}

ImportOptions unconfined() {
    return {.limits = {}, .root = "/", .progress = {}};
}

Scene load_scene(const fs::path& path, const ImportOptions& options) {
    Scene scene{path, {}, {}, {}};
    scene.warnings = import_gltf(path, scene.world, options).warnings;
    if (std::string fault = why_nothing_is_seen(scene); !fault.empty()) {
        scene.warnings.insert(scene.warnings.begin(), std::move(fault));
    }
    return scene;
}

std::vector<std::string> save_scene(const World& world, const fs::path& path,
                                    std::span<const Entity> of_app) {
    return export_gltf(world, path, of_app);
}

std::optional<std::string> animation_of(const Scene& scene) {
    return scene.animation ? std::optional(scene.animation->script().path.string()) : std::nullopt;
}

Box box_of(const World& world, const std::vector<Entity>& entities) {
    Box box;
    WorldMatrices world_matrices(world);
    for (const Entity entity : entities) {
        const auto* instance = world.find<MeshInstance>(entity);
        if (instance == nullptr) continue;
        const glm::mat4 to_world = world_matrices(entity);
        const auto* deformed = world.find<DeformedMesh>(entity);
        for (std::size_t i = 0; i < instance->mesh->primitives.size(); ++i) {
            const Primitive& primitive = instance->mesh->primitives[i];
            for (const Vertex& vertex : deformed ? (*deformed->vertices)[i] : primitive.vertices) {
                box.grow(glm::vec3(to_world * glm::vec4(vertex.position, 1.0F)));
            }
        }
    }
    return box;
}

Bounds bounds(const World& world) {
    std::vector<Entity> all;
    for (auto [entity, instance] : world.view<MeshInstance>()) all.push_back(entity);
    const Box box = box_of(world, all);
    if (box.lower.x > box.upper.x) return {};
    return {(box.lower + box.upper) * 0.5F, glm::length(box.upper - box.lower) * 0.5F};
}

std::vector<Entity> cameras(const World& world) {
    std::vector<Entity> all;
    for (auto [entity, camera] : world.view<Camera>()) all.push_back(entity);
    std::sort(all.begin(), all.end());
    return all;
}

Entity choose_camera(World& world, const std::optional<std::string>& wanted, float aspect) {
    const std::vector<Entity> all = cameras(world);
    if (wanted) return find_camera(world, all, *wanted);
    return all.empty() ? add_framing_camera(world, aspect) : all.front();
}

std::string name_of(const World& world, Entity entity) {
    const auto* name = world.find<Name>(entity);
    return name != nullptr && !name->value.empty() ? name->value : fmt::format("entity {}", entity.index);
}

}  // namespace candela::sandbox
