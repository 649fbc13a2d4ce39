// Importing glTF, as text and as binary: either refused with a message and the world unchanged, or imported
// into consistent entities, which then move.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <candela/scene/animate.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/gltf.hpp>
#include "tests/fuzz/fuzz.hpp"

using namespace candela;

namespace {

void check_primitive(const Primitive& primitive) {
    fuzz::require(primitive.indices.size() % 3 == 0, "indices form triangles");
    for (const std::uint32_t index : primitive.indices) {
        fuzz::require(index < primitive.vertices.size(), "indices are of vertices");
    }
    for (const Vertex& vertex : primitive.vertices) {
        fuzz::require(std::isfinite(vertex.position.x) && std::isfinite(vertex.position.y) &&
                          std::isfinite(vertex.position.z),
                      "positions are finite");
    }
}

void check_imported(const World& world, const ImportReport& report) {
    fuzz::require(world.size() == report.entities.size() + 1, "the report lists the new entities");
    std::set<Entity> seen;
    std::uint64_t triangles = 0;
    std::set<const Mesh*> checked;
    for (const Entity entity : report.entities) {
        const auto* const transform = world.find<Transform>(entity);  // sky and animations have none
        fuzz::require(!transform || transform->parent == Entity{} || seen.contains(transform->parent),
                      "parents come before their children");
        seen.insert(entity);
        const auto* const instance = world.find<MeshInstance>(entity);
        if (!instance) continue;
        for (const Primitive& primitive : instance->mesh->primitives) {
            triangles += primitive.indices.size() / 3;
            if (checked.insert(instance->mesh.get()).second) check_primitive(primitive);
        }
    }
    fuzz::require(triangles == report.triangles, "the report counts the triangles");
    for (const std::string& warning : report.warnings) {
        fuzz::require_readable(warning);
    }
}

void check_shapes(const World& world) {
    for (const auto& [entity, deformed] : world.view<DeformedMesh>()) {
        const std::vector<Primitive>& primitives = world.get<MeshInstance>(entity).mesh->primitives;
        fuzz::require(deformed.vertices->size() == primitives.size(), "all primitives are deformed");
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            fuzz::require(deformed.vertices->at(i).size() == primitives[i].vertices.size(),
                          "all vertices are deformed");
        }
    }
}

/// Plays the first clips; all of them could take long. What a file moves may be impossible, such as a mesh
/// of size 0 with joints: then it is told.
void check_motion(World& world) {
    MeshDeformer deformer;
    std::vector<Entity> players;
    for (const auto& [entity, player] : world.view<AnimationPlayer>()) players.push_back(entity);
    for (const Entity entity : players) {
        const std::size_t clips = world.get<AnimationPlayer>(entity).animations->clips.size();
        for (std::size_t clip = 0; clip < std::min<std::size_t>(clips, 4); ++clip) {
            world.edit<AnimationPlayer>(entity, [&](AnimationPlayer& player) { player.clip = clip; });
            for (int frame = 0; frame < 3; ++frame) {
                fuzz::require(advance_animations(world, 0.4).empty(), "animations of a file play");
                for (const std::string& fault : deformer.update(world)) fuzz::require_readable(fault);
                check_shapes(world);
            }
        }
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    World world;
    const Entity before = world.create();
    world.set(before, Name{"before"});
    const auto revision = world.revision<Name>();
    // Small limits, so that each is reached, and memory above them is a finding (see -rss_limit_mb in `run`).
    ImportOptions options;
    options.limits = {.bytes = 1 << 20,
                      .image_pixels = 1 << 16,
                      .pixels = 1 << 18,
                      .nodes = 5000,
                      .depth = 3000,
                      .triangles = 20'000};
    try {
        check_imported(world,
                       import_gltf({data, size}, "tests/fuzz/corpus/gltf", "input.gltf", world, options));
        check_motion(world);
    } catch (const SceneError& error) {
        fuzz::require_readable(error.what());
        fuzz::require(std::string_view(error.what()).starts_with("input.gltf: "), "a message names the file");
        fuzz::require(world.size() == 1 && world.revision<Name>() == revision &&
                          world.revision<Transform>() == 0 && world.revision<MeshInstance>() == 0,
                      "a failure leaves the world unchanged");
    }
    return 0;
}
