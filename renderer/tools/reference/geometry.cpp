#include "renderer/tools/reference/geometry.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/scene/tangents.hpp>

#include "renderer/tools/reference/constants.hpp"

namespace candela::reference {

namespace {

constexpr std::uint32_t masked_group = 1;
constexpr std::uint32_t blended_group = 2;

RTCDevice new_device() {
    // A single thread builds: the scenes are small, and the hierarchy must always be the same.
    const RTCDevice device = rtcNewDevice("threads=1");
    if (device == nullptr) throw std::runtime_error("Embree gives no device");
    return device;
}

/// Normals are transformed by the cofactors of the matrix. Mirroring flips their sign, which is undone here.
glm::mat3 normal_matrix(const glm::mat3& placement) {
    const glm::mat3 cofactors(glm::cross(placement[1], placement[2]), glm::cross(placement[2], placement[0]),
                              glm::cross(placement[0], placement[1]));
    return glm::determinant(placement) < 0.0F ? -cofactors : cofactors;
}

/// Corners in world space, counter-clockwise as seen from the front. Mirroring flips their order, which is
/// undone here.
std::array<Triangle::Corner, 3> placed_corners(const Primitive& primitive, std::size_t first,
                                               const glm::mat4& to_world) {
    const glm::mat3 to_normal = normal_matrix(glm::mat3(to_world));
    std::array<Triangle::Corner, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex& vertex = primitive.vertices[primitive.indices[first + i]];
        corners[i] = {glm::vec3(to_world * glm::vec4(vertex.position, 1.0F)), to_normal * vertex.normal,
                      vertex.uv, glm::vec4(vertex.colour) / 65535.0F};
    }
    if (glm::determinant(glm::mat3(to_world)) < 0.0F) std::swap(corners[1], corners[2]);
    return corners;
}

/// In the order of placed_corners. In a mirrored mesh, normal and tangent have the other bitangent.
Tangents placed_tangents(const Primitive& primitive, std::size_t first, const glm::mat4& to_world) {
    const glm::mat3 placement(to_world);
    const bool is_mirrored = glm::determinant(placement) < 0.0F;
    Tangents tangents{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4 tangent = unpacked_tangent(primitive.vertices[primitive.indices[first + i]].tangent);
        tangents[i] = glm::vec4(placement * glm::vec3(tangent), is_mirrored ? -tangent.w : tangent.w);
    }
    if (is_mirrored) std::swap(tangents[1], tangents[2]);
    return tangents;
}

/// In the order of placed_corners.
SecondUvs placed_second_uvs(const Primitive& primitive, std::size_t first, const glm::mat4& to_world) {
    SecondUvs uvs{};
    for (std::size_t i = 0; i < 3; ++i) {
        uvs[i] = primitive.second_uvs[primitive.indices[first + i]];
    }
    if (glm::determinant(glm::mat3(to_world)) < 0.0F) std::swap(uvs[1], uvs[2]);
    return uvs;
}

std::size_t group_of(AlphaMode mode) {
    return static_cast<std::size_t>(mode);  // declared in this order
}

RTCRay to_embree(const Ray& ray) {
    return {.org_x = ray.origin.x,
            .org_y = ray.origin.y,
            .org_z = ray.origin.z,
            .tnear = ray.nearest,
            .dir_x = ray.direction.x,
            .dir_y = ray.direction.y,
            .dir_z = ray.direction.z,
            .time = 0.0F,
            .tfar = ray.farthest,
            .mask = ~0U,
            .id = 0,
            .flags = 0};
}

RTCRayHit to_embree_query(const Ray& ray) {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

/// The context of a look() query: what the filter needs in addition to Embree's context.
struct LookContext {
    embree::QueryContext embree;
    const Geometry* geometry;
    glm::vec3 direction;  ///< of the ray
    std::vector<Hit>* blended;
};

/// Removes duplicates: a ray through the edge between two triangles hits both of them.
void drop_doubles(std::vector<Hit>& hits, const Geometry& geometry) {
    const auto is_same = [&](const Hit& a, const Hit& b) {
        const bool same_part = geometry.triangle(a.triangle).part == geometry.triangle(b.triangle).part;
        return same_part && b.distance - a.distance <= 1e-6F * b.distance;
    };
    hits.erase(std::unique(hits.begin(), hits.end(), is_same), hits.end());
}

}  // namespace

Geometry::Geometry(const World& world) {
    gather(world);
    group_by_alpha();
    measure();
    device_.reset(new_device());
    solids_ = accelerate(blended_group, RTC_SCENE_FLAG_ROBUST);
    all_ = accelerate(groups_.size(), RTC_SCENE_FLAG_ROBUST | embree::filtered_queries);
}

void Geometry::gather(const World& world) {
    MaterialList materials;
    WorldMatrices world_matrices(world);
    std::uint32_t part = 0;
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        const glm::mat4 to_world = world_matrices(entity);
        for (const Primitive& primitive : instance.mesh->primitives) {
            add(primitive, to_world, materials.index_of(primitive.material), part++);
        }
    }
    materials_ = materials.take();
}

