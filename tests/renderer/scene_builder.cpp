#include "tests/renderer/scene_builder.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include <candela/scene/gltf.hpp>
#include <candela/scene/hierarchy.hpp>
#include "renderer/facade/device_of.hpp"
#include "sandbox/files/shipped_file.hpp"

namespace candela {
namespace {

std::shared_ptr<const Mesh> mesh_of(Primitive primitive) {
    return std::make_shared<const Mesh>(Mesh{"", {std::move(primitive)}});
}

/// Adds a quad, counter-clockwise as seen from the front.
void add_quad(Primitive& primitive, const std::array<glm::vec3, 4>& corners) {
    const std::array<glm::vec2, 4> uvs{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
    const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (std::size_t i = 0; i < 4; ++i) {
        primitive.vertices.push_back({corners[i], normal, uvs[i]});
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) {
        primitive.indices.push_back(first + i);
    }
}

using Indices = std::vector<std::uint32_t>;

/// The corners of an icosahedron of unit radius, and its triangles, counter-clockwise as seen from outside.
std::pair<std::vector<glm::vec3>, Indices> icosahedron() {
    const float t = (1.0F + std::sqrt(5.0F)) / 2.0F;
    std::vector<glm::vec3> corners = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                                      {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                                      {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    for (glm::vec3& corner : corners) {
        corner = glm::normalize(corner);
    }
    return {corners, {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                      4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                      6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1}};
}

Indices subdivide(std::vector<glm::vec3>& corners, const Indices& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(corners.size()));
        if (is_new) corners.push_back(glm::normalize(corners[a] + corners[b]));
        return found->second;
    };
    Indices finer;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    return finer;
}

}  // namespace

std::shared_ptr<const Material> diffuse(glm::vec3 albedo, bool double_sided) {
    Material material;
    material.base_colour = glm::vec4(albedo, 1.0F);
    material.double_sided = double_sided;
    return std::make_shared<const Material>(std::move(material));
}

std::shared_ptr<const Material> emitter(glm::vec3 radiance, float albedo) {
    Material material = *diffuse(glm::vec3(albedo));
    material.emissive = radiance;
    return std::make_shared<const Material>(std::move(material));
}

std::shared_ptr<const Mesh> square(float half, std::shared_ptr<const Material> material) {
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::move(material)};
    add_quad(primitive, {{{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}}});
    return mesh_of(std::move(primitive));
}

std::shared_ptr<const Mesh> box_inwards(float half, std::shared_ptr<const Material> material) {
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::move(material)};
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            glm::vec3 out(0.0F), u(0.0F), v(0.0F);
            out[axis] = side * half;
            u[(axis + 1) % 3] = half;
            v[(axis + 2) % 3] = -side * half;  // so that cross(u, v) points against `out`
            add_quad(primitive, {out - u - v, out + u - v, out + u + v, out - u + v});
        }
    }
    return mesh_of(std::move(primitive));
}

std::shared_ptr<const Mesh> box_outwards(float half, std::shared_ptr<const Material> material) {
    Mesh mesh = *box_inwards(half, std::move(material));
    Primitive& primitive = mesh.primitives.front();
    for (Vertex& vertex : primitive.vertices) {
        vertex.normal = -vertex.normal;
    }
    std::ranges::reverse(primitive.indices);
    return std::make_shared<const Mesh>(std::move(mesh));
}

std::shared_ptr<const Mesh> sphere_inwards(float radius, int subdivisions,
                                           std::shared_ptr<const Material> material) {
    auto [corners, triangles] = icosahedron();
    for (int i = 0; i < subdivisions; ++i) {
        triangles = subdivide(corners, triangles);
    }
    Primitive primitive{.vertices = {}, .indices = std::move(triangles), .material = std::move(material)};
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    }
    for (const glm::vec3& corner : corners) {
        primitive.vertices.push_back({corner * radius, -corner, {}});
    }
    return mesh_of(std::move(primitive));
}

std::shared_ptr<const Mesh> soup(std::size_t count, std::uint32_t seed, float extent) {
    std::mt19937 engine(seed);
    const auto number = [&](float reach) {
        return std::uniform_real_distribution<float>(-reach, reach)(engine);
    };
    const auto vector = [&](float reach) {
        const float x = number(reach), y = number(reach);
        return glm::vec3(x, y, number(reach));
    };
    Primitive primitive{.vertices = {}, .indices = {}, .material = diffuse(glm::vec3(0.5F), true)};
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 a = vector(1.0F);
        const glm::vec3 b = a + vector(extent), c = a + vector(extent);
        const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
        for (const glm::vec3& corner : {a, b, c}) {
            primitive.indices.push_back(static_cast<std::uint32_t>(primitive.vertices.size()));
            primitive.vertices.push_back({corner, normal, {}});
        }
    }
    return mesh_of(std::move(primitive));
}

