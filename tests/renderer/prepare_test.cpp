#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <candela/graph/describe.hpp>
#include "renderer/facade/device_of.hpp"
#include "sandbox/files/shipped_file.hpp"
#include "tests/compilations.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/sandbox/temporary_folder.hpp"
#include "tests/throws.hpp"

TEST_SUITE("prepare") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{16, 12};

/// A renderer that counts what it compiles.
class PrepareTests : public GlFixture {
 protected:
    PrepareTests() { static_cast<void>(Compilations::take()); }

    std::vector<std::string> prepare(const Configuration& configuration, const Scene& scene,
                                     const CompileProgress& progress = {}) {
        return renderer.prepare(configuration, scene.world, std::vector{view_of(scene)}, progress);
    }
    Picture render(const Scene& scene) {
        renderer.render(scene.world, std::vector{view_of(scene)});
        return target.read();
    }
    [[nodiscard]] RenderView view_of(const Scene& scene) const {
        RenderView view = asked;
        view.camera = scene.camera;
        view.target = target.target();
        return view;
    }

    TestedRenderer renderer{Compilations::counting(context->get_proc())};
    RenderTarget target{device_of(renderer), size};
    RenderView asked;
};

/// The Cornell box with surfaces of all kinds, under a sky.
Scene rich_scene() {
    Scene scene = cornell_box();
    add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    add(scene.world, at({0.0F, 0.5F, 0.0F}), MeshInstance{square(0.1F, emitter(glm::vec3(1.0F)))});
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Material material;
        material.alpha_mode = mode;
        add(scene.world, at({0.0F, 0.6F, 0.0F}),
            MeshInstance{square(0.1F, std::make_shared<const Material>(material))});
    }
    return scene;
}

Scene empty_scene() {
    Scene scene;
    scene.camera = add(scene.world, Transform{}, Camera{});
    return scene;
}

/// A copy of the shaders in which one can be made faulty.
class ShaderCopy {
 public:
    ShaderCopy() { std::filesystem::copy(sandbox::shipped_file("shaders", ""), path(), recursive); }

    [[nodiscard]] std::filesystem::path path() const { return folder_ / "shaders"; }
    /// Adds a line at the end of a file. Returns its number.
    std::size_t append(const char* file, const std::string& line) const {
        std::ifstream before(path() / file);
        const auto lines = std::count(std::istreambuf_iterator<char>(before), {}, '\n');
        std::ofstream(path() / file, std::ios::app) << line << '\n';
        return static_cast<std::size_t>(lines) + 1;
    }
    void restore(const char* file) const {
        std::filesystem::copy(sandbox::shipped_file("shaders", file), path() / file,
                              std::filesystem::copy_options::overwrite_existing);
    }

 private:
    static constexpr auto recursive = std::filesystem::copy_options::recursive;
    sandbox::TemporaryFolder folder_;
};

}  // namespace

TEST_CASE_FIXTURE(PrepareTests, "frames of what was prepared compile nothing") {
    Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::maps;
    SUBCASE("few VPLs") {}
    SUBCASE("surfaces of all kinds, a sky, forward") {
        scene = rich_scene();
        configuration.path = ShadingPath::tiled_forward;
        configuration.refinement.enabled = true;
        configuration.tone_map = {.enabled = true, .automatic_exposure = true};
    }
    SUBCASE("VPLs on paths, and what the host asks for") {
        configuration.vpls.placement = VplPlacement::paths;
        configuration.visibility.method = VplVisibility::rays;
        asked.keep.indirect = true;
        asked.estimate_error = true;
        renderer.set_receivers({{.position = {}, .normal = {0.0F, 1.0F, 0.0F}}});
    }
    SUBCASE("an empty world") {
        scene = empty_scene();
    }

    REQUIRE(prepare(configuration, scene).empty());
    CHECK(Compilations::take().linked > 0);
    REQUIRE(renderer.configure(configuration).empty());
    static_cast<void>(render(scene));
    static_cast<void>(render(scene));
    CHECK(Compilations::take() == ProgramCounts{});
}

TEST_CASE_FIXTURE(PrepareTests, "nor do frames that a budget makes cheaper") {
    Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.frame_budget_ms = 0.001F;  // less than any frame takes
    REQUIRE(prepare(configuration, scene).empty());
    static_cast<void>(Compilations::take());
    REQUIRE(renderer.configure(configuration).empty());
    for (int frame = 0; frame < 3; ++frame) {
        scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.z += 0.01F; });
        static_cast<void>(render(scene));
        static_cast<void>(renderer.take_frames(true));
    }
    CHECK(renderer.quality().scale < 1.0F);
    CHECK(Compilations::take() == ProgramCounts{});
}

TEST_CASE_FIXTURE(PrepareTests, "it changes neither the configuration nor the graph nor the picture") {
    const Scene scene = cornell_box();
    REQUIRE(renderer.configure(linear_configuration(ShadingPath::forward)).empty());
    const Picture before = render(scene);
    static_cast<void>(render(scene));
    const Configuration configuration = renderer.configuration();
    const std::string graph = describe_text(renderer.description());
    const auto ran = [&] {
        std::vector<std::string> names;
        for (const PassRecord& pass : renderer.last_passes()) {
            if (pass.ran) names.emplace_back(pass.name);
        }
        return names;
    };
    const std::vector<std::string> of_still_frame = ran();

    Configuration other = linear_configuration(ShadingPath::clustered_deferred);
    other.vpls.count *= 2;
    REQUIRE(prepare(other, rich_scene()).empty());
    CHECK(renderer.configuration() == configuration);
    CHECK(describe_text(renderer.description()) == graph);
    CHECK(ran() == of_still_frame);
    CHECK(render(scene) == before);
    CHECK(ran() == of_still_frame);
}

