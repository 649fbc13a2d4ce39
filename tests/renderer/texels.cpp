#include "tests/renderer/texels.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "renderer/gl/texture.hpp"

namespace candela {
namespace {

std::vector<float> read_depth(const gl::Functions& gl, const ResultTexture& result) {
    REQUIRE(result.texture != 0);
    std::vector<float> values(static_cast<std::size_t>(result.size.x) * result.size.y);
    gl.GetTextureSubImage(result.texture, 0, 0, 0, 0, static_cast<GLsizei>(result.size.x),
                          static_cast<GLsizei>(result.size.y), 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                          static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

}  // namespace

std::vector<glm::vec4> texels(const gl::Functions& gl, const ResultTexture& result) {
    REQUIRE(result.texture != 0);
    return gl::read_texels(gl, result.texture, result.size);
}

std::vector<glm::vec4> depths(const gl::Functions& gl, const ResultTexture& result) {
    std::vector<glm::vec4> read;
    for (const float depth : read_depth(gl, result)) {
        read.emplace_back(depth, 0.0F, 0.0F, 1.0F);
    }
    return read;
}

Picture picture_of(const gl::Functions& gl, const ResultTexture& radiance) {
    Picture picture{radiance.size, {}};
    for (const glm::vec4& texel : texels(gl, radiance)) {
        picture.pixels.emplace_back(texel);
    }
    return picture;
}

glm::vec3 decoded_normal(glm::vec2 p) {
    glm::vec3 n(p, 1.0F - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0F) {
        n.x = std::copysign(1.0F - std::abs(p.y), p.x);
        n.y = std::copysign(1.0F - std::abs(p.x), p.y);
    }
    return glm::normalize(n);
}

}  // namespace candela
