#include "renderer/passes/receivers/point_lighting.hpp"

#include "shaders/bindings.glsl"

namespace candela {

struct PointLighting::Parts {
    const Gpu* gpu;
    Lighting lighting;
};

static_assert(PointLighting::free_storage_bindings > BINDING_LIT_POINTS &&
              PointLighting::free_storage_bindings + 3 < BINDING_LIT_EMITTERS);
static_assert(PointLighting::free_uniform_bindings > UNIFORMS_LAST);
static_assert(PointLighting::free_texture_units > UNIT_LIT_POINTS);

PointLighting make_point_lighting(const Gpu& gpu, const Lighting& lighting) {
    return PointLighting(std::make_shared<const PointLighting::Parts>(PointLighting::Parts{&gpu, lighting}));
}

std::string PointLighting::glsl() const {
    return parts_->gpu->programs().source_part(
        "receivers/point_lighting.glsl", lighting_variant(parts_->gpu->device().limits(), parts_->lighting));
}

void PointLighting::read(Pass& pass) const {
    read_lighting(pass, parts_->lighting);
}

}  // namespace candela
