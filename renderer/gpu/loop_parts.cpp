#include "renderer/gpu/loop_parts.hpp"

#include <algorithm>

namespace candela {

std::vector<gl::Uniforms> loop_parts(const gl::Limits& limits, std::uint32_t count, std::uint32_t inner) {
    const auto most = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(limits.loop_iterations / inner, 1, std::max(count, 1U)));
    std::vector<gl::Uniforms> parts;
    for (std::uint32_t first = 0; first == 0 || first < count; first += most) {
        parts.push_back({{"part_first", first}, {"part_size", most}});
    }
    return parts;
}

}  // namespace candela
