// The GL calls of a frame in which nothing has changed: what a host pays for having Candela.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <numeric>
#include <string_view>

#include "renderer/gl/functions.hpp"
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

/// Counts the calls of one function of the driver's.
template <Index index, class Function>
struct Counted;
template <Index index, class Result, class... Arguments>
struct Counted<index, Result(APIENTRY*)(Arguments...)> {
    static inline Result(APIENTRY* driver)(Arguments...) = nullptr;
    static Result APIENTRY call(Arguments... arguments) {
        ++calls[index];
        return driver(arguments...);
    }
};

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

}  // TEST_SUITE("GL calls")