TEST_CASE_FIXTURE(PrepareTests, "progress goes up program by program, to all, in the calling thread") {
    const Scene scene = cornell_box();
    std::vector<std::pair<std::size_t, std::size_t>> told;
    const std::thread::id thread = std::this_thread::get_id();
    const auto tell = [&](std::size_t done, std::size_t total) {
        CHECK(std::this_thread::get_id() == thread);
        told.emplace_back(done, total);
        return true;
    };
    REQUIRE(prepare(linear_configuration(), scene, tell).empty());
    const std::size_t total = Compilations::take().linked;
    REQUIRE(total > 0);
    REQUIRE(told.size() == total + 1);
    for (std::size_t i = 0; i < told.size(); ++i) CHECK(told[i] == std::pair(i, total));

    told.clear();
    REQUIRE(prepare(linear_configuration(), scene, tell).empty());
    CHECK(told == std::vector{std::pair(total, total)});
}

TEST_CASE_FIXTURE(PrepareTests, "it can be stopped, and goes on later") {
    const Scene scene = cornell_box();
    std::size_t all = 0;
    REQUIRE(prepare(linear_configuration(), scene, [&](std::size_t done, std::size_t total) {
                all = total;
                return done < 3;
            }).empty());
    std::optional<std::size_t> first;
    REQUIRE(prepare(linear_configuration(), scene, [&](std::size_t done, std::size_t total) {
                CHECK(total == all);
                if (!first) first = done;
                return true;
            }).empty());
    CHECK(first == 3);
    // What was started and dropped when it stopped may have been compiled for nothing.
    CHECK(Compilations::take().linked >= all);
    static_cast<void>(prepare(linear_configuration(), scene));
    CHECK(Compilations::take().linked == 0);

    // And a frame compiles what is left.
    TestedRenderer stopped(context->get_proc());
    REQUIRE(stopped
                .prepare(linear_configuration(), scene.world, std::vector{view_of(scene)},
                         [](std::size_t, std::size_t) { return false; })
                .empty());
    REQUIRE(stopped.configure(linear_configuration()).empty());
    REQUIRE(renderer.configure(linear_configuration()).empty());
    const Picture picture = render(scene);
    stopped.render(scene.world, scene.camera, target.target());
    CHECK(target.read() == picture);
}

TEST_CASE_FIXTURE(PrepareTests, "errors are returned as by configure, and a frame that is none is one") {
    const Scene scene = cornell_box();
    Configuration bad;
    bad.vpls.bounces = 65;
    CHECK(prepare(bad, scene) == renderer.configure(bad));
    CHECK(prepare(bad, scene).size() == 1);
    CHECK(throws<gl::GlError>([&] { static_cast<void>(renderer.prepare({}, scene.world, {})); },
                              "a frame needs at least one view"));
    CHECK(Compilations::take().linked == 0);
}

TEST_CASE("a faulty shader is the same error wherever it is needed, and can be corrected") {
    const auto context = make_current_context();
    const ShaderCopy shaders;
    constexpr const char* file = "shading/deferred.comp";
    TestedRenderer renderer(context->get_proc(), {.shader_directory = shaders.path().string()});
    const Scene scene = cornell_box();
    const RenderTarget target(device_of(renderer), size);
    const std::vector<RenderView> views{{.camera = scene.camera, .target = target.target()}};

    REQUIRE(renderer.configure(linear_configuration(ShadingPath::forward)).empty());
    renderer.render(scene.world, views);
    const Picture before = target.read();

    const std::size_t line = shaders.append(file, "float f() { return nothing; }");
    const Configuration deferred = linear_configuration(ShadingPath::deferred);
    const std::vector<std::string> errors = renderer.prepare(deferred, scene.world, views);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with("shaders/shading/deferred.comp does not compile:\n"));
    CHECK(errors[0].find("shaders/shading/deferred.comp:" + std::to_string(line) + ": ") !=
          std::string::npos);
    CHECK(renderer.configure(deferred) == errors);
    CHECK(renderer.configuration().path == ShadingPath::forward);
    renderer.render(scene.world, views);
    CHECK(target.read() == before);

    {
        TestedRenderer fresh(context->get_proc(), {.shader_directory = shaders.path().string()});
        CHECK(throws<gl::ProgramError>([&] { fresh.render(scene.world, views); }, errors[0]));
        CHECK(fresh.configure(fresh.configuration()) == errors);
        shaders.restore(file);
        CHECK_NOTHROW(fresh.render(scene.world, views));
    }
    CHECK(renderer.configure(deferred).empty());
    CHECK_NOTHROW(renderer.render(scene.world, views));
}

TEST_CASE_FIXTURE(PrepareTests, "the host's limit of the compiler's threads stays") {
    const gl::Functions& gl = device_of(renderer).gl();
    if (gl.MaxShaderCompilerThreadsKHR == nullptr) return;
    gl.MaxShaderCompilerThreadsKHR(1);
    REQUIRE(prepare(linear_configuration(), cornell_box()).empty());
    CHECK(gl::get_unsigned(gl, GL_MAX_SHADER_COMPILER_THREADS_KHR) == 1);
}

}  // TEST_SUITE("prepare")
