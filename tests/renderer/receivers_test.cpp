// Light at places of the host's.

#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include <candela/scene/scene_error.hpp>
#include "renderer/facade/device_of.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/texels.hpp"
#include "tests/throws.hpp"

TEST_SUITE("receivers") {

using namespace candela;

namespace {

constexpr glm::vec3 up{0.0F, 1.0F, 0.0F};

class ReceiverTests : public RenderFixture {
 protected:
    void light(const Scene& scene, const std::vector<Receiver>& receivers, glm::uvec2 size = {16, 16}) {
        renderer.set_receivers(receivers);
        (void)render(scene, size);
        received = renderer.received_light();
        REQUIRE(received.size() == receivers.size());
    }

    std::vector<glm::vec3> received;
};

/// More receivers than a work group has, along a line above the ground.
std::vector<Receiver> line_of_receivers() {
    std::vector<Receiver> receivers;
    for (int i = 0; i < 40; ++i) {
        receivers.push_back({.position = {-2.0F + 0.1F * static_cast<float>(i), 0.5F, 0.3F}, .normal = up});
    }
    return receivers;
}

double worst_difference(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& expected) {
    return worst_error({{found.size(), 1}, found}, {{expected.size(), 1}, expected}, 1e-6);
}

}  // namespace

TEST_CASE_FIXTURE(ReceiverTests, "a point light gives I cos θ / r², a directional one E cos θ") {
    Scene scene = ground();
    constexpr glm::vec3 from{0.4F, 2.0F, -0.2F};
    scene.world.set(scene.light, at(from));
    scene.world.set(scene.light, PointLight{.intensity = 7.0F});
    const Transform aslant = looking({0, 0, 0}, {1, -2, 0.5F});
    add(scene.world, aslant, DirectionalLight{.illuminance = 3.0F});
    const glm::vec3 to_sun = aslant.rotation * glm::vec3(0, 0, 1);
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const std::vector<Receiver> receivers = line_of_receivers();
    light(scene, receivers);
    std::vector<glm::vec3> expected;
    for (const Receiver& receiver : receivers) {
        const glm::dvec3 apart(from - receiver.position);
        const double r = glm::length(apart);
        const double of_point = 7.0 * apart.y / (r * r * r);
        expected.emplace_back(static_cast<float>(of_point + 3.0 * static_cast<double>(to_sun.y)));
    }
    CHECK(worst_difference(received, expected) < 1e-5);  // some ten roundings of floats
    SUBCASE("not from behind, nor from below the ground") {
        light(scene, {{.position = {0, 0.5F, 0}, .normal = -up}, {.position = {0, -0.5F, 0}, .normal = up}});
        CHECK(received == std::vector<glm::vec3>(2));
    }
}

TEST_CASE_FIXTURE(ReceiverTests, "a uniform sky gives π L above, and half of it beside, a dark ground") {
    Scene scene = ground();
    Environment sky;
    sky.radiance = {0.5F, 1.0F, 2.0F};
    scene.world.set(scene.light, sky);
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configuration.visibility.method = VplVisibility::rays;
    configure(configuration);
    // 1 mm above the middle of a ground of 8 m, less than 0.1 % of the lower half is not hidden by it.
    light(scene,
          {{.position = {0, 0.001F, 0}, .normal = up}, {.position = {0, 0.001F, 0}, .normal = {1, 0, 0}}});
    const glm::vec3 above = std::numbers::pi_v<float> * sky.radiance;
    // The sky is a few hundred patches, each hidden as a whole: along the horizon, some percent.
    CHECK(worst_difference(received, {above, 0.5F * above}) < 0.05);
}

TEST_CASE_FIXTURE(ReceiverTests, "receivers on surfaces get what the pixels there show") {
    const Scene scene = cornell_box();
    constexpr glm::uvec2 pixels{24, 24};
    RenderTarget target(device, pixels);
    for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
        for (const VplVisibility method : {VplVisibility::none, VplVisibility::rays, VplVisibility::maps}) {
            CAPTURE(static_cast<int>(placement));
            CAPTURE(static_cast<int>(method));
            Configuration configuration = linear_configuration();
            configuration.show = Show::irradiance;
            configuration.shadows.enabled = false;
            configuration.interleave = Interleave::one;
            configuration.vpls.placement = placement;
            configuration.visibility.method = method;
            configure(configuration);
            renderer.set_receivers({});
            const RenderView view{
                .camera = scene.camera, .target = target.target(), .keep = {.depth = true, .normal = true}};
            renderer.render(scene.world, {&view, 1});
            const Picture shown = target.read();
            const FrameResults results = renderer.results();
            const std::vector<glm::vec4> depth = depths(device.gl(), results.depth);
            const std::vector<glm::vec4> normals = texels(device.gl(), results.normal);
            std::vector<Receiver> receivers;
            std::vector<glm::vec3> expected;
            for (std::uint32_t i = 0; i < depth.size(); ++i) {
                if (depth[i].r == 0.0F) continue;
                const auto position = [&](float across) {
                    const glm::vec2 place(static_cast<float>(i % pixels.x) + across, i / pixels.x);
                    const glm::vec2 clip = (place + 0.5F) / glm::vec2(pixels) * 2.0F - 1.0F;
                    const glm::vec4 world = results.view.world_from_clip * glm::vec4(clip, depth[i].r, 1.0F);
                    return glm::vec3(world) / world.w;
                };
                const glm::vec3 normal = decoded_normal(glm::vec2(normals[i]));
                // See Receiver::position.
                const float pixel = glm::distance(position(0.0F), position(1.0F));
                const float above = method == VplVisibility::none ? 0.0F : pixel / 256.0F;
                receivers.push_back({.position = position(0.0F) + above * normal, .normal = normal});
                expected.push_back(std::numbers::pi_v<float> * shown.pixels[i]);  // radiance of white
            }
            REQUIRE(receivers.size() > 300);
            light(scene, receivers, pixels);  // surfels depend on the view
            if (method == VplVisibility::none) {
                CHECK(worst_difference(received, expected) < path_tolerance);
            }
            // Visibility of a pixel is judged 1/32 of its width nearer to the viewer: at a tenth of the
            // pixels, another one of the 32 VPLs, with up to a fifth of the light, is hidden.
            const auto count = static_cast<std::uint32_t>(expected.size());
            CHECK(relative_mean_square({{count, 1}, received}, {{count, 1}, expected}) < 5e-3);
        }
    }
}

