// Surfaces that the host has drawn, in place of Candela's own.

#include <doctest/doctest.h>

#include <array>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/texels.hpp"
#include "tests/throws.hpp"

TEST_SUITE("host surfaces") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{48, 36};

/// A texture of the host's with OpenGL's default parameters, which ask for mip levels that it does not have.
class HostTexture {
 public:
    HostTexture(gl::Device& device, const std::vector<glm::vec4>& texels, Format format)
        : texture_(device, "host's", {size, format}) {
        std::vector<float> channels;
        for (const glm::vec4& texel : texels) {
            channels.push_back(texel.x);
            if (format == Format::rgba32f) channels.insert(channels.end(), {texel.y, texel.z, texel.w});
        }
        texture_.upload(std::as_bytes(std::span(channels)));
        device.gl().TextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_LINEAR);
    }
    [[nodiscard]] GLuint name() const { return texture_.name(); }

 private:
    gl::Texture texture_;
};

/// The world with all its surfaces glossy, of different roughness, each third one of metal.
void make_glossy(World& world) {
    std::vector<Entity> entities;
    for (const auto& [entity, instance] : world.view<MeshInstance>()) entities.push_back(entity);
    std::uint32_t number = 0;
    for (const Entity entity : entities) {
        Mesh mesh = *world.get<MeshInstance>(entity).mesh;
        for (Primitive& primitive : mesh.primitives) {
            Material material = *primitive.material;
            material.specular = 1.0F;
            material.roughness = 0.15F + 0.2F * static_cast<float>(number % 5);
            material.metalness = number % 3 == 0 ? 1.0F : 0.0F;
            primitive.material = std::make_shared<const Material>(std::move(material));
            ++number;
        }
        world.set(entity, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    }
}

class HostSurfaceTests : public RenderFixture {
 protected:
    HostSurfaceTests() {
        configuration.vpls.count = 64;
        configuration.shadows = {.cube_resolution = 64, .map_resolution = 64};
    }

    /// Renders the usual frame and keeps its surfaces.
    Picture usual() {
        configure(configuration);
        const RenderView view{.camera = scene.camera,
                              .target = target.target(),
                              .keep = {.depth = true, .normal = true, .albedo = true}};
        renderer.render(scene.world, {&view, 1});
        return target.read();
    }

    /// The surfaces that were kept, in Candela's own conventions.
    HostSurfaces own_surfaces() {
        const FrameResults results = renderer.results();
        return {.depth = results.depth.texture,
                .normal = results.normal.texture,
                .albedo = results.albedo.texture,
                .clip_from_view = results.view.clip_from_view,
                .clip_depth_from_0 = true,
                .empty_depth = 0.0F,
                .normal_encoding = NormalEncoding::octahedral};
    }

    /// Roughness and metalness of the usual frame, as texels.
    std::vector<glm::vec4> own_material() {
        const Show shown = configuration.show;
        configuration.show = Show::roughness;
        const Picture roughness = usual();
        configuration.show = Show::metalness;
        const Picture metalness = usual();
        configuration.show = shown;
        std::vector<glm::vec4> texels;
        for (std::size_t i = 0; i < roughness.pixels.size(); ++i) {
            texels.emplace_back(roughness.pixels[i].r, metalness.pixels[i].r, 0.0F, 0.0F);
        }
        return texels;
    }

    /// A frame by another renderer from surfaces of the host's.
    Picture from(const HostSurfaces& surfaces) {
        TestedRenderer other(context->get_proc());
        REQUIRE(other.configure(configuration).empty());
        const RenderTarget to(device, size);
        const RenderView view{.camera = scene.camera, .target = to.target(), .surfaces = surfaces};
        other.render(scene.world, {&view, 1});
        for (const PassRecord& pass : other.last_passes()) {
            CHECK(pass.name != "gbuffer");
            CHECK(pass.name != "forward");
        }
        return to.read();
    }

    Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    RenderTarget target{device, size};
};

// Positions that were stored and read again differ by rounding, which moves the edges of shadows by less than
// a thousandth of a pixel; a wrong convention gives errors near 1.
constexpr double rounding = 1e-4;

}  // namespace

TEST_CASE_FIXTURE(HostSurfaceTests, "Candela's own surfaces come back in on every path") {
    const Picture expected = usual();
    const HostSurfaces surfaces = own_surfaces();
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configuration.path = path;
        CHECK(relative_mean_square(from(surfaces), expected) < rounding);
    }
    CHECK(mean(expected) > 0.01);
}

TEST_CASE_FIXTURE(HostSurfaceTests, "whatever is shown, it is shown of the host's surfaces") {
    for (const Show show : all_shows) {
        CAPTURE(to_string(show));
        configuration.show = show;
        const Picture expected = usual();
        const Picture found = from(own_surfaces());
        if (show == Show::metalness) {  // there is none
            CHECK(mean(expected) == 0.0);
            CHECK(mean(found) == 0.0);
            continue;
        }
        CHECK(mean(expected) > 0.005);
        CHECK(relative_mean_square(found, expected) < rounding);
    }
}

