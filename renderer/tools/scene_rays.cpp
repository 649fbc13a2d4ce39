#include <candela/tools/scene_rays.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/traverse.hpp"
#include "engine/bvh/wide.hpp"
#include "engine/scene/check.hpp"

namespace candela::tools {

namespace {

/// A hierarchy of this many triangles is built within a few hundredths of a second.
constexpr std::size_t most_triangles = 1U << 16U;

std::vector<Triangle> triangles_of(const Primitive& primitive, std::size_t first, std::size_t end) {
    std::vector<Triangle> triangles;
    triangles.reserve(end - first);
    const auto corner = [&](std::size_t index) {
        return primitive.vertices[primitive.indices[index]].position;
    };
    for (std::size_t i = first; i < end; ++i) {
        triangles.push_back({corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)});
    }
    return triangles;
}

bool is_finite(const glm::mat4& matrix) {
    float sum = 0.0F;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) sum += matrix[column][row];
    }
    return std::isfinite(sum);
}

Box transformed(const Box& box, const glm::mat4& matrix) {
    Box around;
    for (unsigned corner = 0; corner < 8; ++corner) {
        around.grow(glm::vec3(matrix * glm::vec4(box.corner(corner), 1.0F)));
    }
    return around;
}

glm::vec3 front_of(const Triangle& triangle) {
    return glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
}

candela::Ray to_local(const candela::Ray& ray, const glm::mat4& local_from_world) {
    return {glm::vec3(local_from_world * glm::vec4(ray.origin, 1.0F)),
            glm::mat3(local_from_world) * ray.direction, ray.t_min, ray.t_max};
}

}  // namespace

class CANDELA_PRIVATE SceneRays::State {
 public:
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        stop_.request_stop();  // the future waits for its thread
    }

    void update(const World& world);
    void update_and_wait(const World& world);
    [[nodiscard]] bool building() const { return building_.valid(); }
    [[nodiscard]] std::optional<SurfaceHit> first_hit(const Ray& ray, std::span<const Entity> ignored,
                                                      float most) const;
    [[nodiscard]] bool blocked(const glm::vec3& from, const glm::vec3& to) const;
    [[nodiscard]] std::optional<Entity> enclosing(const glm::vec3& point) const;

 private:
    /// Which triangles a ray meets: those whose visible side faces it, or those that are not drawn because
    /// it is their back.
    enum class Sides : std::uint8_t { visible, hidden };

    /// Triangles of one material in the mesh's local space, few enough to be built without a noticeable wait.
    struct Patch {
        std::vector<Triangle> triangles;
        Bvh bvh;
        bool double_sided = false;
        bool blends = false;
    };
    using Patches = std::vector<Patch>;
    using Meshes = std::map<std::shared_ptr<const Mesh>, std::shared_ptr<const Patches>>;

    /// A patch of an entity's mesh. Its mesh is kept by `meshes_`.
    struct Placed {
        Entity entity;
        const Patch* patch = nullptr;
        glm::mat4 world_from_local{1.0F};
        glm::mat4 local_from_world{1.0F};
        bool operator==(const Placed&) const = default;
    };

    struct Found {
        float t;
        const Placed* placed;
        const Triangle* triangle;
    };

    static Meshes build(const std::vector<std::shared_ptr<const Mesh>>& meshes, const std::stop_token& stop);
    static Patches build_patches(const Mesh& mesh, const std::stop_token& stop);
    void take_built();
    void build_missing(const World& world);
    void place(const World& world);
    template <class Accepts>
    [[nodiscard]] std::optional<Found> search(const candela::Ray& ray, Accepts&& accepts,
                                              Sides sides = Sides::visible) const;

    std::optional<Tick> meshes_at_;      ///< revision of the instances whose meshes are built or being built
    std::optional<Tick> transforms_at_;  ///< revision of the transforms in `placed_`
    Meshes meshes_;
    std::vector<Placed> placed_;
    Bvh top_;  ///< over the boxes of `placed_`
    std::stop_source stop_;
    std::future<Meshes> building_;
};

