#include "renderer/passes/scene/material_binding.hpp"

namespace candela {

void MaterialBinding::bind(const Gpu& gpu) const {
    for (std::size_t slot = 0; slot < textures.size(); ++slot) {
        const GLuint unit = material_image_slots[slot].unit;
        if (textures[slot]) {
            textures[slot]->texture.bind(unit);
            textures[slot]->sampler.bind(unit);
        } else {
            gpu.white().bind(unit);
            gpu.gl().BindSampler(unit, 0);
        }
    }
}

}  // namespace candela
