#include "renderer/gpu/loop_parts.hpp"

namespace candela {

std::vector<gl::Uniforms> loop_parts(std::uint32_t count, std::uint32_t most) {
    std::vector<gl::Uniforms> parts;
    for (std::uint32_t first = 0; first == 0 || first < count; first += most) {
        parts.push_back({{"part_first", first}, {"part_size", most}});
    }
    return parts;
}

}  // namespace candela
