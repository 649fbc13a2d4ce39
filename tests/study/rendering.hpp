#pragma once

#include <exception>

#include "tests/study/bench.hpp"
#include "tests/study/points.hpp"

namespace candela::study {

/// The configuration of the point, with its first seed, showing all light. Throws std::invalid_argument with
/// the errors.
[[nodiscard]] Configuration configuration_of(const Point& point);

/// The picture of the bench's last frame. Throws std::runtime_error if a pixel is not finite.
[[nodiscard]] tools::Picture finite_picture(Bench& bench);

/// Prints the result of `make_line`, or that the point failed; returns whether it succeeded.
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
