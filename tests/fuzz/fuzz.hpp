#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "engine/readable.hpp"

namespace candela::fuzz {

/// Ends the program if a property does not hold; libFuzzer then saves the input.
inline void require(bool holds, std::string_view property) {
    if (!holds) {
        std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(property.size()), property.data());
        std::abort();
    }
}

/// A message is one line of text without control characters, and of a length that can be read.
inline void require_readable(std::string_view message) {
    require(!message.empty(), "a message has text");
    require(message.size() < 2000, "a message is short");
    require(readable(message, message.size()) == message, "a message has no control characters");
}

}  // namespace candela::fuzz

/// Called by libFuzzer for each input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
