#include "renderer/passes/sky/background.hpp"

#include <algorithm>
#include <vector>

#include <glm/gtc/packing.hpp>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "shaders/bindings.glsl"

namespace candela {
namespace {

constexpr float most_half = 65504.0F;

/// Four half floats for each of `width` texels.
std::vector<std::uint64_t> packed_row(const SkyPicture& picture, std::uint32_t row) {
    std::vector<std::uint64_t> packed;
    packed.reserve(picture.width);
    const auto first = picture.texels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * picture.width);
    std::transform(first, first + picture.width, std::back_inserter(packed), [](glm::vec3 texel) {
        return glm::packHalf4x16(glm::vec4(glm::min(texel, glm::vec3(most_half)), 1.0F));
    });
    return packed;
}

/// Row by row, so that no second copy of the picture is needed.
void upload_picture(const gl::Functions& gl, GLuint texture, const SkyPicture& picture) {
    for (std::uint32_t row = 0; row < picture.height; ++row) {
        const std::vector<std::uint64_t> packed = packed_row(picture, row);
        gl.TextureSubImage2D(texture, 0, 0, static_cast<GLint>(row), static_cast<GLsizei>(picture.width), 1,
                             GL_RGBA, GL_HALF_FLOAT, packed.data());
    }
}

}  // namespace

TextureHandle add_sky_picture(FrameGraph& graph, Gpu& gpu, const Sky& sky) {
    return graph.add("sky-picture", [&](Pass& pass) {
        pass.read(sky.picture);
        const auto out = pass.write(
            graph.texture("sky picture", {{1, 1}, Format::rgba16f}, Lifetime::persistent), Usage::copy);
        pass.run([=, &gpu](Execution& run) {
            static const SkyPicture white{1, 1, {glm::vec3(1.0F)}};
            const auto& given = run.value(sky.picture);
            const SkyPicture& picture = given ? *given : white;
            run.reserve(out, {{picture.width, picture.height}, Format::rgba16f});
            upload_picture(gpu.gl(), run.object(out), picture);
        });
        return out;
    });
}

gl::Uniforms sky_uniforms(const Environment& environment) {
    return {{"radiance_scale", environment.radiance}, {"rotation", environment.rotation}};
}

TextureHandle add_background(FrameGraph& graph, Gpu& gpu, const Sky& sky, TextureHandle picture,
                             const ViewData& view, const Surfaces& surfaces, TextureHandle radiance) {
    return graph.add("background", [&](Pass& pass) {
        pass.note(Workload::pixels);
        pass.read(sky.environment);
        pass.read(picture, {Usage::sampled, UNIT_SKY});
        read_view(pass, view);
        test_depth(pass, surfaces);
        const gl::Program& program = gpu.program({"output/fullscreen.vert", "sky/background.frag"});
        const TextureHandle out = pass.write(radiance, Usage::colour_target);
        pass.run([=, &gpu, &program](Execution& run) {
            gpu.draw_fullscreen(
                program, sky_uniforms(run.value(sky.environment)),
                {.depth_test = gl::DepthTest::equal, .writes_depth = false});  // depth 0: no surface
        });
        return out;
    });
}

}  // namespace candela
