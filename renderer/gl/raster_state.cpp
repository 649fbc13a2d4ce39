#include "renderer/gl/raster_state.hpp"

namespace candela::gl {
namespace {

GLenum depth_func(DepthTest test) {
    switch (test) {
        case DepthTest::equal:
            return GL_EQUAL;
        case DepthTest::always:
            return GL_ALWAYS;
        case DepthTest::off:
        case DepthTest::nearer:
            break;
    }
    return GL_GREATER;
}

void set_depth_test(const Functions& gl, DepthTest test) {
    set_enabled(gl, GL_DEPTH_TEST, test != DepthTest::off);
    gl.DepthFunc(depth_func(test));
}

void set_blending(const Functions& gl, Blending blending) {
    set_enabled(gl, GL_BLEND, blending != Blending::off);
    switch (blending) {
        case Blending::off:
            // Mesa rejects draws to several targets while factors use a second output, even without blending.
            gl.BlendFunc(GL_ONE, GL_ZERO);
            return;
        case Blending::add:
            gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ZERO);
            break;
        case Blending::cover:
            gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC1_COLOR);
            break;
    }
    gl.BlendEquation(GL_FUNC_ADD);
}

void set_culling(const Functions& gl, Culling culling) {
    set_enabled(gl, GL_CULL_FACE, culling != Culling::off);
    gl.CullFace(culling == Culling::front ? GL_FRONT : GL_BACK);
}

}  // namespace

void RasterStates::reset(const Functions& gl) {
    now_ = {};
    set_depth_test(gl, now_.depth_test);
    gl.DepthMask(GL_TRUE);
    gl.Disable(GL_DEPTH_CLAMP);
    gl.Disable(GL_POLYGON_OFFSET_FILL);
    set_blending(gl, now_.blending);
    set_culling(gl, now_.culling);
    gl.FrontFace(GL_CCW);
}

void RasterStates::set(const Functions& gl, const RasterState& state) {
    if (state.depth_test != now_.depth_test) set_depth_test(gl, state.depth_test);
    if (state.writes_depth != now_.writes_depth) gl.DepthMask(state.writes_depth ? GL_TRUE : GL_FALSE);
    if (state.blending != now_.blending) set_blending(gl, state.blending);
    if (state.culling != now_.culling) set_culling(gl, state.culling);
    if (state.clockwise_front != now_.clockwise_front) gl.FrontFace(state.clockwise_front ? GL_CW : GL_CCW);
    now_ = state;
}

}  // namespace candela::gl
