// What a view leaves for the host after a frame.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include <candela/extension.hpp>

#include "renderer/facade/device_of.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/texels.hpp"

TEST_SUITE("results") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{40, 30};
constexpr FrameParts all_parts{
    .depth = true, .normal = true, .albedo = true, .indirect = true, .radiance = true, .vpls = true};

class ResultTests : public RenderFixture {
 protected:
    template <class T>
    [[nodiscard]] std::vector<T> read(const ResultBuffer& result) {
        std::vector<T> structs(result.count);
        gl.GetNamedBufferSubData(result.buffer, 0, static_cast<GLsizeiptr>(structs.size() * sizeof(T)),
                                 structs.data());
        return structs;
    }

    void render(const Scene& scene, const FrameParts& keep) {
        const RenderView view{.camera = scene.camera, .target = target.target(), .keep = keep};
        renderer.render(scene.world, {&view, 1});
    }

    RenderTarget target{device, size};
    const gl::Functions& gl = device.gl();
};

}  // namespace

TEST_CASE_FIXTURE(ResultTests, "depth, normals and albedo of a plane are those of its closed form") {
    Scene scene = ground();
    scene.world.set(scene.light, at({0, 1, 0}));
    scene.world.set(scene.light, PointLight{});
    const float near = scene.world.get<Camera>(scene.camera).near_plane;
    const Transform pose = scene.world.get<Transform>(scene.camera);
    const glm::dvec3 forward(pose.rotation * glm::vec3(0, 0, -1));
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configure(linear_configuration(path));
        render(scene, all_parts);
        const FrameResults results = renderer.results();
        const std::vector<glm::vec4> depth = depths(gl, results.depth);
        const std::vector<glm::vec4> normal = texels(gl, results.normal);
        const std::vector<glm::vec4> albedo = texels(gl, results.albedo);
        REQUIRE(depth.size() == size.x * size.y);
        double worst = 0.0;
        for (std::uint32_t i = 0; i < depth.size(); ++i) {
            double least = 1.0, most = 0.0;
            for (const glm::dvec2 beside : corner_rounding) {
                const PixelRay ray = pixel_ray(scene.world.get<Camera>(scene.camera), pose, size, i % size.x,
                                               i / size.x, beside);
                const double t = -ray.origin.y / ray.direction.y;
                const double expected = near / (t * glm::dot(ray.direction, forward));
                least = std::min(least, expected);
                most = std::max(most, expected);
            }
            const auto seen = static_cast<double>(depth[i].r);
            worst = std::max(worst, std::abs(std::clamp(seen, least, most) / seen - 1.0));
            // (0, 1, 0) and 0.5 are stored exactly.
            CHECK(normal[i].x == 0.0F);
            CHECK(normal[i].y == 1.0F);
            CHECK(albedo[i].r == 0.5F);
        }
        CHECK(worst < 1e-5);  // some hundred roundings of floats
    }
}

TEST_CASE_FIXTURE(ResultTests, "radiance is what an untouched target shows") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configuration.path = path;
        configure(configuration);
        render(scene, {.radiance = true});
        CHECK(picture_of(gl, renderer.results().radiance) == target.read());
    }
}

