#include "renderer/passes/inspect/difference.hpp"

#include "shaders/bindings.glsl"

namespace candela {

void draw_difference(Gpu& gpu, const ComparedPictures& pictures, float factor, const Target& target) {
    gpu.gl().BindTextureUnit(UNIT_FIRST_PICTURE, pictures.first);
    gpu.gl().BindTextureUnit(UNIT_SECOND_PICTURE, pictures.second);
    gpu.nearest().bind(UNIT_FIRST_PICTURE);
    gpu.nearest().bind(UNIT_SECOND_PICTURE);
    gpu.set_target(target);
    gpu.draw_fullscreen(gpu.programs().compiled({"output/fullscreen.vert", "inspect/difference.frag"}, {}),
                        {{"target_origin", glm::vec2(target.origin)}, {"factor", factor}});
}

}  // namespace candela
