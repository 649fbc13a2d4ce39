#pragma once

#include <exception>

#include "tests/study/bench.hpp"
#include "tests/study/points.hpp"

namespace candela::study {

/// What the point asks for, with its first seed, showing all light. Throws std::invalid_argument with the
/// faults.
[[nodiscard]] Configuration configuration_of(const Point& point);

/// What the bench's last frame shows. Throws std::runtime_error where a pixel is not finite.
[[nodiscard]] sandbox::Picture finite_picture(Bench& bench);

/// Prints what `make_line` gives, or that the point failed; true if it did not.
template <class MakeLine>
bool attempt(const Point& point, MakeLine make_line) {
    try {
        print_line(make_line());
        return true;
    } catch (const std::exception& error) {
        print_line({{"id", point.id}, {"kind", "failed"}, {"message", error.what()}});
        return false;
    }
}

}  // namespace candela::study
