// How the quality of frames is chosen under a time budget, and the pictures that result.

#include "renderer/frame/frame_budget.hpp"
#include "renderer/facade/device_of.hpp"
#include "renderer/passes/lights/shadow_maps.hpp"

#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <candela/gl_loader.hpp>
#include <candela/graph/describe.hpp>

#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("frame budget") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{48, 32};

glm::uvec2 lowest_size(glm::uvec2 target) {
    return rendered_size(target, lowest_quality);
}

/// Notes the sizes of the dispatches by the pass that makes them, of all renderers made with `noting`.
class Dispatches {
 public:
    using Groups = std::vector<std::array<GLuint, 3>>;

    [[nodiscard]] static gl::GetProc noting(gl::GetProc get_proc) {
        return [get_proc = std::move(get_proc)](const char* name) -> void (*)() {
            const auto found = get_proc(name);
            if (std::string_view(name) == "glPushDebugGroup") {
                push_ = reinterpret_cast<PFNGLPUSHDEBUGGROUPPROC>(found);
                return reinterpret_cast<void (*)()>(&begin_pass);
            }
            if (std::string_view(name) == "glDispatchCompute") {
                dispatch_ = reinterpret_cast<PFNGLDISPATCHCOMPUTEPROC>(found);
                return reinterpret_cast<void (*)()>(&note);
            }
            return found;
        };
    }
    /// By pass, since the last call.
    [[nodiscard]] static std::map<std::string, Groups> take() { return std::exchange(by_pass_, {}); }

 private:
    static void begin_pass(GLenum source, GLuint id, GLsizei length, const GLchar* name) {
        pass_.assign(name, static_cast<std::size_t>(length));
        push_(source, id, length, name);
    }
    static void note(GLuint x, GLuint y, GLuint z) {
        by_pass_[pass_].push_back({x, y, z});
        dispatch_(x, y, z);
    }

    static inline std::string pass_;
    static inline std::map<std::string, Groups> by_pass_;
    static inline PFNGLPUSHDEBUGGROUPPROC push_ = nullptr;
    static inline PFNGLDISPATCHCOMPUTEPROC dispatch_ = nullptr;
};

/// What a pass did in a frame: its dispatches, and the sizes of the textures and buffers that it wrote.
struct Work {
    Dispatches::Groups dispatches;
    std::vector<std::pair<glm::uvec2, std::uint64_t>> written;  // texels of a texture, elements of a buffer
    Workload workload = Workload::other;
};
using PassWork = std::map<std::string, Work>;

/// Surfaces that emit, blended ones, and a sky.
void add_all_that_is_drawn(World& world) {
    Material glass = *diffuse(glm::vec3(0.5F));
    glass.alpha_mode = AlphaMode::blend;
    add(world, at({0.0F, 0.5F, 0.0F}), MeshInstance{square(0.1F, std::make_shared<const Material>(glass))});
    add(world, at({0.0F, 0.3F, 0.0F}), MeshInstance{square(0.1F, emitter(glm::vec3(1.0F)))});
    add(world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
}

glm::vec3 pixel(const Picture& picture, glm::ivec2 at) {
    return picture.pixels[static_cast<std::size_t>(at.y) * picture.size.x + static_cast<std::size_t>(at.x)];
}

bool differ(glm::vec3 a, glm::vec3 b) {
    return glm::any(glm::greaterThan(glm::abs(a - b), glm::vec3(0.02F)));
}

/// For how many pixels `holds`.
template <class F>
std::size_t count_pixels(const Picture& picture, const F& holds) {
    std::size_t count = 0;
    const glm::ivec2 all(picture.size);
    for (int y = 0; y < all.y; ++y) {
        for (int x = 0; x < all.x; ++x) count += holds(glm::ivec2(x, y)) ? 1 : 0;
    }
    return count;
}

/// Whether another surface is seen within a pixel of the smallest picture.
bool is_near_edge(const Picture& picture, glm::ivec2 at) {
    constexpr int near = 5;
    const glm::ivec2 first = glm::max(at - near, 0);
    const glm::ivec2 last = glm::min(at + near, glm::ivec2(picture.size) - 1);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            if (differ(pixel(picture, at), pixel(picture, {x, y}))) return true;
        }
    }
    return false;
}

