#include "renderer/gpu/layer_target.hpp"

namespace candela {

LayerTarget::~LayerTarget() {
    gpu_.gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gpu_.layer_target().attach_depth(0);
}

void LayerTarget::set_layer(ObjectId texture, std::uint32_t layer, std::uint32_t side) {
    gpu_.layer_target().attach_depth_layer(texture, layer);
    gpu_.layer_target().bind();
    gpu_.gl().Viewport(0, 0, static_cast<GLsizei>(side), static_cast<GLsizei>(side));
}

void LayerTarget::clear() const {
    const float far = 0.0F;
    gpu_.gl().ClearBufferfv(GL_DEPTH, 0, &far);
}

}  // namespace candela
