#include <candela/scene/gltf_export.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/animation.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/import/export_draft.hpp"
#include "engine/import/export_meshes.hpp"
#include "engine/import/export_motion.hpp"
#include "engine/import/exr.hpp"
#include "engine/import/file_names.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/gltf_lights.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/output_files.hpp"
#include "engine/import/sky_picture_size.hpp"
#include "engine/import/unit_length.hpp"
#include "engine/scene/check.hpp"

namespace candela {

namespace {

using gltf::check;
using gltf::Draft;
using gltf::Json;
using gltf::to_json;

/// The entities that become nodes, sorted, so that the index of an entity is that of its node.
using Nodes = std::vector<Entity>;

template <class... Components>
void collect(const World& world, std::set<Entity>& entities) {
    const auto add = [&](const auto& view) {
        for (const auto& row : view) {
            entities.insert(std::get<0>(row));
        }
    };
    (add(world.view<Components>()), ...);
}

Entity parent_of(const World& world, Entity entity) {
    const auto* const transform = world.find<Transform>(entity);
    return transform ? transform->parent : Entity{};
}

/// All that are nodes if nothing is left out. Throws SceneError if a parent was destroyed.
std::set<Entity> find_nodes(const World& world) {
    std::set<Entity> entities;
    collect<MeshInstance, Camera>(world, entities);
    visit_lights(world, [&](Entity entity, const auto& /*light*/) { entities.insert(entity); });
    for (const auto& [entity, transform] : world.view<Transform>()) {
        if (!world.has<Environment>(entity)) {  // which ignores its transform
            entities.insert(entity);
        }
    }
    for (const Entity entity : gltf::moving_entities(world)) {
        entities.insert(entity);
    }
    std::vector<Entity> ahead(entities.begin(), entities.end());
    while (!ahead.empty()) {
        const Entity entity = ahead.back();
        ahead.pop_back();
        const Entity parent = parent_of(world, entity);
        if (parent && !world.alive(parent)) {
            throw SceneError(fmt::format("{}: its parent no longer exists", describe(world, entity)));
        }
        if (parent && entities.insert(parent).second) ahead.push_back(parent);
    }
    return entities;
}

/// Throws SceneError if parents form a cycle.
Nodes choose_nodes(const World& world, std::span<const Entity> without) {
    const std::set<Entity> all = find_nodes(world);
    std::map<Entity, std::vector<Entity>> children;  // those of the null entity are the roots
    for (const Entity entity : all) {
        children[parent_of(world, entity)].push_back(entity);
    }
    const std::set<Entity> left_out(without.begin(), without.end());
    std::set<Entity> reached;
    Nodes nodes;
    std::vector<std::pair<Entity, bool>> ahead{{Entity{}, true}};  // and whether they are kept
    while (!ahead.empty()) {
        const auto [parent, is_kept] = ahead.back();
        ahead.pop_back();
        for (const Entity child : children[parent]) {
            reached.insert(child);
            ahead.emplace_back(child, is_kept && !left_out.contains(child));
            if (ahead.back().second) nodes.push_back(child);
        }
    }
    const auto lost = std::ranges::find_if(all, [&](Entity entity) { return !reached.contains(entity); });
    if (lost != all.end()) {
        throw SceneError(fmt::format("{}: its parents form a cycle", describe(world, *lost)));
    }
    std::ranges::sort(nodes);
    return nodes;
}

Json describe_camera(const Camera& camera) {
    if (camera.projection == Camera::Projection::orthographic) {
        return {{"type", "orthographic"},
                {"orthographic",
                 {{"xmag", to_json(camera.half_height)},
                  {"ymag", to_json(camera.half_height)},
                  {"znear", to_json(camera.near_plane)},
                  {"zfar", to_json(camera.far_plane)}}}};
    }
    Json lens = {{"yfov", to_json(camera.vertical_fov)}, {"znear", to_json(camera.near_plane)}};
    if (std::isfinite(camera.far_plane)) lens["zfar"] = to_json(camera.far_plane);
    return {{"type", "perspective"}, {"perspective", std::move(lens)}};
}

/// Writes the components of entities.
class SceneWriter {
 public:
    SceneWriter(const World& world, Nodes nodes, Draft& draft)
        : world_(world),
          nodes_(std::move(nodes)),
          draft_(draft),
          meshes_(draft),
          motion_(world, nodes_, draft) {}

