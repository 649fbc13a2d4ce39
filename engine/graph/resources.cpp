#include <candela/graph/resources.hpp>

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>
#include <glm/common.hpp>

namespace candela {
namespace {

struct FormatInfo {
    std::string_view name;
    std::uint32_t bytes;
};

const FormatInfo& info(Format format) {
    static constexpr std::array<FormatInfo, 10> formats{{{"rgba8", 4},
                                                         {"srgb8_alpha8", 4},
                                                         {"rgba16f", 8},
                                                         {"rgba32f", 16},
                                                         {"rg32f", 8},
                                                         {"r32f", 4},
                                                         {"rg16f", 4},
                                                         {"r16f", 2},
                                                         {"r32ui", 4},
                                                         {"depth32f", 4}}};
    return formats.at(static_cast<std::size_t>(format));
}

}  // namespace

std::string_view to_string(ResourceKind kind) {
    static constexpr std::array<std::string_view, 3> names{"texture", "buffer", "value"};
    return names.at(static_cast<std::size_t>(kind));
}

bool is_depth(Format format) {
    return format == Format::depth32f;
}

std::uint32_t bytes_per_texel(Format format) {
    return info(format).bytes;
}

std::string_view to_string(Format format) {
    return info(format).name;
}

std::string_view to_string(TextureShape shape) {
    static constexpr std::array<std::string_view, 3> names{"flat", "array", "cube array"};
    return names.at(static_cast<std::size_t>(shape));
}

std::string why_impossible(const TextureDesc& desc) {
    const std::uint32_t longer = std::max(desc.size.x, desc.size.y);
    if (std::min(desc.size.x, desc.size.y) == 0) {
        return fmt::format("its size is {}x{}", desc.size.x, desc.size.y);
    }
    if (desc.mips == 0 || desc.mips > static_cast<std::uint32_t>(std::bit_width(longer))) {
        return fmt::format("{}x{} texels have 1 to {} mip levels, not {}", desc.size.x, desc.size.y,
                           std::bit_width(longer), desc.mips);
    }
    if (desc.layers == 0) return "it has no layers";
    if (desc.shape == TextureShape::flat && desc.layers != 1) {
        return fmt::format("it is flat, but has {} layers", desc.layers);
    }
    if (desc.shape != TextureShape::cube_array) return "";
    if (desc.layers % 6 != 0) return fmt::format("cubes have six layers each, and it has {}", desc.layers);
    return desc.size.x == desc.size.y ? "" : "the sides of cubes are square";
}

std::uint64_t byte_size(const TextureDesc& desc) {
    std::uint64_t texels = 0;
    for (std::uint32_t mip = 0; mip < std::min(desc.mips, 32U); ++mip) {
        texels += std::uint64_t{std::max(1U, desc.size.x >> mip)} * std::max(1U, desc.size.y >> mip);
    }
    return texels * desc.layers * bytes_per_texel(desc.format);
}

std::uint64_t byte_size(const BufferDesc& desc) {
    return desc.count * desc.stride;
}

std::string_view to_string(Usage usage) {
    static constexpr std::array<std::string_view, 10> names{
        "sampled",  "storage",       "uniform",      "vertex",       "index",
        "indirect", "colour target", "depth target", "layer target", "copy"};
    return names.at(static_cast<std::size_t>(usage));
}

std::string_view to_string(Lifetime lifetime) {
    static constexpr std::array<std::string_view, 3> names{"transient", "persistent", "imported"};
    return names.at(static_cast<std::size_t>(lifetime));
}

}  // namespace candela