SceneRays::State::Patches SceneRays::State::build_patches(const Mesh& mesh, const std::stop_token& stop) {
    Patches patches;
    if (fault_of(mesh, Strictness::usual)) return patches;
    for (const Primitive& primitive : mesh.primitives) {
        const std::size_t count = primitive.indices.size() / 3;
        for (std::size_t first = 0; first < count && !stop.stop_requested(); first += most_triangles) {
            std::vector<Triangle> triangles =
                triangles_of(primitive, first, std::min(first + most_triangles, count));
            Bvh bvh = build_bvh(triangles);
            patches.push_back({std::move(triangles), std::move(bvh), primitive.material->double_sided,
                               is_seen_through(*primitive.material)});
        }
    }
    return patches;
}

SceneRays::State::Meshes SceneRays::State::build(const std::vector<std::shared_ptr<const Mesh>>& meshes,
                                                 const std::stop_token& stop) {
    Meshes built;
    for (const auto& mesh : meshes) {
        built.emplace(mesh, std::make_shared<const Patches>(build_patches(*mesh, stop)));
    }
    return built;
}

void SceneRays::State::take_built() {
    if (!building() || building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    meshes_.merge(building_.get());
    meshes_at_.reset();
}

/// Also drops what no entity uses any more.
void SceneRays::State::build_missing(const World& world) {
    std::set<std::shared_ptr<const Mesh>> used;
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        if (instance.mesh) used.insert(instance.mesh);
    }
    std::erase_if(meshes_, [&](const auto& mesh) { return !used.contains(mesh.first); });
    std::vector<std::shared_ptr<const Mesh>> missing;
    std::copy_if(used.begin(), used.end(), std::back_inserter(missing),
                 [&](const auto& mesh) { return !meshes_.contains(mesh); });
    if (!missing.empty()) {
        building_ = std::async(std::launch::async, build, std::move(missing), stop_.get_token());
    }
}

void SceneRays::State::place(const World& world) {
    std::vector<Placed> placed;
    WorldMatrices world_matrices(world);
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        const auto mesh = meshes_.find(instance.mesh);
        if (mesh == meshes_.end()) continue;
        const glm::mat4 world_from_local = world_matrices(entity);
        const glm::mat4 local_from_world = glm::inverse(world_from_local);
        if (!is_finite(local_from_world)) continue;
        for (const Patch& patch : *mesh->second) {
            placed.push_back({entity, &patch, world_from_local, local_from_world});
        }
    }
    if (placed == placed_) return;
    std::vector<Box> boxes;
    boxes.reserve(placed.size());
    for (const Placed& part : placed) {
        const BvhNode& root = part.patch->bvh.nodes.front();
        boxes.push_back(transformed({root.lower, root.upper}, part.world_from_local));
    }
    const bool same_parts = std::equal(
        placed.begin(), placed.end(), placed_.begin(), placed_.end(),
        [](const Placed& a, const Placed& b) { return a.patch == b.patch && a.entity == b.entity; });
    if (same_parts) {
        refit_box_bvh(top_, boxes);
    } else {
        top_ = build_box_bvh(boxes, bvh_max_depth);
    }
    placed_ = std::move(placed);
}

void SceneRays::State::update(const World& world) {
    take_built();
    const Tick meshes = world.revision<MeshInstance>();
    const Tick transforms = world.revision<Transform>();
    if (meshes == meshes_at_ && transforms == transforms_at_) return;
    // A change of the meshes while others are being built is seen after that.
    if (meshes != meshes_at_ && !building()) {
        placed_.clear();  // refers to meshes that may be dropped
        top_ = {};
        build_missing(world);
        meshes_at_ = meshes;
    }
    place(world);
    transforms_at_ = transforms;
}

void SceneRays::State::update_and_wait(const World& world) {
    update(world);
    while (building()) {
        building_.wait();
        update(world);
    }
}