class FrameBudgetTests : public PathFixture {
 protected:
    /// Pass a budget that no frame can keep, or one that every frame keeps.
    void start(float budget_ms) {
        Configuration configuration = linear_configuration();
        configuration.frame_budget_ms = budget_ms;
        configure(configuration);
    }
    void move_camera() {
        scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.x += 0.01F; });
    }
    /// Renders frames of a moving camera until their times are known.
    Picture moving() {
        Picture picture;
        for (int i = 0; i < 3; ++i) {
            move_camera();
            picture = render(scene, size);
            static_cast<void>(renderer.take_frames(true));
        }
        return picture;
    }
    /// A frame with as few pixels as can be, by a new renderer, while the light moves.
    Picture coarse_picture(Configuration configuration, const std::optional<HostSurfaces>& surfaces,
                           const RenderTarget& target) {
        TestedRenderer coarse(context->get_proc());
        configuration.frame_budget_ms = 1e-3F;
        REQUIRE(coarse.configure(configuration).empty());
        const RenderView view{.camera = scene.camera, .target = target.target(), .surfaces = surfaces};
        for (int i = 0; i < 3; ++i) {
            scene.world.edit<Transform>(scene.light, [](Transform& pose) { pose.translation.x += 0.01F; });
            coarse.render(scene.world, {&view, 1});
            static_cast<void>(coarse.take_frames(true));
        }
        CHECK(coarse.report().rendered_size == lowest_size(target.target().size));
        return target.read();
    }
    /// The same view, by a new renderer without a budget.
    Picture fresh_picture() {
        TestedRenderer fresh(context->get_proc());
        Configuration configuration = renderer.configuration();
        configuration.frame_budget_ms = 0.0F;
        REQUIRE(fresh.configure(configuration).empty());
        const RenderTarget target(device, size);
        fresh.render(scene.world, scene.camera, target.target());
        return target.read();
    }

    /// What each pass does in a frame with this budget while the camera moves: with one that no frame can
    /// keep, the frame has fewer pixels than the target.
    PassWork work(ShadingPath path, std::optional<HostSurfaces> surfaces, float budget_ms) {
        const glm::uvec2 target_size(256, 160);
        TestedRenderer noted(Dispatches::noting(context->get_proc()));
        Configuration configuration = linear_configuration();
        configuration.path = path;
        configuration.interleave = Interleave::eight;
        configuration.refinement.enabled = true;
        configuration.frame_budget_ms = budget_ms;
        REQUIRE(noted.configure(configuration).empty());
        const RenderTarget target(device, target_size);
        const RenderView view{.camera = scene.camera, .target = target.target(), .surfaces = surfaces};
        std::vector<FrameReport> frames;
        for (int i = 0; i < 3; ++i) {
            move_camera();
            static_cast<void>(Dispatches::take());
            noted.render(scene.world, {&view, 1});
            frames = noted.take_frames(true);
        }
        CHECK(noted.report().rendered_size == (budget_ms > 0.0F ? lowest_size(target_size) : target_size));
        return work_of(frames.back(), Dispatches::take(), noted.description());
    }

    static PassWork work_of(const FrameReport& frame, std::map<std::string, Dispatches::Groups> dispatches,
                            const GraphDescription& graph) {
        PassWork work;
        for (std::size_t i = 0; i < frame.passes.size(); ++i) {
            const PassReport& pass = frame.passes[i];
            Work& done = work[pass.name];
            done = {.dispatches = std::move(dispatches[pass.name]), .written = {}, .workload = pass.workload};
            for (const DescribedAccess& access : graph.passes[i].accesses) {
                const DescribedResource& resource = graph.resources[access.resource];
                if (access.write) done.written.emplace_back(resource.texture.size, resource.buffer.count);
            }
        }
        return work;
    }

    Scene scene = cornell_box();
};

}  // namespace

