#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <candela/scene/components.hpp>

namespace candela {

/// What each of the 256 values of a red, green or blue channel of an image stands for, from 0 to 1. Decodes
/// sRGB by IEC 61966-2-1.
[[nodiscard]] inline std::array<double, 256> decoded_values(Encoding encoding) {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double stored = static_cast<double>(i) / 255.0;
        const bool is_linear = encoding == Encoding::linear;
        const double colour = stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
        values[i] = is_linear ? stored : colour;
    }
    return values;
}

}  // namespace candela