TEST_CASE_FIXTURE(HostSurfaceTests, "with a material, surfaces are as glossy as Candela's own") {
    make_glossy(scene.world);
    add(scene.world, Environment{.radiance = glm::vec3(0.5F), .picture = nullptr});
    // Inside the box, so that there is no pixel in which the sky is seen but in mirrors.
    scene.world.set(scene.camera, looking({0, 1, 0.7F}, {0.1F, 0.7F, -1}));
    const HostTexture material(device, own_material(), Format::rgba32f);
    for (const Show show : all_shows) {
        CAPTURE(to_string(show));
        configuration.show = show;
        const Picture expected = usual();
        CHECK(mean(expected) > 0.005);
        HostSurfaces surfaces = own_surfaces();
        surfaces.material = material.name();
        CHECK(relative_mean_square(from(surfaces), expected) < rounding);
        if (show != Show::total) continue;
        surfaces.material = 0;
        CHECK(relative_mean_square(from(surfaces), expected) > 100.0 * rounding);
    }
}

TEST_CASE_FIXTURE(HostSurfaceTests, "a material comes and goes from frame to frame") {
    const HostTexture mirror(device, std::vector(std::size_t{size.x} * size.y, glm::vec4(0, 1, 0, 0)),
                             Format::rgba32f);
    (void)usual();
    HostSurfaces surfaces = own_surfaces();
    TestedRenderer other(context->get_proc());
    REQUIRE(other.configure(configuration).empty());
    const RenderTarget to(device, size);
    const auto picture_with = [&](std::uint32_t material) {
        surfaces.material = material;
        const RenderView view{.camera = scene.camera, .target = to.target(), .surfaces = surfaces};
        other.render(scene.world, {&view, 1});
        return to.read();
    };
    const Picture lambertian = picture_with(0);
    const Picture mirrors = picture_with(mirror.name());
    CHECK(relative_mean_square(mirrors, lambertian) > 100.0 * rounding);
    CHECK(picture_with(0) == lambertian);
    CHECK(throws<gl::GlError>([&] { (void)picture_with(4711); },
                              "the host's material, texture 4711, does not exist"));
    CHECK(picture_with(mirror.name()) == mirrors);
}

TEST_CASE_FIXTURE(HostSurfaceTests, "surfaces in the conventions of other engines") {
    // Seen at a slant, so that view space is not world space, and from far enough away that there are
    // pixels without a surface.
    scene.world.set(scene.camera, looking({2.5F, 2.2F, 4.7F}, {0, 1, 0}));
    const Picture expected = usual();
    const FrameResults results = renderer.results();
    const gl::Functions& gl = device.gl();
    const std::vector<glm::vec4> own_depth = depths(gl, results.depth);
    const std::vector<glm::vec4> own_normal = texels(gl, results.normal);
    const HostTexture albedo(device, texels(gl, results.albedo), Format::rgba32f);
    const Camera camera = scene.world.get<Camera>(scene.camera);
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const glm::mat4 projection = glm::perspective(camera.vertical_fov, aspect, 0.5F, 20.0F);  // in [-1, 1]
    const glm::mat3 view_from_world(results.view.view_from_world);

    std::vector<glm::vec4> depth;
    std::vector<glm::vec4> signed_world;
    std::vector<glm::vec4> unsigned_view;
    for (std::size_t i = 0; i < own_depth.size(); ++i) {
        const float own = own_depth[i].x;  // near / distance: the camera has no far plane
        const glm::vec4 clip = projection * glm::vec4(0.0F, 0.0F, -camera.near_plane / own, 1.0F);
        depth.emplace_back(own > 0.0F ? 0.5F * clip.z / clip.w + 0.5F : 1.0F);
        const glm::vec3 normal = decoded_normal(own_normal[i]);
        signed_world.emplace_back(normal, 0.0F);
        unsigned_view.emplace_back(0.5F * (view_from_world * normal) + 0.5F, 0.0F);
    }
    const HostTexture host_depth(device, depth, Format::r32f);
    HostSurfaces surfaces{.depth = host_depth.name(), .albedo = albedo.name(), .clip_from_view = projection};

    const HostTexture in_world(device, signed_world, Format::rgba32f);
    surfaces.normal = in_world.name();
    CHECK(relative_mean_square(from(surfaces), expected) < rounding);

    const HostTexture in_view(device, unsigned_view, Format::rgba32f);
    surfaces.normal = in_view.name();
    surfaces.normal_encoding = NormalEncoding::unsigned_xyz;
    surfaces.world_from_normal = glm::transpose(view_from_world);
    CHECK(relative_mean_square(from(surfaces), expected) < rounding);

    surfaces.world_from_normal = glm::mat3(1.0F);
    CHECK(relative_mean_square(from(surfaces), expected) > 100.0 * rounding);
}

TEST_CASE_FIXTURE(HostSurfaceTests,
                  "the host's camera may be orthographic, and refinement averages its light") {
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 1.2F,
                                         .near_plane = 0.5F,
                                         .far_plane = 8.0F});
    const Picture expected = usual();
    const HostSurfaces surfaces = own_surfaces();
    CHECK(relative_mean_square(from(surfaces), expected) < rounding);

    configuration.refinement = {.enabled = true, .frames = 16};
    TestedRenderer other(context->get_proc());
    REQUIRE(other.configure(configuration).empty());
    const RenderTarget to(device, size);
    const RenderView view{.camera = scene.camera, .target = to.target(), .surfaces = surfaces};
    for (std::uint32_t frame = 1; frame <= 8; ++frame) {
        other.render(scene.world, {&view, 1});
        CHECK(other.report().refined == frame);
    }
    // All 8 frames have the same surfels and the same samples of the pixels.
    CHECK(relative_mean_square(to.read(), expected) < rounding);
}

}  // TEST_SUITE("host surfaces")
