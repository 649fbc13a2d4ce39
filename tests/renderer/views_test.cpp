// Several views in one frame.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "renderer/passes/view/view.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("views") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{48, 36};

Configuration small_configuration(ShadingPath path = ShadingPath::deferred) {
    Configuration configuration = linear_configuration(path);
    configuration.vpls.count = 64;
    configuration.shadows = {.cube_resolution = 64, .map_resolution = 64};
    return configuration;
}

class ViewsTests : public RenderFixture {
 protected:
    ViewsTests() {
        other_camera = add(scene.world, looking({0.6F, 0.4F, 1.9F}, {0, 1, 0}), Camera{.vertical_fov = 1.0F});
    }

    void render_both(Entity first_camera, Entity second_camera) {
        const std::vector<RenderView> views{{.camera = first_camera, .target = first.target()},
                                            {.camera = second_camera, .target = second.target()}};
        renderer.render(scene.world, views);
    }

    /// Number of passes of the last frame whose names begin like this.
    [[nodiscard]] std::ptrdiff_t count_passes(std::string_view name) const {
        return std::ranges::count_if(renderer.last_passes(), [&](const PassRecord& pass) {
            return pass.name == name || pass.name.starts_with(std::string(name) + " ");
        });
    }

    Scene scene = cornell_box();
    Entity other_camera;
    RenderTarget first{device, size};
    RenderTarget second{device, size};
};

}  // namespace

TEST_CASE("jitter moves the samples off the pixel centres, right and up") {
    const glm::vec2 jitter(0.25F, -0.5F);
    const CameraView view = make_view({.vertical_fov = 1.0F}, glm::mat4(1.0F), size, jitter);
    // A point on the ray through the sample of pixel (7, 21), of a camera that looks along -Z.
    const glm::vec2 centre(7.5F, 21.5F);
    const glm::vec2 half_extent = std::tan(0.5F) * glm::vec2(4.0F / 3.0F, 1.0F);
    const glm::vec2 place = half_extent * (2.0F * (centre + jitter) / glm::vec2(size) - 1.0F);
    const glm::vec4 clip = view.clip_from_world * glm::vec4(5.0F * place, -5.0F, 1.0F);
    const glm::vec2 pixel = (0.5F * glm::vec2(clip) / clip.w + 0.5F) * glm::vec2(size);
    // Floats of up to 48 pixels.
    CHECK(glm::length(pixel - centre) < 1e-4F);
}

TEST_CASE_FIXTURE(ViewsTests, "equal cameras give equal pictures, with the scene's work done once") {
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configure(small_configuration(path));
        render_both(scene.camera, scene.camera);
        CHECK(mean(first.read()) > 0.01);
        CHECK(first.read() == second.read());
    }
    for (const char* shared :
         {"surfels", "surfel-light", "surfel-bounce", "shadow-maps", "scene-upload", "bvh"}) {
        CAPTURE(shared);
        CHECK(count_passes(shared) == 1);
    }
    CHECK(count_passes("tone-map") == 2);
}

TEST_CASE_FIXTURE(ViewsTests, "each view shows what a frame of its own would show") {
    configure(small_configuration(ShadingPath::forward_plus));
    render_both(scene.camera, other_camera);
    CHECK(first.read() == from_scratch(scene, size));
    CHECK(second.read() == from_scratch({scene.world, other_camera, scene.light}, size));
    CHECK(first.read() != second.read());
}

TEST_CASE_FIXTURE(ViewsTests, "a budget that is exceeded while a light moves lowers all views alike") {
    Configuration configuration = small_configuration();
    configuration.frame_budget_ms = 0.01F;
    configure(configuration);
    for (int frame = 0; frame < 4; ++frame) {
        scene.world.edit<Transform>(scene.light, [](Transform& pose) { pose.translation.x += 0.05F; });
        render_both(scene.camera, scene.camera);
        static_cast<void>(renderer.take_frames(true));
        CHECK(first.read() == second.read());
    }
    CHECK(renderer.quality().scale < 1.0F);
}

TEST_CASE_FIXTURE(ViewsTests, "a view refines while another one moves") {
    Configuration configuration = small_configuration();
    configuration.refinement = {.enabled = true, .frames = 64};
    configure(configuration);
    TestedRenderer alone(context->get_proc());
    REQUIRE(alone.configure(configuration).empty());
    const RenderTarget target(device, size);
    for (std::uint32_t frame = 0; frame < 10; ++frame) {
        scene.world.edit<Transform>(other_camera, [](Transform& pose) { pose.translation.x += 0.01F; });
        render_both(scene.camera, other_camera);
        alone.render(scene.world, scene.camera, target.target());
        CHECK(renderer.report(0).refined == frame + 1);
        CHECK(renderer.report(1).refined == 1);
        CHECK(first.read() == target.read());
    }
    CHECK_THROWS_AS(static_cast<void>(renderer.report(2)), GraphError);
    SUBCASE("and starts over when the scene changes") {
        scene.world.edit<PointLight>(scene.light, [](PointLight& light) { light.intensity *= 2.0F; });
        render_both(scene.camera, other_camera);
        CHECK(renderer.report(0).refined == 1);
        CHECK(renderer.report(1).refined == 1);
    }
}

