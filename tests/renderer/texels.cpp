#include "tests/renderer/texels.hpp"

#include <doctest/doctest.h>

#include <glm/vec4.hpp>

namespace candela {
namespace {

std::vector<float> read_texture(const gl::Functions& gl, const ResultTexture& result, GLenum layout,
                                std::size_t channels) {
    REQUIRE(result.texture != 0);
    std::vector<float> values(static_cast<std::size_t>(result.size.x) * result.size.y * channels);
    gl.GetTextureSubImage(result.texture, 0, 0, 0, 0, static_cast<GLsizei>(result.size.x),
                          static_cast<GLsizei>(result.size.y), 1, layout, GL_FLOAT,
                          static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

}  // namespace

std::vector<glm::vec4> texels(const gl::Functions& gl, const ResultTexture& result) {
    const std::vector<float> values = read_texture(gl, result, GL_RGBA, 4);
    std::vector<glm::vec4> read;
    for (std::size_t i = 0; i < values.size(); i += 4) {
        read.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    }
    return read;
}

std::vector<glm::vec4> depths(const gl::Functions& gl, const ResultTexture& result) {
    std::vector<glm::vec4> read;
    for (const float depth : read_texture(gl, result, GL_DEPTH_COMPONENT, 1)) {
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

}  // namespace candela