void Geometry::add(const Primitive& primitive, const glm::mat4& to_world, std::uint32_t material,
                   std::uint32_t part) {
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        const auto corners = placed_corners(primitive, i, to_world);
        const glm::vec3 across =
            glm::cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position);
        const float twice_area = glm::length(across);
        if (twice_area <= 0.0F) continue;
        triangles_.push_back({corners, across / twice_area, material, part, 0});
        if (uses_second_uvs(*primitive.material)) {
            triangles_.back().second_uvs = static_cast<std::uint32_t>(second_uvs_.size());
            second_uvs_.push_back(placed_second_uvs(primitive, i, to_world));
        }
        if (!primitive.material->normal_texture) continue;
        triangles_.back().tangents = static_cast<std::uint32_t>(tangents_.size());
        tangents_.push_back(placed_tangents(primitive, i, to_world));
    }
}

void Geometry::group_by_alpha() {
    const auto mode = [&](const Triangle& triangle) { return materials_[triangle.material].alpha_mode; };
    std::ranges::stable_sort(triangles_, {}, mode);
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        const auto count = static_cast<std::uint32_t>(
            std::ranges::count_if(triangles_, [&](const auto& t) { return group_of(mode(t)) == i; }));
        groups_[i] = {first, count, this};
        first += count;
    }
}

void Geometry::measure() {
    if (triangles_.empty()) return;
    glm::vec3 lower(infinity);
    glm::vec3 upper = -lower;
    for (const Triangle& triangle : triangles_) {
        for (const Triangle::Corner& corner : triangle.corners) {
            lower = glm::min(lower, corner.position);
            upper = glm::max(upper, corner.position);
        }
    }
    bounds_ = {0.5F * (lower + upper), 0.5F * glm::length(upper - lower)};
}

Geometry::Accelerator Geometry::accelerate(std::size_t groups, int flags) {
    Accelerator scene(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(flags));
    for (std::size_t i = 0; i < groups; ++i) {
        if (groups_[i].count > 0) attach(scene.get(), i);
    }
    rtcCommitScene(scene.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
        throw std::runtime_error(
            fmt::format("Embree cannot build a hierarchy over {} triangles", triangles_.size()));
    }
    return scene;
}

void Geometry::attach(RTCScene scene, std::size_t index) {
    Group& group = groups_[index];
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                      RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                                                      std::size_t{3} * group.count));
    auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), group.count));
    for (std::uint32_t i = 0; i < group.count; ++i) {
        for (const Triangle::Corner& corner : triangles_[group.first + i].corners) {
            *positions++ = corner.position;
        }
        indices[i] = glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2);
    }
    rtcSetGeometryUserData(geometry, &group);
    if (index == masked_group) {
        rtcSetGeometryIntersectFilterFunction(geometry, skip_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, skip_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(index));
    rtcReleaseGeometry(geometry);
}

void Geometry::skip_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto& group = *static_cast<const Group*>(arguments->geometryUserPtr);
    const Triangle& triangle = group.geometry->triangle(group.first + RTCHitN_primID(arguments->hit, 1, 0));
    const glm::vec2 weights(RTCHitN_u(arguments->hit, 1, 0), RTCHitN_v(arguments->hit, 1, 0));
    const SurfaceMaterial& material = group.geometry->material(triangle);
    if (material.is_hole(colour_at(triangle, material, weights))) arguments->valid[0] = 0;
}