TEST_CASE_FIXTURE(ViewsTests, "views come and go") {
    configure(small_configuration());
    const Picture usual = render(scene, size);
    render_both(other_camera, scene.camera);
    CHECK(second.read() == usual);
    CHECK_FALSE(ran("surfels"));
    CHECK(render(scene, size) == usual);
    CHECK_THROWS_AS(renderer.render(scene.world, std::vector<RenderView>{}), gl::GlError);
    CHECK(render(scene, size) == usual);
}

TEST_CASE_FIXTURE(ViewsTests, "views share a framebuffer, each in its rectangle") {
    configure(small_configuration());
    const Picture left = render(scene.world, scene.camera, size);
    const Picture right = render(scene.world, other_camera, size);
    const glm::uvec2 all(2 * size.x + 6, size.y + 4);
    const RenderTarget wide(device, all);
    const std::uint32_t name = wide.target().framebuffer;
    const std::vector<RenderView> views{{.camera = scene.camera, .target = {name, size, {1, 2}}},
                                        {.camera = other_camera, .target = {name, size, {size.x + 4, 3}}}};
    renderer.render(scene.world, views);
    const Picture both = wide.read();
    for (std::uint32_t y = 0; y < all.y; ++y) {
        for (std::uint32_t x = 0; x < all.x; ++x) {
            const glm::uvec2 on_left(x - 1, y - 2);
            const glm::uvec2 on_right(x - size.x - 4, y - 3);
            glm::vec3 expected(0.0F);  // of the target, untouched
            if (on_left.x < size.x && on_left.y < size.y) {
                expected = left.at(on_left.x, on_left.y);
            } else if (on_right.x < size.x && on_right.y < size.y) {
                expected = right.at(on_right.x, on_right.y);
            }
            CHECK(both.at(x, y) == expected);
        }
    }
}

TEST_CASE_FIXTURE(ViewsTests, "a matrix of the host's is a camera like others") {
    configure(small_configuration());
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    Camera camera = scene.world.get<Camera>(scene.camera);
    const Picture perspective = render(scene, size);
    camera.matrix = glm::perspective(camera.vertical_fov, aspect, 0.1F, 7.0F);
    camera.projection = Camera::Projection::custom;
    scene.world.set(scene.camera, camera);
    // The same matrix up to rounding, which may move an edge by a ten-thousandth of a pixel.
    CHECK(relative_mean_square(render(scene, size), perspective) < 1e-6);

    camera = {.projection = Camera::Projection::orthographic, .half_height = 0.9F, .far_plane = 9.0F};
    scene.world.set(scene.camera, camera);
    const Picture orthographic = render(scene, size);
    camera.matrix = glm::ortho(-0.9F * aspect, 0.9F * aspect, -0.9F, 0.9F, 1.0F, 2.0F);
    camera.projection = Camera::Projection::custom;
    scene.world.set(scene.camera, camera);
    CHECK(relative_mean_square(render(scene, size), orthographic) < 1e-6);
}

TEST_CASE_FIXTURE(ViewsTests, "tiles of a picture, by shifted projections, fit together") {
    for (const ShadingPath path : {ShadingPath::forward_plus, ShadingPath::clustered_deferred}) {
        configure(small_configuration(path));
        // Seen at a slant, so that no edge passes exactly through the centres of pixels.
        scene.world.set(scene.camera, looking({0.31F, 1.17F, 3.3F}, {0.03F, 0.9F, 0}));
        const Picture whole = render(scene, size);
        Scene tile{scene.world, scene.camera, scene.light};
        Camera camera = tile.world.get<Camera>(tile.camera);
        const float top = 0.1F * std::tan(camera.vertical_fov / 2.0F);
        const float right = top * static_cast<float>(size.x) / static_cast<float>(size.y);
        camera.projection = Camera::Projection::custom;
        camera.matrix = glm::frustum(0.0F, right, -top, 0.0F, 0.1F, 10.0F);  // the lower right quarter
        tile.world.set(tile.camera, camera);
        const glm::uvec2 half = size / 2U;
        const Picture quarter = render(tile.world, tile.camera, half);
        Picture expected{half, {}};
        for (std::uint32_t y = 0; y < half.y; ++y) {
            for (std::uint32_t x = 0; x < half.x; ++x) {
                expected.pixels.push_back(whole.at(half.x + x, y));
            }
        }
        CHECK(relative_mean_square(quarter, expected) < 1e-6);  // rounding, as above
    }
}

}  // TEST_SUITE("views")
