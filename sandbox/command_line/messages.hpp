#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "sandbox/candela_private.hpp"

namespace candela::sandbox {

/// Bytes of a message that are shown at most: it may quote several names and paths.
inline constexpr std::size_t longest_message = 4000;

/// The message as one line of text that is safe for a terminal: line breaks become spaces, other control
/// characters are made visible.
[[nodiscard]] inline std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return readable(text, longest_message);
}

/// Prints an error or a warning on stderr, as one line.
inline void print_message(std::string_view message) {
    fmt::print(stderr, "candela: {}\n", one_line(std::string(message)));
}

}  // namespace candela::sandbox
