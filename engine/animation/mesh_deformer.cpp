#include <candela/scene/animate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/scene/scene_error.hpp>
#include "engine/animation/skinning.hpp"

namespace candela {

namespace {

using Vertices = DeformedMesh::Vertices;

/// Buffers of one figure that are free again. A buffer returns when its last holder, perhaps in another
/// thread, lets it go. The pointer is another each time, also for weak pointers, so that nobody takes new
/// content for old.
class SpareBuffers {
 public:
    /// A buffer with texture coordinates and colours of the mesh, and some positions, normals and tangents.
    static std::unique_ptr<Vertices> take(SpareBuffers& spare, const Mesh& mesh) {
        {
            const std::lock_guard lock(spare.mutex_);
            for (std::unique_ptr<Vertices>& free : spare.free_) {
                if (free) return std::move(free);
            }
        }
        auto vertices = std::make_unique<Vertices>();
        for (const Primitive& primitive : mesh.primitives) vertices->push_back(primitive.vertices);
        return vertices;
    }

    static std::shared_ptr<const Vertices> share(const std::shared_ptr<SpareBuffers>& spare,
                                                 std::unique_ptr<Vertices> vertices) {
        return {vertices.release(), [spare](Vertices* released) { spare->put(released); }};
    }

 private:
    void put(Vertices* released) {
        std::unique_ptr<Vertices> vertices(released);
        const std::lock_guard lock(mutex_);
        for (std::unique_ptr<Vertices>& free : free_) {
            if (!free) {
                free = std::move(vertices);
                return;
            }
        }
    }

    std::mutex mutex_;
    std::array<std::unique_ptr<Vertices>, 2> free_;
};

/// What a mesh needs to be deformed; shared by its instances.
struct PreparedMesh {
    std::weak_ptr<const Mesh> mesh;
    std::vector<PreparedInfluences> influences;  // by primitive
    std::size_t joints = 0;                      // that it needs
    bool has_targets = false;
    std::optional<std::string> fault;
};

PreparedMesh prepare(const std::shared_ptr<const Mesh>& mesh) {
    PreparedMesh prepared;
    prepared.mesh = mesh;
    for (std::size_t i = 0; i < mesh->primitives.size() && !prepared.fault; ++i) {
        const Primitive& primitive = mesh->primitives[i];
        prepared.has_targets |= !primitive.targets.empty();
        prepared.fault = fault_of_targets(primitive);
        try {
            prepared.influences.push_back(prepare_influences(primitive));
            prepared.joints = std::max(prepared.joints, prepared.influences.back().joints);
        } catch (const SceneError& error) {
            prepared.fault = error.what();
        }
        if (prepared.fault) prepared.fault = fmt::format("primitive {} of its mesh: {}", i, *prepared.fault);
    }
    return prepared;
}

/// What a figure was deformed with last, and the result.
struct Figure {
    Entity entity;
    std::shared_ptr<const Mesh> mesh;
    std::vector<AffineColumns> joints;
    std::vector<float> weights;
    std::shared_ptr<const Vertices> result;
    std::shared_ptr<SpareBuffers> spare = std::make_shared<SpareBuffers>();
    bool is_seen = false;  // in this update
};

bool same_bits(const std::vector<AffineColumns>& a, const std::vector<AffineColumns>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(AffineColumns)) == 0);
}

/// The ticks of all that deformations depend on. Pools with equal revisions have equal content.
std::array<Tick, 5> revisions_of(const WorldReader& world) {
    return {world.revision<Transform>(), world.revision<MeshInstance>(), world.revision<Skin>(),
            world.revision<MorphWeights>(), world.revision<DeformedMesh>()};
}

/// World matrices by the entity's index, bit for bit those of world_matrix. Its memory is kept from update to
/// update.
class PoseMatrices {
 public:
    void begin(const WorldReader& world) {
        world_ = world;
        ++update_;
    }