    void write_nodes() {
        for (const Entity entity : nodes_) {
            gltf::naming(describe(world_, entity), [&] { draft_.add("nodes", describe_node(entity)); });
        }
        Json scene = Json::object();
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const Entity parent = parent_of(world_, nodes_[i]);
            Json& list = parent ? draft_.document["nodes"][node_of(parent)]["children"] : scene["nodes"];
            list.push_back(i);
        }
        draft_.document["scenes"].push_back(std::move(scene));
        draft_.document["scene"] = 0;
    }

    void write_animations(std::span<const Entity> without) {
        std::vector<Entity> players;
        for (const auto& [entity, player] : world_.view<AnimationPlayer>()) {
            const bool is_kept = std::ranges::find(without, entity) == without.end();
            if (is_kept && player.animations) players.push_back(entity);
        }
        std::ranges::sort(players);
        for (const Entity entity : players) {
            const bool is_complete = gltf::naming(describe(world_, entity), [&] {
                return motion_.add_clips(*world_.get<AnimationPlayer>(entity).animations);
            });
            if (!is_complete) warn(entity, "its animations of what is no node are left out");
        }
        if (players.size() > 1) warn(players[1], "its animations become those of the first player");
    }

    void write_environment(std::span<const Entity> without) {
        const auto is_kept = [&](Entity entity) {
            return std::ranges::find(without, entity) == without.end();
        };
        std::vector<Entity> entities;
        for (const auto& [entity, environment] : world_.view<Environment>()) {
            if (is_kept(entity)) entities.push_back(entity);
        }
        if (entities.empty()) return;
        Entity counting = entities.front();  // if none shines
        static_cast<void>(environment_of(world_, [&](Entity entity, const Environment&) {
            counting = is_kept(entity) ? entity : counting;
            return is_kept(entity);
        }));
        gltf::naming(describe(world_, counting), [&] { describe_environment(counting); });
        std::erase(entities, counting);
        for (const Entity entity : entities) {
            warn(entity, "its environment is left out: a glTF scene has one");
        }
    }

 private:
    void warn(Entity entity, std::string_view what) {
        draft_.warnings.push_back(fmt::format("{}: {}", describe(world_, entity), what));
    }

