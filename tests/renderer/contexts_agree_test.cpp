#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("contexts agree") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

/// Every path, and with one of them or another every VPL visibility, interleaved or not.
std::vector<Configuration> configurations() {
    std::vector<Configuration> all;
    for (const ShadingPath path : all_shading_paths) {
        Configuration configuration = linear_configuration(path);
        configuration.visibility.method = static_cast<VplVisibility>(all.size() % 3);
        configuration.interleave = all.size() % 2 == 0 ? Interleave::one : Interleave::two;
        configuration.vpls.count = 24;
        all.push_back(configuration);
    }
    return all;
}

struct Shown {
    std::string driver;
    std::vector<Picture> pictures;
};

/// The Cornell box in a context of that kind, with its light moved in a second frame, so that VPLs are
/// updated; then scenes that surfaces and the sky light.
Shown show(ContextKind kind) {
    const auto context = HeadlessContext::create(kind, {.debug = true});
    context->make_current();
    TestedRenderer renderer(context->get_proc());
    const RenderTarget target(device_of(renderer), size);
    Shown shown{device_of(renderer).renderer(), {}};
    for (const Configuration& configuration : configurations()) {
        Scene scene = cornell_box();
        REQUIRE(renderer.configure(configuration).empty());
        renderer.invalidate();
        for (int frame = 0; frame < 2; ++frame) {
            renderer.render(scene.world, scene.camera, target.target());
            shown.pictures.push_back(target.read());
            scene.world.edit<Transform>(scene.light, [](Transform& pose) { pose.translation.x += 0.2F; });
        }
    }
    // Light of surfaces and of the sky.
    for (const char* const name : {"lamp", "court"}) {
        const Scene scene = shipped_scene(name);
        renderer.invalidate();
        renderer.render(scene.world, scene.camera, target.target());
        shown.pictures.push_back(target.read());
    }
    for (const gl::DebugMessage& message : device_of(renderer).take_messages()) {
        INFO(message.text);
        CHECK_FALSE(message.is_error());
    }
    return shown;
}

}  // namespace

TEST_CASE("EGL and OSMesa give the same pictures, bit for bit, if they use the same driver") {
    if (!HeadlessContext::is_built(ContextKind::osmesa)) {
        MESSAGE("nothing to compare: this build is without OSMesa");
        return;
    }
    const Shown egl = show(ContextKind::egl);
    const Shown osmesa = show(ContextKind::osmesa);
    if (egl.driver != osmesa.driver) {
        MESSAGE("nothing to compare: EGL is ", egl.driver, ", OSMesa is ", osmesa.driver);
        return;
    }
    for (std::size_t i = 0; i < egl.pictures.size(); ++i) {
        CAPTURE(i);
        CHECK(mean(egl.pictures[i]) > 0.0);
        CHECK(egl.pictures[i] == osmesa.pictures[i]);
    }
}

}  // TEST_SUITE("contexts agree")
