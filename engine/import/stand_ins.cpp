#include "engine/import/stand_ins.hpp"

#include <cstdint>

namespace candela::gltf {

namespace {

/// Magenta and black squares, of which eight fit into a row.
std::shared_ptr<const Image> make_checker() {
    constexpr std::uint32_t side = 32;
    constexpr std::uint32_t square = side / 8;
    auto image = std::make_shared<Image>();
    image->width = side;
    image->height = side;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const bool is_magenta = (x / square + y / square) % 2 == 0;
            image->texels.push_back(is_magenta ? glm::u8vec4(255, 0, 255, 255) : glm::u8vec4(0, 0, 0, 255));
        }
    }
    return image;
}

std::shared_ptr<const Image> make_black() {
    auto image = std::make_shared<Image>();
    image->width = 1;
    image->height = 1;
    image->texels = {glm::u8vec4(0, 0, 0, 255)};
    return image;
}

}  // namespace

std::shared_ptr<const Image> StandIns::image(StandIn kind) {
    switch (kind) {
        case StandIn::checker:
            if (!checker_) checker_ = make_checker();
            return checker_;
        case StandIn::black:
            if (!black_) black_ = make_black();
            return black_;
        default:
            return nullptr;
    }
}

std::string_view consequence(StandIn kind) {
    switch (kind) {
        case StandIn::checker:
            return "a checker pattern takes its place";
        case StandIn::black:
            return "it is taken to be black";
        default:
            return "it is left out";
    }
}

}  // namespace candela::gltf