    /// Throws like world_matrix.
    const glm::mat4& operator()(Entity entity) {
        ahead_.clear();
        const Transform* transform = nullptr;
        const glm::mat4* above = nullptr;
        for (Entity at = entity; at; at = transform ? transform->parent : Entity{}) {
            if (at.index >= known_.size()) known_.resize(std::size_t{at.index} + 1);
            const bool is_lost = !world_->alive(at) || ahead_.size() > world_->count<Transform>();
            if (is_lost) static_cast<void>(world_matrix(*world_, entity));  // throws, and says why
            if (known_[at.index].update == update_) {
                above = &known_[at.index].matrix;
                break;
            }
            transform = world_->find<Transform>(at);
            ahead_.push_back({at.index, transform});
        }
        for (; !ahead_.empty(); ahead_.pop_back()) {
            Known& known = known_[ahead_.back().index];
            const Transform* const own = ahead_.back().transform;
            const glm::mat4 local = own ? local_matrix(*own) : glm::mat4(1.0F);
            known.matrix = above ? *above * local : local;
            known.update = update_;
            above = &known.matrix;
        }
        return *above;
    }

 private:
    struct Known {
        std::uint64_t update = 0;
        glm::mat4 matrix{1.0F};
    };
    struct Step {
        std::uint32_t index;
        const Transform* transform;
    };

    std::optional<WorldReader> world_;
    std::uint64_t update_ = 0;
    std::vector<Known> known_;
    std::vector<Step> ahead_;
};

/// Throws SceneError if there is none.
glm::mat4 checked_inverse(const glm::mat4& matrix) {
    const glm::mat4 inverse(glm::inverse(glm::dmat4(matrix)));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(inverse[column][row])) {
                throw SceneError("its world matrix, in whose space it is deformed, has no inverse");
            }
        }
    }
    return inverse;
}

}  // namespace

struct MeshDeformer::State {
    std::unordered_map<const Mesh*, PreparedMesh> meshes;
    std::unordered_map<std::uint32_t, Figure> figures;  // by index of the entity
    PoseMatrices matrices;
    std::array<Tick, 5> revisions{};
    AnimationFaults faults;
    std::vector<AffineColumns> joints;  // of the figure that is being looked at; kept for their capacity
    std::vector<float> weights;

    const PreparedMesh& prepared(const std::shared_ptr<const Mesh>& mesh) {
        PreparedMesh& known = meshes[mesh.get()];
        if (known.mesh.expired()) known = prepare(mesh);
        return known;
    }

    void update_figure(const WorldWriter& world, Entity entity) {
        const auto* const instance = world.find<MeshInstance>(entity);
        if (!instance || !instance->mesh) return;
        Figure& figure = figures[entity.index];
        if (figure.entity != entity || figure.mesh != instance->mesh) {
            figure = {};
            figure.entity = entity;
            figure.mesh = instance->mesh;
        }
        figure.is_seen = true;
        try {
            const PreparedMesh& mesh = prepared(figure.mesh);
            if (mesh.fault) throw SceneError(*mesh.fault);
            find_joints(world, entity, mesh);
            find_weights(world, entity, mesh);
            const auto* const now = world.find<DeformedMesh>(entity);
            const bool is_same = now && figure.result && now->vertices == figure.result &&
                                 same_bits(joints, figure.joints) && weights == figure.weights;
            if (is_same) return;
            figure.joints = joints;
            figure.weights = weights;
            figure.result = deform(figure, mesh);
            world.set(entity, DeformedMesh{figure.result});
        } catch (const SceneError& error) {
            faults.push_back(fmt::format("{}: {}", describe(world, entity), error.what()));
        }
    }

    /// Leaves none for an entity without a skin.
    void find_joints(const WorldReader& world, Entity entity, const PreparedMesh& mesh) {
        joints.clear();
        const auto* const skin = world.find<Skin>(entity);
        if (!skin) return;
        if (skin->joints.size() < mesh.joints) {
            throw SceneError(fmt::format("its mesh needs {} joints, but its skin has {}", mesh.joints,
                                         skin->joints.size()));
        }
        const auto& binds = skin->inverse_bind_matrices;
        if (binds && binds->size() != skin->joints.size()) {
            throw SceneError(fmt::format("its skin has {} joints, but {} inverse bind matrices",
                                         skin->joints.size(), binds->size()));
        }
        const glm::mat4 to_local = checked_inverse(matrices(entity));
        for (std::size_t i = 0; i < mesh.joints; ++i) {
            if (!world.alive(skin->joints[i])) {
                throw SceneError(fmt::format("joint {} of its skin no longer exists", i));
            }
            const glm::mat4 to_world = to_local * matrices(skin->joints[i]);
            joints.push_back(columns_of(binds ? to_world * (*binds)[i] : to_world));
        }
    }