TEST_CASE("a frame's cost is split by what it depends on") {
    const FrameReport frame{.index = 0,
                            .cpu_ms = 20.0,
                            .gpu_ms = 30.0,
                            .passes = {{"vpl-maps", true, 0.1, 5.0, Workload::other},
                                       {"vpl-gather", true, 0.1, 12.0, Workload::pixels_vpls},
                                       {"deferred", true, 0.1, 6.0, Workload::pixels},
                                       {"a host's", true, 0.1, 3.0, Workload::pixels},
                                       {"gbuffer", false, 0.0, 1.0, Workload::pixels}}};
    const FrameCost cost = cost_of(frame);
    CHECK(cost.gather == 12.0);
    CHECK(cost.pixels == 9.0);
    CHECK(cost.rest == 9.0);
}

TEST_CASE_FIXTURE(FrameBudgetTests, "the passes whose work grows with the pixels declare that they do") {
    add_all_that_is_drawn(scene.world);
    const gl::Texture texture(device, "host's", {.size = {8, 8}, .format = Format::rgba32f});
    const gl::Texture depth(device, "host's", {.size = {8, 8}, .format = Format::r32f});
    const HostSurfaces surfaces{.depth = depth.name(), .normal = texture.name(), .albedo = texture.name()};
    std::set<std::string> of_pixels;
    for (const ShadingPath path : all_shading_paths) {
        for (const bool hosted : {false, true}) {
            CAPTURE(static_cast<int>(path));
            CAPTURE(hosted);
            const auto host = hosted ? std::optional(surfaces) : std::nullopt;
            const PassWork coarse = work(path, host, 1e-3F);
            const PassWork fine = work(path, host, 0.0F);
            for (const auto& each : coarse) {
                // Only what enlarges the picture is there in addition, and does not grow with the pixels.
                if (fine.contains(each.first)) continue;
                CHECK((each.first.ends_with("(target's size)") || each.first.starts_with("enlarge")));
                CHECK(each.second.workload == Workload::other);
            }
            for (const auto& each :
                 fine) {  // Clang 14 captures no structured bindings, as CHECK_MESSAGE would
                const std::string& pass = each.first;
                const auto& done = each.second;
                // Smaller for a smaller picture, but its draws take time, too, and it runs only if lights
                // move.
                if (pass == "shadow-maps") {
                    CHECK(done.workload == Workload::other);
                    CHECK(done.written != coarse.at(pass).written);
                    continue;
                }
                if (pass == "tone-map") {  // to the target, or to a picture with fewer pixels
                    CHECK(done.workload == Workload::other);
                    CHECK(coarse.at(pass).workload == Workload::pixels);
                    continue;
                }
                const bool grows =
                    done.dispatches != coarse.at(pass).dispatches || done.written != coarse.at(pass).written;
                CHECK_MESSAGE((done.workload != Workload::other) == grows, pass);
                CHECK((done.workload == Workload::pixels_vpls) == (pass == "vpl-gather"));
                if (grows) of_pixels.insert(pass);
            }
        }
    }
    // Each pass of a view that draws or dispatches was there, besides those that cover the target. One,
    // `transparent-parts`, is only there on software drivers.
    CHECK(of_pixels.size() == (device_of(renderer).limits().software ? 19 : 18));
}

TEST_CASE("the predicted time scales with the pixels, and with the VPLs per pixel") {
    const FrameCost cost{.gather = 16.0, .pixels = 8.0, .rest = 5.0};
    CHECK(expected_ms(cost, {1.0F, 4}, {1.0F, 4}) == 29.0);
    CHECK(expected_ms(cost, {1.0F, 4}, {1.0F, 8}) == 5.0 + 8.0 + 4.0);
    CHECK(expected_ms(cost, {1.0F, 4}, {0.5F, 8}) == 5.0 + 2.0 + 1.0);
    CHECK(expected_ms(cost, {0.5F, 8}, {1.0F, 4}) == 5.0 + 32.0 + 256.0);
}

