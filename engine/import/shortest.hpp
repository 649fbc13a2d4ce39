#pragma once

#include <array>
#include <charconv>

namespace candela {

/// The double with the fewest digits that becomes `number` when it is rounded to a float.
[[nodiscard]] inline double shortest(float number) {
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    double read = 0.0;
    std::from_chars(digits.data(), written.ptr, read);
    // Rounding to a double first and to a float then may, in rare cases, differ from rounding once.
    return static_cast<float>(read) == number ? read : number;
}

}  // namespace candela