TEST_CASE_FIXTURE(ReceiverTests, "they are lit again only when their light may have changed") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    light(scene, line_of_receivers());
    CHECK(ran("receiver-light"));
    const std::vector<glm::vec3> before = received;
    light(scene, line_of_receivers());
    CHECK_FALSE(ran("receivers"));
    CHECK_FALSE(ran("receiver-light"));
    CHECK(received == before);
    scene.world.set(scene.camera, looking({0.1F, 1, 3}, {0, 1, 0}));
    light(scene, line_of_receivers());
    CHECK_FALSE(ran("receivers"));
    const Entity lamp = add(scene.world, at({0.1F, 1.5F, 0.1F}), PointLight{.intensity = 5.0F});
    light(scene, line_of_receivers());
    CHECK(ran("receiver-light"));
    CHECK(received != before);
    scene.world.destroy(lamp);
    light(scene, line_of_receivers());
    CHECK(received == before);
    light(scene, {line_of_receivers().front()});
    CHECK(ran("receivers"));
    CHECK(received.front() == before.front());
}

TEST_CASE_FIXTURE(ReceiverTests, "none are lit where no light is shown, or after they are gone") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.show = Show::albedo;
    configure(configuration);
    light(scene, line_of_receivers());
    CHECK(received == std::vector<glm::vec3>(received.size()));
    renderer.set_receivers({});
    (void)render(scene, {16, 16});
    CHECK(renderer.received_light().empty());
    CHECK(renderer.received_light_buffer().buffer == 0);
}

TEST_CASE_FIXTURE(ReceiverTests, "impossible receivers are named and change nothing") {
    const std::vector<Receiver> good = line_of_receivers();
    std::vector<Receiver> bad = good;
    renderer.set_receivers(good);
    bad[3].position.y = std::numeric_limits<float>::quiet_NaN();
    const auto set = [&] { renderer.set_receivers(bad); };
    CHECK(throws<SceneError>(set, "receiver 3: its position is not finite"));
    bad[3] = {.position = {}, .normal = glm::vec3(0.0F)};
    CHECK(throws<SceneError>(set, "receiver 3: its normal is not of unit length"));
    (void)render(cornell_box(), {16, 16});
    CHECK(renderer.received_light().size() == good.size());
}

}  // TEST_SUITE("receivers")
