#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace candela {

/// Characters of a text from outside that messages quote.
inline constexpr std::size_t longest_quote = 200;

/// Text from outside as a message may quote it: control characters as \x1B, and cut, with "..." at the end,
/// at `longest` bytes, but not inside a UTF-8 character.
[[nodiscard]] inline std::string readable(std::string_view text, std::size_t longest = longest_quote) {
    std::size_t end = std::min(text.size(), longest);
    while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    std::string shown;
    for (const char c : text.substr(0, end)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20U || byte == 0x7FU) {
            shown += fmt::format("\\x{:02X}", byte);
        } else {
            shown += c;
        }
    }
    return end < text.size() ? shown + "..." : shown;
}

/// The number with commas: 1,234,567.
[[nodiscard]] inline std::string grouped(std::uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        text += i > 0 && (digits.size() - i) % 3 == 0 ? "," : "";
        text += digits[i];
    }
    return text;
}

/// The first ten lines, and how many more there are in a last one.
[[nodiscard]] inline std::vector<std::string> first_ten(std::vector<std::string> lines) {
    constexpr std::size_t shown = 10;
    if (lines.size() > shown) {
        const std::size_t more = lines.size() - shown;
        lines.resize(shown);
        lines.push_back(fmt::format("and {} more", grouped(more)));
    }
    return lines;
}

}  // namespace candela