Transform looking(glm::vec3 from, glm::vec3 target, glm::vec3 up) {
    return {.translation = from, .rotation = glm::quatLookAt(glm::normalize(target - from), up)};
}

Transform upside_down_at(glm::vec3 position) {
    return {.translation = position,
            .rotation = glm::angleAxis(std::numbers::pi_v<float>, glm::vec3(1.0F, 0.0F, 0.0F))};
}

Transform at(glm::vec3 position) {
    return {.translation = position};
}

Scene cornell_box() {
    Scene scene;
    import_gltf(sandbox::shipped_file("scenes", "cornell.gltf"), scene.world);
    for (const auto& [entity, camera] : scene.world.view<Camera>()) {
        scene.camera = entity;
    }
    for (const auto& [entity, light] : scene.world.view<PointLight>()) {
        scene.light = entity;
    }
    return scene;
}

Scene furnace_box(float albedo) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(albedo)))});
    scene.light = add(scene.world, at({0.2F, 0.3F, -0.1F}), PointLight{});
    scene.camera = add(scene.world, looking({0, 0, 0.9F}, {0, 0, 0}), Camera{.vertical_fov = 1.5F});
    return scene;
}

Scene ground() {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(4.0F, diffuse(glm::vec3(0.5F)))});
    scene.light = add(scene.world, Transform{});
    scene.camera = add(scene.world, looking({0.3F, 3.0F, 1.2F}, {0, 0, 0}), Camera{});
    return scene;
}

std::vector<Triangle> world_triangles(const World& world) {
    std::vector<Triangle> triangles;
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        const glm::mat4 matrix = world_matrix(world, entity);
        for (const Primitive& primitive : instance.mesh->primitives) {
            const auto corner = [&](std::size_t i) {
                return glm::vec3(matrix * glm::vec4(primitive.vertices[primitive.indices[i]].position, 1.0F));
            };
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
            }
        }
    }
    return triangles;
}

bool is_sane(const Picture& picture) {
    return std::ranges::all_of(picture.pixels, [](const glm::vec3& p) {
        return std::isfinite(p.r + p.g + p.b) && p.r >= 0.0F && p.g >= 0.0F && p.b >= 0.0F;
    });
}

double mean(const Picture& picture) {
    double sum = 0.0;
    for (const glm::dvec3 pixel : picture.pixels) {
        sum += pixel.r + pixel.g + pixel.b;
    }
    return sum / (3.0 * static_cast<double>(picture.pixels.size()));
}

double worst_error(const Picture& a, const Picture& b, double floor) {
    REQUIRE(a.size == b.size);
    double worst = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const auto wanted = static_cast<double>(b.pixels[i][c]);
            const double error =
                std::abs(static_cast<double>(a.pixels[i][c]) - wanted) / std::max(std::abs(wanted), floor);
            if (std::isnan(error)) return std::numeric_limits<double>::infinity();
            worst = std::max(worst, error);
        }
    }
    return worst;
}

double relative_mean_square(const Picture& picture, const Picture& reference) {
    double error = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::dvec3 wanted(reference.pixels[i]);
        const glm::dvec3 off = glm::dvec3(picture.pixels[i]) - wanted;
        error += glm::dot(off, off);
        power += glm::dot(wanted, wanted);
    }
    return error / power;
}

PixelRay pixel_ray(const Camera& camera, const Transform& pose, glm::uvec2 size, std::uint32_t x,
                   std::uint32_t y, glm::dvec2 beside) {
    const glm::dquat rotation(pose.rotation);
    const glm::dvec3 right = rotation * glm::dvec3(1, 0, 0);
    const glm::dvec3 up = rotation * glm::dvec3(0, 1, 0);
    const glm::dvec3 forward = rotation * glm::dvec3(0, 0, -1);
    const glm::dvec2 extent(size);
    const double aspect = extent.x / extent.y;
    const double across = (2.0 * (x + 0.5 + beside.x) / extent.x - 1.0) * aspect;
    const double upwards = 2.0 * (y + 0.5 + beside.y) / extent.y - 1.0;
    const glm::dvec3 origin(pose.translation);
    if (camera.projection == Camera::Projection::orthographic) {
        return {origin + static_cast<double>(camera.half_height) * (across * right + upwards * up), forward};
    }
    const double tangent = std::tan(static_cast<double>(camera.vertical_fov) / 2.0);
    return {origin, forward + tangent * (across * right + upwards * up)};
}

