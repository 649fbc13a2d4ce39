#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("switching") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

int creations = 0;  // GL objects and storage that were made through `counting`

/// Counts the calls of one GL function that makes objects.
template <int Which, class... Arguments>
struct Counted {
    using Function = void (*)(Arguments...);
    static inline Function driver = nullptr;
    static void call(Arguments... arguments) {
        ++creations;
        driver(arguments...);
    }
    static void (*in_place_of(void (*found)()))() {
        driver = reinterpret_cast<Function>(found);
        return reinterpret_cast<void (*)()>(&call);
    }
};

/// The driver's functions; counts calls of those that make buffers, textures, framebuffers and programs.
gl::GetProc counting(const gl::GetProc& get_proc) {
    return [get_proc](const char* name) -> void (*)() {
        const std::string_view wanted(name);
        void (*const found)() = get_proc(name);
        if (wanted == "glCreateBuffers") return Counted<0, GLsizei, GLuint*>::in_place_of(found);
        if (wanted == "glCreateFramebuffers") return Counted<1, GLsizei, GLuint*>::in_place_of(found);
        if (wanted == "glCreateTextures") return Counted<2, GLenum, GLsizei, GLuint*>::in_place_of(found);
        if (wanted == "glNamedBufferStorage") {
            return Counted<3, GLuint, GLsizeiptr, const void*, GLbitfield>::in_place_of(found);
        }
        if (wanted == "glLinkProgram") return Counted<4, GLuint>::in_place_of(found);
        return found;
    };
}

Scene scene_with_lights() {
    Scene scene = shipped_scene("glass");
    add(scene.world, looking({1, 2, 1}, {0, 0, 0}), SpotLight{.range = 5.0F});
    return scene;
}

Configuration by_path(ShadingPath path) {
    Configuration configuration = linear_configuration();
    configuration.path = path;
    configuration.vpls.count = 8;
    return configuration;
}

}  // namespace

TEST_CASE_FIXTURE(RenderFixture,
                  "the first frame after a switch is correct, and results that all paths share are kept") {
    const Scene scene = scene_with_lights();
    std::map<ShadingPath, Picture> pictures;
    for (const ShadingPath path : all_shading_paths) {
        configure(by_path(path));
        pictures[path] = from_scratch(scene, size);
    }
    configure(by_path(ShadingPath::forward));
    static_cast<void>(render(scene, size));
    gl::ObjectCounts after_first_round;
    for (int round = 0; round < 2; ++round) {
        CAPTURE(round);
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            configure(by_path(path));
            CHECK(render(scene, size) == pictures[path]);
            for (const char* pass : {"scene-gather", "scene-upload", "instance-upload", "bvh", "lights",
                                     "shadow-maps", "light-upload", "surfels", "surfel-light", "view"}) {
                CAPTURE(pass);
                CHECK((!ran(pass) || (round == 0 && path == ShadingPath::forward)));
            }
        }
        if (round == 0) after_first_round = device_of(renderer).live();
        CHECK(device_of(renderer).live() == after_first_round);
    }
}

TEST_CASE_FIXTURE(GlFixture, "switching between any two paths creates no objects after the first round") {
    const Scene scene = scene_with_lights();
    // Never verified, because passes that run again create their objects again.
    Renderer renderer(counting(context->get_proc()), {.debug_output = true});
    const RenderTarget target(device, size);
    const auto draw = [&](ShadingPath path) {
        REQUIRE(renderer.configure(by_path(path)).empty());
        renderer.render(scene.world, scene.camera, target.target());
    };
    for (const ShadingPath a : all_shading_paths) {
        for (const ShadingPath b : all_shading_paths) {
            CAPTURE(to_string(a));
            CAPTURE(to_string(b));
            draw(a);
            draw(b);
            const int before = creations;
            draw(a);
            draw(b);
            CHECK(creations == before);
        }
    }
    CHECK(creations > 0);
}

TEST_CASE_FIXTURE(RenderFixture, "VPLs that are placed in another way get depth maps of their own") {
    const Scene scene = scene_with_lights();
    Configuration paths = by_path(ShadingPath::deferred);
    paths.vpls.placement = VplPlacement::paths;
    paths.visibility.method = VplVisibility::maps;
    Configuration surfels = paths;
    surfels.vpls.placement = VplPlacement::surfels;
    configure(surfels);
    const Picture expected = from_scratch(scene, size);
    configure(paths);
    static_cast<void>(render(scene, size));
    configure(surfels);
    CHECK(render(scene, size) == expected);
}

TEST_CASE_FIXTURE(RenderFixture,
                  "all errors of a file are reported, and the current configuration stays in use") {
    const Scene scene = scene_with_lights();
    configure(by_path(ShadingPath::clustered_forward));
    const Picture before = render(scene, size);

    const ConfigurationResult read = read_configuration(
        R"({"path": "tiled", "indirect": 1, "lists": {"tile_size": 24, "slices": "many", "shape": 2},
                "vpls": {"count": -4}})",
        renderer.configuration());
    CHECK_FALSE(read.configuration);
    std::vector<std::string> places;
    for (const std::string& error : read.errors) places.push_back(error.substr(0, error.find(':')));
    std::ranges::sort(places);
    CHECK(places == std::vector<std::string>{"indirect", "lists.shape", "lists.slices", "lists.tile_size",
                                             "path", "vpls.count"});

    for (const std::uint32_t tile_size : {0U, 8U, 24U, 128U}) {
        CAPTURE(tile_size);
        Configuration bad = by_path(ShadingPath::tiled_deferred);
        bad.lists = {.tile_size = tile_size, .slices = 1};
        const std::vector<std::string> errors = renderer.configure(bad);
        CHECK(std::ranges::any_of(errors, [](const auto& f) { return f.starts_with("lists.tile_size: "); }));
        CHECK(std::ranges::any_of(errors, [](const auto& f) { return f.starts_with("lists.slices: "); }));
    }
    CHECK(renderer.configuration() == by_path(ShadingPath::clustered_forward));
    CHECK(render(scene, size) == before);
    CHECK_FALSE(ran("forward"));
}

}  // TEST_SUITE("switching")
