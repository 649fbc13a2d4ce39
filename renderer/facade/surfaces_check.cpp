#include "renderer/facade/surfaces_check.hpp"

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "renderer/facade/target_check.hpp"
#include "renderer/gl/texture.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

/// One of the host's textures, as messages call it.
struct HostTexture {
    std::uint32_t name;
    std::string_view what;

    [[noreturn]] void refuse(std::string_view why) const {
        throw gl::GlError(fmt::format("{}, texture {}, {}", what, name, why));
    }
};

/// What a format has to have.
struct Needs {
    std::uint32_t channels = 1;
    bool sign = false;
    bool linear = false;
};

/// Not GL_TEXTURE_TARGET, which compatibility profiles of Mesa do not know.
bool is_flat(const gl::Functions& gl, std::uint32_t texture) {
    gl.BindTextureUnit(UNIT_DEPTH, texture);
    gl.ActiveTexture(GL_TEXTURE0 + UNIT_DEPTH);
    return gl::get_unsigned(gl, GL_TEXTURE_BINDING_2D) == texture;
}

gl::TextureTraits existing(const gl::Device& device, const HostTexture& texture) {
    require_texture(device, texture.name, texture.what);
    if (!is_flat(device.gl(), texture.name)) texture.refuse("is not a 2D texture");
    const gl::TextureTraits traits = gl::traits_of(device.gl(), texture.name);
    if (traits.size.x == 0 || traits.size.y == 0) texture.refuse("has no storage");
    return traits;
}

void require_colours(const gl::Device& device, const HostTexture& texture, glm::uvec2 size,
                     const Needs& needs) {
    const gl::TextureTraits traits = existing(device, texture);
    require_texture(device, texture.name, size, texture.what);
    if (traits.depth) texture.refuse("holds depth");
    if (traits.integers) texture.refuse("holds integers");
    if (traits.channels < needs.channels) {
        texture.refuse(
            fmt::format("has {} of the {} channels that are read", traits.channels, needs.channels));
    }
    if (needs.sign && !traits.has_sign) {
        texture.refuse("cannot hold values below 0, as its NormalEncoding needs");
    }
    if (needs.linear && traits.srgb) texture.refuse("is read with an sRGB curve");
}

}  // namespace

void require_readable(const gl::Device& device, const HostSurfaces& surfaces) {
    const HostTexture depth{surfaces.depth, "the host's depth"};
    const gl::TextureTraits traits = existing(device, depth);
    if (traits.integers || (!traits.depth && traits.channels != 1)) {
        depth.refuse("has neither a depth format nor one with a single channel of numbers from 0 to 1");
    }
    const bool octahedral = surfaces.normal_encoding == NormalEncoding::octahedral;
    require_colours(device, {surfaces.normal, "the host's normals"}, traits.size,
                    {.channels = octahedral ? 2U : 3U,
                     .sign = surfaces.normal_encoding != NormalEncoding::unsigned_xyz,
                     .linear = true});
    require_colours(device, {surfaces.albedo, "the host's albedo"}, traits.size, {.channels = 3});
    if (surfaces.material == 0) return;
    require_colours(device, {surfaces.material, "the host's material"}, traits.size, {.channels = 2});
}

}  // namespace candela
