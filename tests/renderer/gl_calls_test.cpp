// The GL calls of frames: what a host pays for having Candela, and how long a GPU waits between small pieces
// of work.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "renderer/gl/functions.hpp"
#include "tests/renderer/recorded_programs.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("GL calls") {

using namespace candela;

namespace {

#define CANDELA_GL_INDEX(name, capitals) of_##name,
enum Index : std::size_t { CANDELA_GL_FUNCTIONS(CANDELA_GL_INDEX) functions };
#undef CANDELA_GL_INDEX

#define CANDELA_GL_NAME(name, capitals) #name,
constexpr std::array<std::string_view, functions> names{CANDELA_GL_FUNCTIONS(CANDELA_GL_NAME)};
#undef CANDELA_GL_NAME

std::array<int, functions> calls;

/// What waits for what in a frame.
struct Chain {
    int steps = 0;             ///< pieces of work, each of which waits for the one before it
    int small_dispatches = 0;  ///< of fewer than 10,000 invocations, or of a number that the GPU finds
    bool waits = true;         ///< the next work is a new step
};
Chain chain;

std::set<GLuint> used_programs;

void note_dispatch(std::uint64_t groups);

void note(Index index, std::uint64_t groups) {
    if (index == of_MemoryBarrier || index == of_PushDebugGroup)
        chain.waits = true;  // the latter: another pass
    const bool dispatches = index == of_DispatchCompute || index == of_DispatchComputeIndirect;
    if (!dispatches && index != of_DrawArrays && index != of_MultiDrawElementsIndirect) return;
    if (chain.waits) ++chain.steps;
    chain.waits = false;
    if (dispatches) note_dispatch(groups);
}

/// Of DispatchCompute's arguments; else 0.
template <class... Arguments>
std::uint64_t groups_of(Arguments... arguments) {
    if constexpr (sizeof...(Arguments) == 3 && (std::is_same_v<Arguments, GLuint> && ...)) {
        return (std::uint64_t{arguments} * ...);
    }
    return 0;
}

/// Counts the calls of one function of the driver's.
template <Index index, class Function>
struct Counted;
template <Index index, class Result, class... Arguments>
struct Counted<index, Result(APIENTRY*)(Arguments...)> {
    static inline Result(APIENTRY* driver)(Arguments...) = nullptr;
    static Result APIENTRY call(Arguments... arguments) {
        ++calls[index];
        note(index, groups_of(arguments...));
        if constexpr (index == of_UseProgram) (used_programs.insert(arguments), ...);
        return driver(arguments...);
    }
};

void note_dispatch(std::uint64_t groups) {
    const auto query = Counted<of_GetIntegerv, PFNGLGETINTEGERVPROC>::driver;
    const auto query_program = Counted<of_GetProgramiv, PFNGLGETPROGRAMIVPROC>::driver;
    GLint program = 0;
    query(GL_CURRENT_PROGRAM, &program);
    std::array<GLint, 3> size{};
    query_program(static_cast<GLuint>(program), GL_COMPUTE_WORK_GROUP_SIZE, size.data());
    const auto invocations = groups * static_cast<std::uint64_t>(size[0] * size[1] * size[2]);
    if (invocations < 10'000) ++chain.small_dispatches;
}

gl::GetProc counting(const gl::GetProc& get_proc) {
    return [get_proc](const char* wanted) -> void (*)() {
        void (*const found)() = get_proc(wanted);
#define CANDELA_GL_COUNT(name, capitals)                                   \
    if (std::string_view(wanted) == "gl" #name) {                          \
        using Function = Counted<of_##name, PFNGL##capitals##PROC>;        \
        Function::driver = reinterpret_cast<PFNGL##capitals##PROC>(found); \
        return reinterpret_cast<void (*)()>(&Function::call);              \
    }
        CANDELA_GL_FUNCTIONS(CANDELA_GL_COUNT)
#undef CANDELA_GL_COUNT
        return found;
    };
}

struct Calls {
    int all = 0;
    int queries = 0;  ///< of state
};

class GlCalls : public GlFixture {
 protected:
    /// Those of the third of three equal frames.
    Calls of_still_frame(bool keeps_gl_state) {
        Renderer renderer(counting(context->get_proc()), RendererOptions{.keeps_gl_state = keeps_gl_state});
        REQUIRE(renderer.configure(Configuration{}).empty());
        const Scene scene = cornell_box();
        const RenderTarget target(device, {32, 24});
        for (int frame = 0; frame < 3; ++frame) {
            calls = {};
            renderer.render(scene.world, scene.camera, target.target());
        }
        picture = target.read();
        Calls sum{.all = std::accumulate(calls.begin(), calls.end(), 0)};
        for (std::size_t i = 0; i < functions; ++i) {
            if (names[i].starts_with("Get") || names[i].starts_with("Is")) sum.queries += calls[i];
        }
        return sum;
    }

    /// Of a frame in which a light has moved, on a GPU.
    Chain of_moved_light(const Configuration& configuration) {
        Renderer renderer(counting(context->get_proc()), RendererOptions{.keeps_gl_state = false});
        pretend(renderer, false, endless_loops);
        REQUIRE(renderer.configure(configuration).empty());
        Scene scene = cornell_box();
        const RenderTarget target(device, {160, 120});
        for (int frame = 0; frame < 2; ++frame) {
            scene.world.edit<Transform>(scene.light, [](Transform& pose) { pose.translation.x += 0.01F; });
            chain = {};
            renderer.render(scene.world, scene.camera, target.target());
        }
        return chain;
    }

    /// Labels of the programs that are compiled for a scene, but used by none of its first frames.
    std::vector<std::string> unused(Scene scene, bool software) {
        static_cast<void>(RecordedPrograms::take());
        used_programs.clear();
        Renderer renderer(counting(RecordedPrograms::recording(context->get_proc())));
        const RenderTarget target(device, {64, 48});
        const RenderView view{.camera = scene.camera, .target = target.target()};
        pretend(renderer, software);
        REQUIRE(renderer.prepare(Configuration{}, scene.world, {&view, 1}).empty());
        REQUIRE(renderer.configure(Configuration{}).empty());
        for (int frame = 0; frame < 3; ++frame) {
            scene.world.edit<Transform>(scene.camera, [](Transform& pose) { pose.translation.x += 0.01F; });
            renderer.render(scene.world, scene.camera, target.target());
        }
        const std::vector<RecordedProgram> programs = RecordedPrograms::take();
        REQUIRE(programs.size() > 10);
        std::vector<std::string> labels;
        for (const RecordedProgram& program : programs) {
            if (!used_programs.contains(program.name)) labels.push_back(program.label);
        }
        return labels;
    }

    Picture picture;  ///< of the last frame
};

}  // namespace

TEST_CASE_FIXTURE(GlCalls,
                  "a still frame asks the driver for its state only to restore it, if the host wishes") {
    const Calls kept = of_still_frame(true);
    const Picture same = picture;
    const Calls not_kept = of_still_frame(false);
    MESSAGE(kept.all, " calls, ", kept.queries, " queries; without keeping state ", not_kept.all, ", ",
            not_kept.queries);
    // Whether the context is the renderer's, whether times have arrived; and what is bound and set.
    CHECK(not_kept.queries <= 30);
    CHECK(not_kept.all <= 150);
    CHECK(picture == same);
}

TEST_CASE_FIXTURE(GlCalls, "a light that moves is a short chain of work, of which little is small") {
    for (const bool guided : {false, true}) {
        Configuration configuration;
        configuration.vpls.guided = guided;
        const Chain chain_of_light = of_moved_light(configuration);
        MESSAGE(chain_of_light.steps, " steps, ", chain_of_light.small_dispatches, " small dispatches");
        // A GPU takes some microseconds from a step to the next. A guide has its light found before.
        CHECK(chain_of_light.steps <= (guided ? 36 : 20));
        CHECK(chain_of_light.small_dispatches <= (guided ? 27 : 15));
    }
}

TEST_CASE_FIXTURE(GlCalls, "nothing is compiled that no frame uses") {
    // What objects, lights and panes need that come or move later, without a wait for the compiler.
    const std::set<std::string> of_later_frames{
        "surfels/surfel_kept.comp", "shading/add_part.comp",
        "lights/shadow_maps.vert and lights/shadow_maps.geom and lights/shadow_maps.frag"};
    for (const char* const name : {"cornell", "house", "helmet", "glass", "hall-256", "court", "lamp"}) {
        for (const bool software : {true, false}) {
            CAPTURE(name);
            CAPTURE(software);
            for (const std::string& label : unused(shipped_scene(name), software)) {
                CAPTURE(label);
                CHECK(of_later_frames.contains(label));
            }
        }
    }
}

}  // TEST_SUITE("GL calls")
