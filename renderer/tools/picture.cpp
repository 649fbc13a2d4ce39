#include <candela/tools/picture.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include <candela/scene/scene_error.hpp>
#include <candela/tools/output_file.hpp>
#include <candela/tools/tool_error.hpp>
#include "engine/import/exr.hpp"

namespace candela::tools {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "PFM is written as memory holds floats");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

[[noreturn]] void fail(const fs::path& path, std::string_view error) {
    throw ToolError(fmt::format("{}: {}", path.string(), error));
}

void require_size(const fs::path& path, glm::ivec2 size, std::size_t pixels) {
    const bool is_sized = size.x > 0 && size.y > 0;
    if (is_sized && static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) == pixels) return;
    fail(path, fmt::format("{} pixels do not make a picture of {}x{}", pixels, size.x, size.y));
}

}  // namespace

std::vector<std::uint8_t> rgb_of_texels(glm::uvec2 size, std::span<const glm::vec4> texels) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * texels.size());
    for (std::uint32_t y = size.y; y-- > 0;) {
        for (const glm::vec4& texel : texels.subspan(static_cast<std::size_t>(y) * size.x, size.x)) {
            for (const float channel : {texel.r, texel.g, texel.b}) {
                rgb.push_back(
                    static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(channel, 0.0F, 1.0F))));
            }
        }
    }
    return rgb;
}

Picture flipped(Picture picture) {
    const auto row = [&](int y) {
        return picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.size.x;
    };
    for (int y = 0; y < picture.size.y / 2; ++y) {
        std::swap_ranges(row(y), row(y + 1), row(picture.size.y - 1 - y));
    }
    return picture;
}

void write_png(const fs::path& path, glm::ivec2 size, std::span<const std::uint8_t> rgb) {
    require_size(path, size, rgb.size() / 3);
    std::vector<char> png;
    const auto store = [](void* context, void* data, int length) {
        const auto* bytes = static_cast<const char*>(data);
        static_cast<std::vector<char>*>(context)->assign(bytes, bytes + length);
    };
    if (stbi_write_png_to_func(store, &png, size.x, size.y, 3, rgb.data(), 3 * size.x) == 0) {
        fail(path, "cannot be encoded as PNG");
    }
    write_file(path, std::as_bytes(std::span(png)));
}

void write_exr(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    try {
        const glm::uvec2 size(picture.size);
        write_file(path, encode_exr(size.x, size.y, picture.pixels));
    } catch (const SceneError& error) {
        fail(path, error.what());
    }
}

void write_pfm(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    std::string file = fmt::format("PF\n{} {}\n-1.0\n", picture.size.x, picture.size.y);
    const Picture from_bottom = flipped(picture);
    const auto pixels = std::as_bytes(std::span(from_bottom.pixels));
    file.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
    write_file(path, std::as_bytes(std::span(file)));
}

}  // namespace candela::tools
