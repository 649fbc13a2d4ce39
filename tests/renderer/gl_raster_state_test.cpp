#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "renderer/gl/raster_state.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gl raster state") {

using namespace candela;
using namespace candela::gl;

namespace {

constexpr std::array states{
    RasterState{}, RasterState{.depth_test = DepthTest::nearer},
    RasterState{.depth_test = DepthTest::equal, .writes_depth = false, .blending = Blending::add},
    RasterState{.depth_test = DepthTest::always, .culling = Culling::back},
    RasterState{.blending = Blending::cover, .culling = Culling::front, .clockwise_front = true}};

constexpr std::array<GLenum, 5> capabilities{GL_DEPTH_TEST, GL_DEPTH_CLAMP, GL_POLYGON_OFFSET_FILL, GL_BLEND,
                                             GL_CULL_FACE};

GLint get(const Functions& gl, GLenum what) {
    GLint value = 0;
    gl.GetIntegerv(what, &value);
    return value;
}

/// What the context draws with.
std::vector<GLint> state_of(const Functions& gl) {
    std::vector<GLint> state;
    for (const GLenum capability : capabilities) {
        state.push_back(gl.IsEnabled(capability));
    }
    constexpr std::array<GLenum, 6> values{GL_DEPTH_WRITEMASK, GL_FRONT_FACE,      GL_BLEND_SRC_RGB,
                                           GL_BLEND_DST_RGB,   GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA};
    for (const GLenum what : values) {
        state.push_back(get(gl, what));
    }
    state.push_back(gl.IsEnabled(GL_DEPTH_TEST) == GL_TRUE ? get(gl, GL_DEPTH_FUNC) : 0);
    state.push_back(gl.IsEnabled(GL_CULL_FACE) == GL_TRUE ? get(gl, GL_CULL_FACE_MODE) : 0);
    state.push_back(gl.IsEnabled(GL_BLEND) == GL_TRUE ? get(gl, GL_BLEND_EQUATION_RGB) : 0);
    return state;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "a state sets what it says") {
    const Functions& gl = device.gl();
    device.reset_raster_state();
    device.set_raster_state({.depth_test = DepthTest::equal,
                             .writes_depth = false,
                             .blending = Blending::cover,
                             .culling = Culling::front,
                             .clockwise_front = true});
    CHECK(state_of(gl) == std::vector<GLint>{1, 0, 0, 1, 1, 0, GL_CW, GL_ONE, GL_ONE_MINUS_SRC1_COLOR, GL_ONE,
                                             GL_ONE_MINUS_SRC1_COLOR, GL_EQUAL, GL_FRONT, GL_FUNC_ADD});
}

TEST_CASE_FIXTURE(GlFixture, "a state is the same whichever one was set before") {
    const Functions& gl = device.gl();
    for (const RasterState& state : states) {
        device.reset_raster_state();
        device.set_raster_state(state);
        const std::vector<GLint> after_reset = state_of(gl);
        for (const RasterState& before : states) {
            device.set_raster_state(before);
            device.set_raster_state(state);
            CHECK(state_of(gl) == after_reset);
        }
    }
}

TEST_CASE_FIXTURE(GlFixture, "a reset sets the default, also where others have changed the state") {
    const Functions& gl = device.gl();
    device.reset_raster_state();
    const std::vector<GLint> initial = state_of(gl);
    CHECK(initial == std::vector<GLint>{0, 0, 0, 0, 0, 1, GL_CCW, GL_ONE, GL_ZERO, GL_ONE, GL_ZERO, 0, 0, 0});
    for (const GLenum capability : capabilities) {
        gl.Enable(capability);
    }
    gl.DepthMask(GL_FALSE);
    gl.FrontFace(GL_CW);
    gl.BlendFuncSeparate(GL_ZERO, GL_ONE, GL_ZERO, GL_ONE);
    device.reset_raster_state();
    CHECK(state_of(gl) == initial);
}

}  // TEST_SUITE("gl raster state")