/// The nearest triangle that the ray meets with one of these sides. `accepts(placed)` chooses among the
/// parts.
template <class Accepts>
std::optional<SceneRays::State::Found> SceneRays::State::search(const candela::Ray& ray, Accepts&& accepts,
                                                                Sides sides) const {
    std::optional<Found> nearest;
    candela::Ray rest = ray;
    const auto visit_part = [&](std::uint32_t index) {
        const Placed& part = placed_[index];
        if (!accepts(part)) return rest.t_max;
        const candela::Ray local = to_local(rest, part.local_from_world);
        traverse(part.patch->bvh, local, [&](std::uint32_t at) {
            const Triangle& triangle = part.patch->triangles[at];
            const std::optional<Hit> hit = intersect(triangle, at, local);
            const bool visible =
                part.patch->double_sided || glm::dot(front_of(triangle), local.direction) < 0.0F;
            const bool meets = visible == (sides == Sides::visible);
            if (hit && meets && hit->t < rest.t_max) {
                nearest = Found{hit->t, &part, &triangle};
                rest.t_max = hit->t;
            }
            return rest.t_max;
        });
        return rest.t_max;
    };
    traverse(top_, ray, visit_part);
    return nearest;
}

std::optional<SurfaceHit> SceneRays::State::first_hit(const Ray& ray, std::span<const Entity> ignored,
                                                      float most) const {
    const auto accepts = [&](const Placed& part) {
        return !std::binary_search(ignored.begin(), ignored.end(), part.entity);
    };
    const std::optional<Found> found = search({ray.origin, ray.direction, 0.0F, most}, accepts);
    if (!found) return std::nullopt;
    const glm::mat3 normal_matrix = glm::transpose(glm::mat3(found->placed->local_from_world));
    const glm::vec3 normal = glm::normalize(normal_matrix * front_of(*found->triangle));
    return SurfaceHit{found->placed->entity, ray.origin + found->t * ray.direction,
                      glm::dot(normal, ray.direction) > 0.0F ? -normal : normal, found->t};
}

bool SceneRays::State::blocked(const glm::vec3& from, const glm::vec3& to) const {
    // A light is not hidden by the surface that it lies on.
    constexpr float before_end = 0.999F;
    const auto accepts = [](const Placed& part) { return !part.patch->blends; };
    return search({from, to - from, 0.0F, before_end}, accepts).has_value();
}

std::optional<Entity> SceneRays::State::enclosing(const glm::vec3& point) const {
    // To the corners and the middles of the faces of a cube, turned: few surfaces have edges just there.
    const glm::mat3 turn(glm::mat3_cast(glm::angleAxis(0.3F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F)))));
    const auto blocks = [](const Placed& part) { return !part.patch->blends; };
    std::optional<Entity> nearest;
    float distance = std::numeric_limits<float>::infinity();
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (const int axes = std::abs(x) + std::abs(y) + std::abs(z); axes != 1 && axes != 3)
                    continue;
                const glm::vec3 direction = turn * glm::normalize(glm::vec3(x, y, z));
                const candela::Ray ray{point, direction, 0.0F, std::numeric_limits<float>::infinity()};
                const auto back = search(ray, blocks, Sides::hidden);
                if (!back) return std::nullopt;
                // An object may stand on a floor: then its lower side and the floor are equally near.
                const auto visible = search(ray, blocks, Sides::visible);
                if (visible && visible->t < 0.999F * back->t) return std::nullopt;
                if (back->t < distance) nearest = back->placed->entity;
                distance = std::min(distance, back->t);
            }
        }
    }
    return nearest;
}

SceneRays::SceneRays() : state_(std::make_unique<State>()) {}
SceneRays::~SceneRays() = default;

void SceneRays::update(const World& world) {
    state_->update(world);
}

void SceneRays::update_and_wait(const World& world) {
    state_->update_and_wait(world);
}

bool SceneRays::building() const {
    return state_->building();
}

std::optional<SurfaceHit> SceneRays::first_hit(const Ray& ray, std::span<const Entity> ignored,
                                               float most) const {
    return state_->first_hit(ray, ignored, most);
}

bool SceneRays::blocked(const glm::vec3& from, const glm::vec3& to) const {
    return state_->blocked(from, to);
}

std::optional<Entity> SceneRays::enclosing(const glm::vec3& point) const {
    return state_->enclosing(point);
}

}  // namespace candela::tools