void Geometry::skip_unseen(const RTCFilterFunctionNArguments* arguments) {
    const auto& context = *reinterpret_cast<const LookContext*>(arguments->context);
    const Group& group = context.geometry->groups_[RTCHitN_geomID(arguments->hit, 1, 0)];
    const Hit hit{RTCRayN_tfar(arguments->ray, 1, 0), group.first + RTCHitN_primID(arguments->hit, 1, 0),
                  glm::vec2(RTCHitN_u(arguments->hit, 1, 0), RTCHitN_v(arguments->hit, 1, 0))};
    const Triangle& triangle = context.geometry->triangle(hit.triangle);
    const SurfaceMaterial& material = context.geometry->material(triangle);
    const bool shows_front = glm::dot(triangle.front, context.direction) < 0.0F;
    const bool is_visible = shows_front || material.double_sided;
    const bool is_blended = material.alpha_mode == AlphaMode::blend;
    if (is_visible && is_blended) context.blended->push_back(hit);
    if (!is_visible || is_blended) arguments->valid[0] = 0;
}

std::optional<Hit> Geometry::to_hit(const RTCRayHit& query) const {
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{
        query.ray.tfar, groups_[query.hit.geomID].first + query.hit.primID, {query.hit.u, query.hit.v}};
}

std::optional<Hit> Geometry::closest(const Ray& ray) const {
    RTCRayHit query = to_embree_query(ray);
    embree::intersect(solids_.get(), query);
    return to_hit(query);
}

bool Geometry::is_blocked(const Ray& ray) const {
    RTCRay query = to_embree(ray);
    embree::occluded(solids_.get(), query);
    return query.tfar < 0.0F;  // Embree's mark of a hit
}

ImagePlace Geometry::image_place(const Triangle& triangle, glm::vec2 weights) const {
    const glm::vec2 uv = uv_at(triangle, weights);
    if (!material(triangle).needs_second_uvs) return {uv, uv};
    const auto& [a, b, c] = second_uvs_[triangle.second_uvs];
    return {uv, a + weights.x * (b - a) + weights.y * (c - a)};
}

Sight Geometry::look(const Ray& ray) const {
    Sight sight;
    LookContext context{{}, this, ray.direction, &sight.blended};
    RTCRayHit query = to_embree_query(ray);
    embree::intersect(all_.get(), query, context.embree, skip_unseen);
    sight.solid = to_hit(query);

    if (sight.solid) {
        const float solid = sight.solid->distance;
        std::erase_if(sight.blended, [&](const Hit& hit) { return hit.distance >= solid; });
    }
    std::ranges::sort(sight.blended, {}, &Hit::distance);
    drop_doubles(sight.blended, *this);
    return sight;
}

glm::vec3 position_at(const Triangle& triangle, glm::vec2 weights) {
    const auto& [a, b, c] = triangle.corners;
    return a.position + weights.x * (b.position - a.position) + weights.y * (c.position - a.position);
}

glm::vec3 normal_at(const Triangle& triangle, glm::vec2 weights) {
    const auto& [a, b, c] = triangle.corners;
    return a.normal + weights.x * (b.normal - a.normal) + weights.y * (c.normal - a.normal);
}

glm::vec4 tangent_at(const Tangents& tangents, glm::vec2 weights) {
    const auto& [a, b, c] = tangents;
    return a + weights.x * (b - a) + weights.y * (c - a);
}

glm::vec2 uv_at(const Triangle& triangle, glm::vec2 weights) {
    const auto& [a, b, c] = triangle.corners;
    return a.uv + weights.x * (b.uv - a.uv) + weights.y * (c.uv - a.uv);
}

glm::vec4 colour_at(const Triangle& triangle, const SurfaceMaterial& material, glm::vec2 weights) {
    const auto& [a, b, c] = triangle.corners;
    return material.colour(uv_at(triangle, weights)) *
           (a.colour + weights.x * (b.colour - a.colour) + weights.y * (c.colour - a.colour));
}

}  // namespace candela::reference
