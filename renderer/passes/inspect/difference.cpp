#include "renderer/passes/inspect/difference.hpp"

#include "shaders/bindings.glsl"

namespace candela {

void draw_difference(Gpu& gpu, const ComparedPictures& pictures, float factor, const Target& target) {
    const glm::ivec2 origin(target.origin);
    const glm::ivec2 size(target.size);
    gpu.gl().BindTextureUnit(UNIT_FIRST_PICTURE, pictures.first);
    gpu.gl().BindTextureUnit(UNIT_SECOND_PICTURE, pictures.second);
    gpu.nearest().bind(UNIT_FIRST_PICTURE);
    gpu.nearest().bind(UNIT_SECOND_PICTURE);
    gpu.gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
    gpu.gl().Viewport(origin.x, origin.y, size.x, size.y);
    const gl::Program& program = gpu.program({"output/fullscreen.vert", "inspect/difference.frag"});
    program.set("target_origin", glm::vec2(origin));
    program.set("factor", factor);
    gpu.draw_fullscreen(program);
}

}  // namespace candela