TEST_CASE_FIXTURE(ResultTests, "albedo times indirect light is the indirect radiance") {
    const Scene scene = cornell_box();
    for (const Interleave interleave : {Interleave::one, Interleave::two}) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::indirect;
        configuration.interleave = interleave;
        configure(configuration);
        render(scene, all_parts);
        const FrameResults results = renderer.results();
        const std::vector<glm::vec4> albedo = texels(gl, results.albedo);
        const std::vector<glm::vec4> indirect = texels(gl, results.indirect);
        const std::vector<glm::vec4> radiance = texels(gl, results.radiance);
        constexpr double pi = 3.14159265358979;
        for (std::size_t i = 0; i < albedo.size(); ++i) {
            for (int channel = 0; channel < 3; ++channel) {
                const double expected = static_cast<double>(albedo[i][channel]) *
                                        static_cast<double>(indirect[i][channel]) / (pi * pi);
                // A few roundings of floats.
                CHECK(static_cast<double>(radiance[i][channel]) == doctest::Approx(expected).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE_FIXTURE(ResultTests, "the VPLs are records as glsl_types describes them") {
    const Scene scene = cornell_box();
    const auto check = [](const auto& vpl) {
        CHECK(glm::length(vpl.normal) == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(vpl.flux.x >= 0.0F);
    };
    Configuration configuration = linear_configuration();
    configuration.vpls.placement = VplPlacement::surfels;
    configure(configuration);
    render(scene, {.vpls = true});
    const FrameResults surfels = renderer.results();
    REQUIRE(surfels.lit_surfels.count > 0);
    CHECK(surfels.traced_vpls.buffer == 0);
    for (const auto& surfel : read<gpu::LitSurfel>(surfels.lit_surfels)) check(surfel);

    configuration.vpls.placement = VplPlacement::paths;
    configure(configuration);
    render(scene, {.vpls = true});
    const FrameResults paths = renderer.results();
    REQUIRE(paths.traced_vpls.count > 0);
    CHECK(paths.lit_surfels.buffer == 0);
    for (const auto& vpl : read<gpu::TracedVpl>(paths.traced_vpls)) {
        if (vpl.state == VPL_PLACED) check(vpl);
    }
    for (const char* const name : {"TracedVpl", "LitSurfel", "LitEmitter", "SkyPatch"}) {
        CHECK(glsl_types().find("struct " + std::string(name) + " {") != std::string_view::npos);
    }
}

TEST_CASE_FIXTURE(ResultTests, "surfels that emit light and patches of the sky have buffers of their own") {
    constexpr float half = 0.3F;
    constexpr double radiance = 2.0;
    Scene scene = ground();
    add(scene.world, upside_down_at({0, 1, 0}),
        MeshInstance{square(half, emitter(glm::vec3(static_cast<float>(radiance))))});
    add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    Configuration configuration = linear_configuration();
    configuration.show = Show::direct;
    configure(configuration);
    render(scene, {.vpls = true});
    const FrameResults results = renderer.results();
    REQUIRE(results.lit_surfels.count > 0);
    for (const auto& surfel : read<gpu::LitSurfel>(results.lit_surfels)) {
        CHECK(surfel.position.y == doctest::Approx(0.0).scale(1.0));
        CHECK(surfel.flux == glm::vec3(0.0F));  // reflected light is not shown
    }
    double flux = 0.0;
    for (const auto& emitter : read<gpu::LitEmitter>(results.lit_emitters)) {
        CHECK(emitter.position.y == doctest::Approx(1.0));
        CHECK(emitter.normal.y == doctest::Approx(-1.0));
        flux += static_cast<double>(emitter.flux.r);
    }
    const double side = 2.0 * static_cast<double>(half);
    CHECK(flux == doctest::Approx(3.14159265 * radiance * side * side).epsilon(1e-3));
    REQUIRE(results.sky_patches.count > 0);
    for (const auto& patch : read<gpu::SkyPatch>(results.sky_patches)) {
        CHECK(glm::length(patch.direction) == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(patch.light.r > 0.0F);
    }

    configuration.show = Show::indirect;  // the light of the sky is direct
    configure(configuration);
    render(scene, {.vpls = true});
    CHECK(renderer.results().sky_patches.buffer == 0);
    CHECK(renderer.results().lit_emitters.count == results.lit_emitters.count);
}

TEST_CASE_FIXTURE(ResultTests, "VPLs of a spot are spread over its disc, down to the narrowest cone") {
    constexpr float height = 2.0F;
    Scene scene = ground();
    scene.world.set(scene.light, looking({0, height, 0}, {0, 0, 0}, {0, 0, 1}));
    Configuration configuration = linear_configuration();
    configuration.vpls = {.placement = VplPlacement::paths, .count = 1024, .bounces = 1};
    configure(configuration);
    for (const float cone : {0.1F, 1e-3F, 1e-4F}) {
        CAPTURE(cone);
        scene.world.set(scene.light, SpotLight{.inner_cone = 0.0F, .outer_cone = cone});
        render(scene, {.vpls = true});
        const auto all = read<gpu::TracedVpl>(renderer.results().traced_vpls);
        REQUIRE(all.size() > 1000);
        const double radius = static_cast<double>(height) * std::tan(static_cast<double>(cone));
        double squares = 0.0, largest = 0.0;
        for (const gpu::TracedVpl& vpl : all) {
            const double x = vpl.position.x, z = vpl.position.z;
            squares += (x * x + z * z) / (radius * radius * static_cast<double>(all.size()));
            largest = std::max(largest, std::hypot(x, z) / radius);
        }
        // The density over x = 1 - cos is 3 (1 - x/xₒ)² / xₒ, of mean xₒ / 4, and the squared distance
        // from the axis grows like x. Directions are rounded by 6e-8, which is 6e-4 of the narrowest
        // cone; 1,024 low-discrepancy points estimate the mean to better than a percent.
        CHECK(squares == doctest::Approx(0.25).epsilon(0.01));
        CHECK(largest < 1.001);
    }
}

TEST_CASE_FIXTURE(ResultTests, "only what was asked for is there") {
    const Scene scene = cornell_box();
    configure(linear_configuration(ShadingPath::forward));
    CHECK_THROWS_AS(static_cast<void>(renderer.results(1)), GraphError);
    render(scene, {.depth = true});
    CHECK(renderer.results().depth.texture != 0);
    CHECK(renderer.results().normal.texture == 0);
    CHECK(renderer.results().radiance.texture == 0);
    CHECK(renderer.results().lit_surfels.buffer == 0);
    Configuration direct = linear_configuration();
    direct.indirect = false;
    configure(direct);
    render(scene, all_parts);
    CHECK(renderer.results().indirect.texture == 0);
    CHECK(renderer.results().lit_surfels.count == 0);
    CHECK(renderer.results().radiance.texture != 0);
}

TEST_CASE_FIXTURE(ResultTests, "results stay while nothing changes, and are not redrawn") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    render(scene, all_parts);
    const std::vector<glm::vec4> albedo = texels(gl, renderer.results().albedo);
    const std::vector<glm::vec4> radiance = texels(gl, renderer.results().radiance);
    for (int frame = 0; frame < 3; ++frame) {
        render(scene, all_parts);
        CHECK_FALSE(ran("gbuffer"));
        CHECK_FALSE(ran("deferred"));
    }
    CHECK(texels(gl, renderer.results().albedo) == albedo);
    CHECK(texels(gl, renderer.results().radiance) == radiance);
}

TEST_CASE_FIXTURE(ResultTests, "a floating-point target stores radiance and coverage") {
    Scene scene = cornell_box();
    scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.z += 3.0F; });
    configure(linear_configuration());
    gl::Texture colour(device, "host's", {size, Format::rgba16f});
    gl::Framebuffer framebuffer(device, "host's");
    framebuffer.attach_colour(0, colour.name());
    framebuffer.draw_buffers(1);
    const RenderView view{.camera = scene.camera, .target = {framebuffer.name(), size}};
    renderer.render(scene.world, {&view, 1});
    render(scene, all_parts);
    const std::vector<glm::vec4> exact = texels(gl, renderer.results().radiance);
    const std::vector<glm::vec4> depth = depths(gl, renderer.results().depth);
    const std::vector<float> halves = colour.read_floats();
    std::size_t empty = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        // Half floats have 11 significant bits; drivers may round them down.
        CHECK(halves[4 * i] == doctest::Approx(exact[i].r).epsilon(std::exp2(-10)).scale(1e-3));
        CHECK(halves[4 * i + 3] == (depth[i].r > 0.0F ? 1.0F : 0.0F));
        empty += depth[i].r > 0.0F ? 0 : 1;
    }
    CHECK(empty > 0);
    CHECK(empty < exact.size());
}

TEST_CASE_FIXTURE(ResultTests, "without the curve, the exposure still scales radiance") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configure(configuration);
    render(scene, {});
    const Picture usual = target.read();
    configuration.tone_map.exposure_ev = 1.0F;
    configure(configuration);
    render(scene, {});
    const Picture brighter = target.read();
    for (std::size_t i = 0; i < usual.pixels.size(); ++i) {
        CHECK(brighter.pixels[i] == 2.0F * usual.pixels[i]);
    }
}

TEST_CASE_FIXTURE(ResultTests, "a texture on the GPU is tone-mapped like a frame") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.tone_map = {.enabled = true, .exposure_ev = 0.5F};
    configure(configuration);
    render(scene, {.radiance = true});
    const Picture frame = target.read();
    const RenderTarget other(device, size);
    renderer.tone_map(renderer.results().radiance.texture, other.target());
    CHECK(other.read() == frame);
    CHECK(mean(frame) > 0.01);
}

}  // TEST_SUITE("results")