    [[nodiscard]] std::size_t node_of(Entity entity) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(nodes_, entity) - nodes_.begin());
    }

    Json describe_node(Entity entity) {
        Json node = Json::object();
        if (const auto* const name = world_.find<Name>(entity)) node["name"] = to_json(name->value);
        if (const auto* const transform = world_.find<Transform>(entity)) {
            add_transform(entity, *transform, node);
        }
        if (const auto* const instance = world_.find<MeshInstance>(entity)) add_mesh(entity, *instance, node);
        if (const auto* const camera = world_.find<Camera>(entity)) add_camera(entity, *camera, node);
        if (const std::optional<AnyLight> light = find_light(entity)) add_light(entity, *light, node);
        return node;
    }

    void add_transform(Entity entity, const Transform& transform, Json& node) {
        const Transform unmoved;
        if (transform.translation != unmoved.translation) {
            node["translation"] = to_json(transform.translation);
        }
        if (transform.scale != unmoved.scale) node["scale"] = to_json(transform.scale);
        if (transform.rotation == unmoved.rotation) return;
        const double length = glm::length(glm::dquat(transform.rotation));
        if (length != 0.0) node["rotation"] = to_json(transform.rotation);
        if (!is_unit_length(length)) {
            warn(entity, "its rotation is not of unit length and will be normalised");
        }
    }

    void add_mesh(Entity entity, const MeshInstance& instance, Json& node) {
        if (!instance.mesh) throw SceneError("it has no mesh");
        if (const std::optional<std::size_t> index = meshes_.index_of(instance.mesh)) {
            node["mesh"] = *index;
            add_motion(entity, *instance.mesh, node);
        } else {
            warn(entity, "its mesh has no triangles and is left out");
        }
        const bool is_figure = world_.has<Skin>(entity) || world_.has<MorphWeights>(entity);
        if (world_.has<DeformedMesh>(entity) && !is_figure) {
            warn(entity, "its deformation is left out: its mesh will have its own shape");
        }
    }

    void add_motion(Entity entity, const Mesh& mesh, Json& node) {
        const std::size_t targets = gltf::count_targets(mesh);
        const auto* const weights = world_.find<MorphWeights>(entity);
        if (weights && targets > 0) node["weights"] = gltf::describe_weights(weights->values, targets);
        const auto* const skin = world_.find<Skin>(entity);
        if (!skin) return;
        if (const std::optional<std::size_t> index = motion_.index_of(*skin)) {
            node["skin"] = *index;
        } else {
            warn(entity, "its skin is left out: not all of its joints are nodes");
        }
    }

    void add_camera(Entity entity, const Camera& camera, Json& node) {
        if (camera.projection == Camera::Projection::custom) {
            warn(entity, "its camera is left out: glTF has no custom projections");
            return;
        }
        check(fault_of(camera));
        node["camera"] = draft_.add("cameras", describe_camera(camera));
    }

    void add_light(Entity entity, const AnyLight& light, Json& node) {
        check(fault_of(light));
        gltf::WrittenLight written = gltf::write_light(light);
        if (!written.warning.empty()) warn(entity, written.warning);
        if (written.json.contains("extensions")) draft_.use_extension(gltf::light_extension);
        draft_.use_extension(gltf::lights_extension);
        Json& lights = draft_.document["extensions"][gltf::lights_extension]["lights"];
        lights.push_back(std::move(written.json));
        node["extensions"][gltf::lights_extension] = {{"light", lights.size() - 1}};
    }

    [[nodiscard]] std::optional<AnyLight> find_light(Entity entity) const {
        std::optional<AnyLight> found;
        visit_lights_of(world_, entity, [&](const auto& light) {
            if (found) throw SceneError("it has several lights, but a node of glTF has only one");
            found = light;
        });
        return found;
    }

    void describe_environment(Entity entity) {
        const auto& environment = world_.get<Environment>(entity);
        check(fault_of(environment));
        Json json = {{"radiance", to_json(environment.radiance)},
                     {"rotation", to_json(environment.rotation)}};
        if (const auto* const name = world_.find<Name>(entity)) json["name"] = to_json(name->value);
        if (environment.picture) {
            const SkyPicture& picture = *environment.picture;
            check(fault_of(picture));
            check_sky_size(picture.width, picture.height);
            json.update(
                draft_.add_picture(encode_exr(picture.width, picture.height, picture.texels), "-sky.exr"));
        }
        draft_.document["scenes"][0]["extensions"][gltf::environment_extension] = std::move(json);
        draft_.use_extension(gltf::environment_extension);
    }

    const World& world_;
    Nodes nodes_;
    Draft& draft_;
    gltf::MeshWriter meshes_;
    gltf::MotionWriter motion_;  // refers to the nodes
};

}  // namespace

std::vector<std::string> export_gltf(const World& world, const std::filesystem::path& path,
                                     std::span<const Entity> without) {
    std::vector<std::string> warnings;
    const std::vector<OutputFile> files = gltf::naming_file(gltf::utf8_of(path), [&] {
        Draft draft(path);
        SceneWriter writer(world, choose_nodes(world, without), draft);
        writer.write_nodes();
        writer.write_animations(without);
        writer.write_environment(without);
        warnings = std::move(draft.warnings);
        return draft.finish();
    });
    write_files(files);
    return warnings;
}

}  // namespace candela
