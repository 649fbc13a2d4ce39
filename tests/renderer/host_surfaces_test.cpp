// Surfaces that the host has drawn, in place of Candela's own.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <vector>

#include <candela/scene/scene_error.hpp>
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
    HostTexture(gl::Device& device, const std::vector<glm::vec4>& texels, Format format,
                glm::uvec2 of_size = size)
        : texture_(device, "host's", {of_size, format}) {
        fill(texels);
        device.gl().TextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_LINEAR);
    }
    void fill(const std::vector<glm::vec4>& texels) {
        const std::size_t components = gl::format_info(texture_.desc().format).components;
        std::vector<float> channels;
        for (const glm::vec4& texel : texels) {
            for (std::size_t i = 0; i < components; ++i) channels.push_back(texel[static_cast<int>(i)]);
        }
        texture_.upload(std::as_bytes(std::span(channels)));
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

/// A host that draws into textures of its own, with a renderer that keeps their light.
class HostTexturesTests : public HostSurfaceTests {
 protected:
    HostTexturesTests() {
        static_cast<void>(usual());
        const FrameResults results = renderer.results();
        conventions = own_surfaces();
        depth_texels = depths(device.gl(), results.depth);
        normal_texels = texels(device.gl(), results.normal);
        albedo_texels = texels(device.gl(), results.albedo);
        for (glm::vec4& texel : normal_texels) texel = glm::vec4(decoded_normal(texel), 0.0F);
        conventions.normal_encoding = NormalEncoding::signed_xyz;
        depth.emplace(device, depth_texels, Format::r32f);
        normal.emplace(device, normal_texels, Format::rgba32f);
        albedo.emplace(device, albedo_texels, Format::rgba32f);
        REQUIRE(kept.configure(configuration).empty());
    }

    [[nodiscard]] HostSurfaces surfaces(std::uint64_t revision) const {
        HostSurfaces surfaces = conventions;
        surfaces.depth = depth->name();
        surfaces.normal = normal->name();
        surfaces.albedo = albedo->name();
        surfaces.revision = revision;
        return surfaces;
    }

    [[nodiscard]] RenderView view_of(const HostSurfaces& surfaces) const {
        return {.camera = scene.camera, .target = to.target(), .surfaces = surfaces};
    }

    /// A frame of the renderer that goes on from frame to frame.
    Picture next(const HostSurfaces& surfaces) {
        const RenderView view = view_of(surfaces);
        kept.render(scene.world, {&view, 1});
        return to.read();
    }

    [[nodiscard]] std::vector<std::string> passes_that_ran() const {
        std::vector<std::string> names;
        for (const PassRecord& pass : kept.last_passes()) {
            if (pass.ran) names.emplace_back(pass.name);
        }
        return names;
    }
    [[nodiscard]] bool reads_surfaces() const {
        const std::vector<std::string> names = passes_that_ran();
        return std::ranges::find(names, "host-surfaces") != names.end();
    }

    void darken_albedo() {
        for (glm::vec4& texel : albedo_texels) texel *= 0.5F;
        albedo->fill(albedo_texels);
    }

    HostSurfaces conventions;
    std::vector<glm::vec4> depth_texels;
    std::vector<glm::vec4> normal_texels;
    std::vector<glm::vec4> albedo_texels;
    std::optional<HostTexture> depth;
    std::optional<HostTexture> normal;
    std::optional<HostTexture> albedo;
    TestedRenderer kept{context->get_proc()};
    RenderTarget to{device, size};
};

const std::vector<std::string> only_copy{"tone-map"};

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

TEST_CASE_FIXTURE(HostTexturesTests,
                  "with a revision, a still frame only copies, as one without surfaces of the host's") {
    const Picture first = next(surfaces(1));
    CHECK(first == from(surfaces(0)));
    CHECK(reads_surfaces());
    for (int frame = 0; frame < 3; ++frame) {
        CHECK(next(surfaces(1)) == first);
        CHECK(passes_that_ran() == only_copy);
    }
    CHECK(next(surfaces(0)) == first);
    CHECK(reads_surfaces());
    CHECK(next(surfaces(0)) == first);
    CHECK(reads_surfaces());
    // What lights the surfaces is another matter.
    scene.world.edit<PointLight>(scene.light, [](PointLight& light) { light.intensity *= 2.0F; });
    CHECK(next(surfaces(2)) == from(surfaces(0)));
    scene.world.edit<PointLight>(scene.light, [](PointLight& light) { light.intensity *= 2.0F; });
    CHECK(next(surfaces(2)) == from(surfaces(0)));
    CHECK_FALSE(reads_surfaces());
}

TEST_CASE_FIXTURE(HostTexturesTests, "another revision, texture, size or convention is seen at once") {
    Picture last = next(surfaces(1));
    const auto check_change = [&](const HostSurfaces& changed) {
        const Picture now = next(changed);
        CHECK(reads_surfaces());
        CHECK(now == from(changed));
        CHECK(now != last);
        last = now;
        CHECK(next(changed) == last);
        CHECK(passes_that_ran() == only_copy);
    };
    darken_albedo();
    check_change(surfaces(2));

    const HostTexture white(device, std::vector(albedo_texels.size(), glm::vec4(1)), Format::rgba32f);
    HostSurfaces other = surfaces(2);
    other.albedo = white.name();
    check_change(other);

    HostSurfaces turned = other;
    turned.world_from_normal = glm::mat3(glm::rotate(glm::mat4(1.0F), 1.0F, glm::vec3(1, 0, 0)));
    check_change(turned);

    // New storage of the same textures, by a function that the library never calls.
    const gl::Functions& gl = device.gl();
    const auto tex_image = reinterpret_cast<PFNGLTEXIMAGE2DPROC>(context->get_proc()("glTexImage2D"));
    std::array<GLuint, 3> names{};
    gl.GenTextures(3, names.data());
    const auto specify = [&](GLuint name, GLint internal, GLenum layout, const std::vector<glm::vec4>& texels,
                             std::uint32_t step) {
        std::vector<float> channels;
        for (std::uint32_t y = 0; y < size.y; y += step) {
            for (std::uint32_t x = 0; x < size.x; x += step) {
                const glm::vec4 texel = texels[y * size.x + x];
                channels.push_back(texel.x);
                if (layout == GL_RGB) channels.insert(channels.end(), {texel.y, texel.z});
            }
        }
        gl.BindTexture(GL_TEXTURE_2D, name);
        tex_image(GL_TEXTURE_2D, 0, internal, static_cast<GLsizei>(size.x / step),
                  static_cast<GLsizei>(size.y / step), 0, layout, GL_FLOAT, channels.data());
        gl.BindTexture(GL_TEXTURE_2D, 0);
    };
    const auto specify_all = [&](std::uint32_t step) {
        specify(names[0], GL_R32F, GL_RED, depth_texels, step);
        specify(names[1], GL_RGB32F, GL_RGB, normal_texels, step);
        specify(names[2], GL_RGB32F, GL_RGB, albedo_texels, step);
    };
    HostSurfaces resized = surfaces(3);
    resized.depth = names[0];
    resized.normal = names[1];
    resized.albedo = names[2];
    specify_all(1);
    check_change(resized);
    specify_all(2);
    check_change(resized);
    gl.DeleteTextures(3, names.data());
}

TEST_CASE_FIXTURE(HostTexturesTests,
                  "surfaces with a revision stay through other graphs, views and exceptions") {
    const Picture first = next(surfaces(1));
    configuration.tone_map.enabled = true;
    REQUIRE(kept.configure(configuration).empty());
    CHECK(next(surfaces(1)) == from(surfaces(0)));
    configuration.tone_map.enabled = false;
    REQUIRE(kept.configure(configuration).empty());
    CHECK(next(surfaces(1)) == first);

    darken_albedo();
    HostSurfaces missing = surfaces(2);
    missing.normal = 4711;
    CHECK_THROWS_AS(static_cast<void>(next(missing)), gl::GlError);
    CHECK(next(surfaces(2)) == from(surfaces(0)));

    // Views have revisions of their own.
    const RenderTarget second(device, size);
    const HostTexture white(device, std::vector(albedo_texels.size(), glm::vec4(1)), Format::rgba32f);
    HostSurfaces of_second = surfaces(2);
    of_second.albedo = white.name();
    std::vector<RenderView> views{view_of(surfaces(2)), view_of(of_second)};
    views[1].target = second.target();
    for (int frame = 0; frame < 2; ++frame) {
        kept.render(scene.world, views);
        CHECK(to.read() == from(surfaces(0)));
        of_second.revision = 0;
        CHECK(second.read() == from(of_second));
    }
    // Not more passes than if Candela had drawn the surfaces: views share memory.
    const std::size_t passes = passes_that_ran().size();
    std::vector<RenderView> own = views;
    for (RenderView& view : own) view.surfaces.reset();
    for (int frame = 0; frame < 2; ++frame) kept.render(scene.world, own);
    CHECK(passes <= passes_that_ran().size());
    kept.render(scene.world, views);
    CHECK(to.read() == from(surfaces(0)));
    kept.invalidate();
    kept.render(scene.world, views);
    CHECK(second.read() == from(of_second));
}

TEST_CASE_FIXTURE(HostTexturesTests, "refinement starts over with a new revision, and goes on without") {
    configuration.refinement = {.enabled = true, .frames = 4};
    REQUIRE(kept.configure(configuration).empty());
    for (std::uint32_t frame = 1; frame <= 4; ++frame) {
        static_cast<void>(next(surfaces(1)));
        CHECK(kept.report().refined == frame);
    }
    const Picture refined = next(surfaces(1));
    CHECK(kept.settled());
    CHECK(passes_that_ran() == only_copy);
    darken_albedo();
    CHECK(relative_mean_square(next(surfaces(2)), refined) > 100.0 * rounding);
    CHECK(kept.report().refined == 1);
    for (std::uint32_t frame = 2; frame <= 4; ++frame) {
        static_cast<void>(next(surfaces(0)));
        CHECK(kept.report().refined == frame);
    }
}

TEST_CASE_FIXTURE(HostTexturesTests, "what was drawn between rounded corners does not hide itself") {
    configuration.indirect = false;
    const Picture expected = from(surfaces(1));
    // As far behind where it is as GPUs put a surface at most, which round corners to 1/256 of a pixel. Depth
    // is linear in the window, and larger where it is nearer.
    const std::vector<glm::vec4> exact = depth_texels;
    const auto step = [&](std::size_t i, std::size_t next) {
        const bool same_face = next < exact.size() && normal_texels[next] == normal_texels[i];
        return same_face ? std::abs(exact[next].r - exact[i].r) : 0.0F;
    };
    for (std::size_t i = 0; i < exact.size(); ++i) {
        depth_texels[i].r -=
            (std::max(step(i, i - 1), step(i, i + 1)) + std::max(step(i, i - size.x), step(i, i + size.x))) /
            512.0F;
    }
    depth->fill(depth_texels);
    // What hides itself is dark: an error of about 1. Edges of shadows move by 1/360 of a pixel.
    CHECK(relative_mean_square(from(surfaces(2)), expected) < 1e-3);
}

TEST_CASE_FIXTURE(HostTexturesTests, "verification finds a revision that should have changed") {
    kept.verify(true);
    static_cast<void>(next(surfaces(1)));
    CHECK_NOTHROW(static_cast<void>(next(surfaces(1))));
    darken_albedo();
    CHECK(throws<GraphError>([&] { static_cast<void>(next(surfaces(1))); }, "host-surfaces"));
}

TEST_CASE_FIXTURE(HostTexturesTests, "a texture that cannot hold what it is said to is one clear error") {
    const Picture before = next(surfaces(1));
    const auto refuse = [&](const HostSurfaces& faulty, const char* why) {
        CHECK(throws<gl::GlError>([&] { static_cast<void>(next(faulty)); }, why));
        CHECK(next(surfaces(1)) == before);
        CHECK(passes_that_ran() == only_copy);
    };
    const auto with = [&](std::uint32_t HostSurfaces::*texture, GLuint name) {
        HostSurfaces faulty = surfaces(1);
        faulty.*texture = name;
        return faulty;
    };
    refuse(with(&HostSurfaces::depth, 4711), "the host's depth, texture 4711, does not exist");
    refuse(with(&HostSurfaces::depth, normal->name()),
           "has neither a depth format nor one with a single channel of numbers from 0 to 1");
    refuse(with(&HostSurfaces::normal, depth->name()), "has 1 of the 3 channels that are read");
    refuse(with(&HostSurfaces::material, depth->name()), "the host's material");
    const gl::Texture bytes(device, "host's", {.size = size, .format = Format::rgba8});
    refuse(with(&HostSurfaces::normal, bytes.name()), "cannot hold values below 0");
    HostSurfaces octahedral = with(&HostSurfaces::normal, bytes.name());
    octahedral.normal_encoding = NormalEncoding::octahedral;
    refuse(octahedral, "cannot hold values below 0");
    const gl::Texture curved(device, "host's", {.size = size, .format = Format::srgb8_alpha8});
    HostSurfaces of_bytes = with(&HostSurfaces::normal, curved.name());
    of_bytes.normal_encoding = NormalEncoding::unsigned_xyz;
    refuse(of_bytes, "is read with an sRGB curve");
    const gl::Texture numbers(device, "host's", {.size = size, .format = Format::r32ui});
    refuse(with(&HostSurfaces::albedo, numbers.name()), "holds integers");
    refuse(with(&HostSurfaces::depth, numbers.name()), "single channel of numbers from 0 to 1");
    const gl::Texture depths(device, "host's", {.size = size, .format = Format::depth32f});
    refuse(with(&HostSurfaces::albedo, depths.name()), "holds depth");
    const gl::Texture small(device, "host's", {.size = size / 2U, .format = Format::rgba32f});
    refuse(with(&HostSurfaces::albedo, small.name()), "has 24 × 18 pixels instead of 48 × 36");
    const gl::Texture layers(
        device, "host's",
        {.size = size, .format = Format::rgba32f, .shape = TextureShape::array, .layers = 2});
    refuse(with(&HostSurfaces::normal, layers.name()), "is not a 2D texture");

    const gl::Functions& gl = device.gl();
    std::array<GLuint, 2> made{};
    gl.CreateTextures(GL_TEXTURE_2D, 2, made.data());
    refuse(with(&HostSurfaces::albedo, made[0]), "has no storage");
    gl.TextureStorage2D(made[1], 1, GL_R11F_G11F_B10F, size.x, size.y);
    refuse(with(&HostSurfaces::normal, made[1]), "cannot hold values below 0");
    gl.DeleteTextures(2, made.data());
}

TEST_CASE_FIXTURE(HostTexturesTests,
                  "a checked renderer finds surfaces in other conventions than it is told") {
    // Turned by 49 degrees, so that normals in view space are not like those in world space.
    scene.world.set(scene.camera, looking({3.4F, 2.2F, 2.9F}, {0, 1, 0}));
    static_cast<void>(usual());
    const FrameResults results = renderer.results();
    const Camera camera = scene.world.get<Camera>(scene.camera);
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const glm::mat4 projection = glm::perspectiveNO(camera.vertical_fov, aspect, 0.5F, 20.0F);
    const glm::mat3 view_from_world(results.view.view_from_world);
    depth_texels = depths(device.gl(), results.depth);
    normal_texels = texels(device.gl(), results.normal);
    std::vector<glm::vec4> view_normals;
    std::vector<glm::vec4> unsigned_normals;
    for (std::size_t i = 0; i < depth_texels.size(); ++i) {
        const float own = depth_texels[i].x;  // near / distance: the camera has no far plane
        const glm::vec4 clip = projection * glm::vec4(0.0F, 0.0F, -camera.near_plane / own, 1.0F);
        depth_texels[i].x = own > 0.0F ? 0.5F * clip.z / clip.w + 0.5F : 1.0F;
        const glm::vec3 direction = decoded_normal(normal_texels[i]);
        normal_texels[i] = glm::vec4(direction, 0.0F);
        view_normals.emplace_back(view_from_world * direction, 0.0F);
        unsigned_normals.emplace_back(0.5F * direction + 0.5F, 0.0F);
    }
    depth->fill(depth_texels);
    normal->fill(normal_texels);
    albedo->fill(texels(device.gl(), results.albedo));
    const HostTexture in_view(device, view_normals, Format::rgba32f);
    const HostTexture without_sign(device, unsigned_normals, Format::rgba32f);
    conventions = {.clip_from_view = projection};

    TestedRenderer checked(context->get_proc(), {.checked = true});
    REQUIRE(checked.configure(configuration).empty());
    const auto look = [&](const HostSurfaces& seen) {
        const RenderView view = view_of(seen);
        checked.render(scene.world, {&view, 1});
        return to.read();
    };
    const auto refuse = [&](const HostSurfaces& faulty, const char* why) {
        CHECK(throws<SceneError>([&] { static_cast<void>(look(faulty)); }, why));
    };
    const HostSurfaces right = surfaces(1);
    const Picture expected = look(right);
    CHECK(expected == from(right));
    CHECK(look(right) == expected);
    for (const PassRecord& pass : checked.last_passes()) CHECK(pass.ran == (pass.name == "tone-map"));

    constexpr const char* elsewhere = "the world has no surface near the one that the host's depth tells";
    HostSurfaces faulty = right;
    faulty.clip_depth_from_0 = true;
    refuse(faulty, elsewhere);
    faulty = right;
    faulty.clip_from_view = glm::perspectiveZO(camera.vertical_fov, aspect, 0.5F, 20.0F);
    refuse(faulty, elsewhere);
    faulty.clip_from_view = glm::perspectiveNO(camera.vertical_fov, aspect, 0.1F, 100.0F);
    refuse(faulty, elsewhere);
    faulty = right;
    for (glm::vec4& texel : depth_texels) texel.x = 1.0F - texel.x;  // reversed, which the host does not say
    depth->fill(depth_texels);
    faulty.revision = 2;
    refuse(faulty, elsewhere);
    for (glm::vec4& texel : depth_texels) texel.x = 1.0F - texel.x;
    depth->fill(depth_texels);

    constexpr const char* turned = "the host's normal is not that of the surface";
    faulty = right;
    faulty.normal = in_view.name();
    refuse(faulty, turned);
    faulty.world_from_normal = glm::transpose(view_from_world);
    CHECK(relative_mean_square(look(faulty), expected) < rounding);
    faulty = right;
    faulty.normal = without_sign.name();
    refuse(faulty, turned);
    faulty.normal_encoding = NormalEncoding::unsigned_xyz;
    CHECK(relative_mean_square(look(faulty), expected) < rounding);

    const Transform pose = scene.world.get<Transform>(scene.camera);
    scene.world.set(scene.camera, looking({0, 1, 3}, {0, 1, 0}));
    refuse(right, elsewhere);
    scene.world.set(scene.camera, pose);
    CHECK(look(right) == expected);
    std::vector<Entity> entities;
    for (const auto& [entity, instance] : scene.world.view<MeshInstance>()) entities.push_back(entity);
    for (const Entity entity : entities) scene.world.remove<MeshInstance>(entity);
    refuse(right, elsewhere);
}

TEST_CASE_FIXTURE(HostTexturesTests,
                  "what only the host draws passes the check, and so does an empty picture") {
    TestedRenderer checked(context->get_proc(), {.checked = true});
    REQUIRE(checked.configure(configuration).empty());
    const auto look = [&] {
        const RenderView view = view_of(surfaces(0));
        checked.render(scene.world, {&view, 1});
    };
    // Something nearer in a third of the picture, such as leaves.
    std::vector<glm::vec4> with_leaves = depth_texels;
    for (std::size_t i = 0; i < with_leaves.size(); ++i) {
        if (i % 3 == 0) with_leaves[i].x *= 1.5F;
    }
    depth->fill(with_leaves);
    CHECK_NOTHROW(look());
    depth->fill(std::vector(with_leaves.size(), glm::vec4(0.0F)));
    CHECK_NOTHROW(look());
}

}  // TEST_SUITE("host surfaces")