    void find_weights(const WorldReader& world, Entity entity, const PreparedMesh& mesh) {
        weights.clear();
        const auto* const morph = world.find<MorphWeights>(entity);
        if (!morph || !mesh.has_targets) return;
        weights = morph->values;
        const auto wrong = std::ranges::find_if_not(weights, [](float x) { return std::isfinite(x); });
        if (wrong != weights.end()) {
            throw SceneError(
                fmt::format("weight {} of its morph targets is not finite", wrong - weights.begin()));
        }
    }

    static std::shared_ptr<const Vertices> deform(const Figure& figure, const PreparedMesh& mesh) {
        std::unique_ptr<Vertices> buffer = SpareBuffers::take(*figure.spare, *figure.mesh);
        for (std::size_t i = 0; i < buffer->size(); ++i) {
            const Primitive& primitive = figure.mesh->primitives[i];
            const PreparedInfluences& influences = mesh.influences[i];
            std::vector<Vertex>& moved = (*buffer)[i];
            const bool is_morphed = !primitive.targets.empty() && !figure.weights.empty();
            const bool is_skinned = !influences.ends.empty() && !figure.joints.empty();
            if (is_morphed || !is_skinned) add_targets(primitive, figure.weights, moved);
            if (is_skinned) {
                move_by_joints(is_morphed ? moved : primitive.vertices, influences, figure.joints, moved);
            }
        }
        return SpareBuffers::share(figure.spare, std::move(buffer));
    }

    /// Entities that have neither skin nor weights any more get back the shape of their mesh.
    void forget(const WorldWriter& world) {
        for (auto at = figures.begin(); at != figures.end();) {
            const Figure& figure = at->second;
            if (figure.is_seen) {
                ++at;
                continue;
            }
            const auto* const now =
                world.alive(figure.entity) ? world.find<DeformedMesh>(figure.entity) : nullptr;
            if (now && now->vertices == figure.result) world.remove<DeformedMesh>(figure.entity);
            at = figures.erase(at);
        }
        std::erase_if(meshes, [](const auto& entry) { return entry.second.mesh.expired(); });
    }
};

MeshDeformer::MeshDeformer() : state_(std::make_unique<State>()) {}
MeshDeformer::MeshDeformer(MeshDeformer&&) noexcept = default;
MeshDeformer& MeshDeformer::operator=(MeshDeformer&&) noexcept = default;
MeshDeformer::~MeshDeformer() = default;

AnimationFaults MeshDeformer::update(const WorldWriter& world) {
    State& state = *state_;
    if (revisions_of(world) == state.revisions) return state.faults;
    state.faults.clear();
    state.matrices.begin(world);
    for (auto& [index, figure] : state.figures) {
        figure.is_seen = false;
    }
    // Neither view changes while DeformedMeshes are set.
    for (const auto& [entity, skin] : world.view<Skin>()) {
        state.update_figure(world, entity);
    }
    for (const auto& [entity, weights] : world.view<MorphWeights>()) {
        if (!world.has<Skin>(entity)) state.update_figure(world, entity);
    }
    state.forget(world);
    state.revisions = revisions_of(world);
    return state.faults;
}

AnimationFaults MeshDeformer::update(const WorldWriter& world, std::span<const Entity> entities) {
    State& state = *state_;
    state.faults.clear();
    state.matrices.begin(world);
    for (const Entity entity : entities) {
        if (world.has<Skin>(entity) || world.has<MorphWeights>(entity)) state.update_figure(world, entity);
    }
    state.revisions = {};  // others may be out of date
    return std::exchange(state.faults, {});
}

}  // namespace candela