TEST_CASE("the best quality that keeps to the budget is chosen") {
    const FrameCost cost{.gather = 160.0, .pixels = 80.0, .rest = 10.0};
    const Quality whole{1.0F, 1};
    CHECK(choose_quality(cost, whole, 1, 1000.0) == whole);
    CHECK(choose_quality(cost, whole, 1, 120.0) == Quality{1.0F, 8});  // 92.5 ms
    CHECK(choose_quality(cost, whole, 1, 100.0) == Quality{0.8F, 8});  // 92.5 ms leave too little margin
    CHECK(choose_quality(cost, whole, 1, 40.0) == Quality{0.5F, 8});
    CHECK(choose_quality(cost, whole, 1, 11.0) == lowest_quality);  // no quality does
    // If frames are interleaved anyway, more interleaving gains nothing.
    CHECK(choose_quality(cost, {1.0F, 8}, 8, 1000.0) == whole);
    CHECK(choose_quality(cost, {1.0F, 8}, 8, 150.0).scale < 1.0F);
}

TEST_CASE("a better quality that would be left again at once is not chosen") {
    // Judging by the cost at half the sides, 65 % would fit, but with little margin.
    const FrameCost cost{.gather = 0.0, .pixels = 48.0, .rest = 0.0};
    CHECK(expected_ms(cost, {0.5F, 8}, {0.65F, 8}) == doctest::Approx(81.12));
    CHECK(choose_quality(cost, {0.5F, 8}, 1, 100.0) == Quality{0.5F, 8});
    CHECK(choose_quality(cost, {0.5F, 8}, 1, 120.0) == Quality{0.65F, 8});
    // Once at 65 %, it stays there.
    const FrameCost there{.gather = 0.0, .pixels = 81.12, .rest = 0.0};
    CHECK(choose_quality(there, {0.65F, 8}, 1, 100.0) == Quality{0.65F, 8});
}

TEST_CASE("at least one pixel is rendered") {
    CHECK(rendered_size({1280, 720}, {0.375F, 8}) == glm::uvec2(480, 270));
    CHECK(rendered_size({1, 2}, lowest_quality) == glm::uvec2(1, 1));
    CHECK(rendered_size({511, 513}, {}) == glm::uvec2(511, 513));
}

TEST_CASE_FIXTURE(FrameBudgetTests,
                  "frames have a lower quality while something moves, and full quality at rest") {
    start(1e-3F);
    const Picture coarse = moving();
    CHECK(renderer.report().rendered_size == lowest_size(size));
    CHECK(renderer.report().vpls->interleave == 8);
    CHECK(is_sane(coarse));
    const Picture whole = fresh_picture();
    CHECK(coarse != whole);
    CHECK(mean(coarse) == doctest::Approx(mean(whole)).epsilon(0.05));

    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(render(scene, size) == whole);
    CHECK(renderer.report().rendered_size == size);
    move_camera();
    static_cast<void>(render(scene, size));
    CHECK(renderer.report().rendered_size == lowest_size(size));
}

TEST_CASE("shadow maps are halved as often as the picture, and never get tiny") {
    const ShadowSettings settings{.cube_resolution = 512, .map_resolution = 1024};
    const auto is = [&](float scale, std::uint32_t cube, std::uint32_t map) {
        return shadow_resolution(settings, scale) == ShadowResolution{cube, map};
    };
    CHECK(is(1.0F, 512, 1024));
    CHECK(is(0.75F, 512, 1024));
    CHECK(is(0.5F, 256, 512));
    CHECK(is(0.2F, 128, 256));
    CHECK(is(1e-6F, 16, 16));
    const ShadowSettings least{.cube_resolution = 16, .map_resolution = 20};
    CHECK(shadow_resolution(least, 0.2F) == ShadowResolution{16, 16});
}