Picture expected_picture(const Scene& scene, glm::uvec2 size, glm::dvec3 point, glm::dvec3 normal,
                         const std::function<glm::dvec3(glm::dvec3)>& radiance, glm::dvec2 beside) {
    Picture picture{size, {}};
    const auto& camera = scene.world.get<Camera>(scene.camera);
    const auto& pose = scene.world.get<Transform>(scene.camera);
    for (std::uint32_t y = 0; y < size.y; ++y) {
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const PixelRay ray = pixel_ray(camera, pose, size, x, y, beside);
            const double t = glm::dot(point - ray.origin, normal) / glm::dot(ray.direction, normal);
            picture.pixels.emplace_back(t > 0.0 ? radiance(ray.origin + t * ray.direction) : glm::dvec3(0.0));
        }
    }
    return picture;
}

void pretend(Renderer& renderer, bool software, std::uint64_t loop_iterations) {
    gl::Limits limits = device_of(renderer).limits();
    limits.software = software;
    limits.loop_iterations = loop_iterations;
    device_of(renderer).pretend(limits);
}

RenderTarget::RenderTarget(gl::Device& device, glm::uvec2 size, Format format)
    : texture_(device, "picture", {size, format}), framebuffer_(device, "picture") {
    framebuffer_.attach_colour(0, texture_.name());
    framebuffer_.draw_buffers(1);
    framebuffer_.check();
    // A new texture holds anything.
    device.gl().ClearTexImage(texture_.name(), 0, GL_RGBA, GL_FLOAT, nullptr);
}

Picture RenderTarget::read() const {
    Picture picture{texture_.desc().size, {}};
    const std::vector<float> values = texture_.read_floats();
    for (std::size_t i = 0; i < values.size(); i += 4) {
        picture.pixels.emplace_back(values[i], values[i + 1], values[i + 2]);
    }
    return picture;
}

Configuration linear_configuration(ShadingPath path) {
    Configuration configuration;
    configuration.path = path;
    configuration.tone_map.enabled = false;
    configuration.interleave = Interleave::one;
    configuration.vpls.count = 32;
    configuration.vpls.guided = false;
    configuration.visibility = {.method = VplVisibility::none, .map_resolution = 16};
    configuration.shadows.cube_resolution = configuration.shadows.map_resolution = 64;
    return configuration;
}

namespace {

Configuration all_at_once(Configuration configuration) {
    configuration.vpls.updates = 0;
    return configuration;
}

}  // namespace

void RenderFixture::configure(const Configuration& configuration) {
    REQUIRE(renderer.configure(configuration) == std::vector<std::string>{});
}

Picture RenderFixture::render(const World& world, Entity camera, glm::uvec2 size) {
    const RenderTarget target(device, size);
    renderer.render(world, camera, target.target());
    return target.read();
}

Picture RenderFixture::settled_picture(const Scene& scene, glm::uvec2 size) {
    constexpr int most_frames = 1000;
    const RenderTarget target(device, size);
    for (int frame = 0; frame < most_frames; ++frame) {
        renderer.render(scene.world, scene.camera, target.target());
        if (renderer.settled()) return target.read();
    }
    FAIL("does not settle");
    return {};
}

Picture RenderFixture::fresh_picture(const Scene& scene, glm::uvec2 size) {
    TestedRenderer fresh(context->get_proc());
    REQUIRE(fresh.configure(all_at_once(renderer.configuration())).empty());
    const RenderTarget target(device, size);
    fresh.render(scene.world, scene.camera, target.target());
    return target.read();
}

Picture RenderFixture::from_scratch(const Scene& scene, glm::uvec2 size) {
    if (!other_) {
        other_ = std::make_unique<Renderer>(context->get_proc(), RendererOptions{.debug_output = true});
    }
    REQUIRE(other_->configure(all_at_once(renderer.configuration())).empty());
    other_->invalidate();
    const RenderTarget target(device, size);
    other_->render(scene.world, scene.camera, target.target());
    return target.read();
}

HostSurfaces RenderFixture::own_surfaces() const {
    const FrameResults results = renderer.results();
    return {.depth = results.depth.texture,
            .normal = results.normal.texture,
            .albedo = results.albedo.texture,
            .clip_from_view = results.view.clip_from_view,
            .clip_depth_from_0 = true,
            .empty_depth = 0.0F,
            .normal_encoding = NormalEncoding::octahedral};
}

bool RenderFixture::ran(std::string_view pass) const {
    const auto found = std::ranges::find(renderer.last_passes(), pass, &PassRecord::name);
    REQUIRE(found != renderer.last_passes().end());
    return found->ran;
}

}  // namespace candela