TEST_CASE_FIXTURE(FrameBudgetTests, "shadows are the same with small maps as with large ones") {
    const Transform pose = scene.world.get<Transform>(scene.light);
    const RenderTarget target(device, {320, 240});
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    std::vector<Picture> pictures;
    for (const std::uint32_t resolution : {64U, 2048U}) {
        scene.world.set(scene.light, pose);
        configuration.shadows.cube_resolution = resolution;
        pictures.push_back(coarse_picture(configuration, std::nullopt, target));
    }
    CHECK(pictures[0] == pictures[1]);
}

TEST_CASE_FIXTURE(FrameBudgetTests, "the same lights have a shadow map, whatever the quality") {
    add(scene.world, at({0.5F, 1.0F, 0.0F}), PointLight{.intensity = 1.0F});
    Configuration configuration = linear_configuration();
    configuration.shadows.cube_resolution = 512;
    configuration.shadows.budget_mib = 6;  // 512 × 512 × 4 bytes × 6 faces: of one
    configure(configuration);
    static_cast<void>(render(scene, size));
    CHECK(renderer.report().lights.without_map == 1);
    configuration.frame_budget_ms = 1e-3F;
    configure(configuration);
    static_cast<void>(moving());
    CHECK(renderer.report().rendered_size == lowest_size(size));
    CHECK(renderer.report().lights.without_map == 1);
}

TEST_CASE_FIXTURE(FrameBudgetTests, "edges have the resolution of the target, whatever the quality") {
    // Each surface of the box has one normal, so that values differ at edges only. Around it is the sky.
    add(scene.world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.z += 1.0F; });
    Configuration configuration = linear_configuration();
    configuration.show = Show::normals;
    configure(configuration);
    const RenderTarget target(device, {256, 192});
    const RenderView view{.camera = scene.camera,
                          .target = target.target(),
                          .keep = {.depth = true, .normal = true, .albedo = true}};
    renderer.render(scene.world, {&view, 1});
    const Picture whole = target.read();
    const HostSurfaces drawn_by_host = own_surfaces();
    const std::size_t at_edges = count_pixels(whole, [&](glm::ivec2 at) { return is_near_edge(whole, at); });
    REQUIRE(at_edges > 2000);
    for (const ShadingPath path : all_shading_paths) {
        for (const bool hosted : {false, true}) {
            CAPTURE(static_cast<int>(path));
            CAPTURE(hosted);
            configuration.path = path;
            const Picture coarse =
                coarse_picture(configuration, hosted ? std::optional(drawn_by_host) : std::nullopt, target);
            const auto differs = [&](glm::ivec2 at) { return differ(pixel(coarse, at), pixel(whole, at)); };
            // What remains are corners that no pixel of the smaller picture shows, and creases: close to
            // those, two surfaces are not told apart. The depths of a host are off by half a pixel of the
            // target, as they are those of its texels. Without the surfaces of the target, half of the pixels
            // near edges would differ.
            CHECK(count_pixels(whole, differs) < at_edges / 6);
            CHECK(count_pixels(whole,
                               [&](glm::ivec2 at) { return differs(at) && !is_near_edge(whole, at); }) == 0);
        }
    }
}

TEST_CASE_FIXTURE(FrameBudgetTests, "with a large budget, or without one, every frame has full quality") {
    for (const float budget : {1e6F, 0.0F}) {
        CAPTURE(budget);
        start(budget);
        const Picture picture = moving();
        CHECK(renderer.report().rendered_size == size);
        CHECK(picture == fresh_picture());
    }
}

TEST_CASE_FIXTURE(FrameBudgetTests, "refinement continues at rest, at full quality") {
    start(1e-3F);
    Configuration configuration = renderer.configuration();
    configuration.refinement = {.enabled = true, .frames = 4};
    configure(configuration);
    static_cast<void>(moving());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    for (int i = 0; i < 6; ++i) static_cast<void>(render(scene, size));
    CHECK(renderer.report().refined == 4);
    CHECK(renderer.report().rendered_size == size);
}

}  // TEST_SUITE("frame budget")
