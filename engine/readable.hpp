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

/// The bytes of the UTF-8 character that `text` begins with, 1 to 4; 0 if it begins with none.
[[nodiscard]] inline std::size_t utf8_length(std::string_view text) {
    const auto first = static_cast<unsigned char>(text.front());
    const std::size_t length = first < 0x80U   ? 1
                               : first < 0xC2U ? 0
                               : first < 0xE0U ? 2
                               : first < 0xF0U ? 3
                               : first < 0xF5U ? 4
                                               : 0;
    const std::string_view rest = text.substr(0, length).substr(std::min<std::size_t>(length, 1));
    const bool is_whole = text.size() >= length && std::ranges::all_of(rest, [](char c) {
                              return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
                          });
    return is_whole ? length : 0;
}

/// Whether a terminal would act on it instead of showing it: control characters (C0, DEL, C1), line
/// separators, and what sets the direction of writing.
[[nodiscard]] inline bool is_control(std::string_view character) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
    if (character.size() == 1) return byte(0) < 0x20U || byte(0) == 0x7FU;
    if (character.size() == 2) return byte(0) == 0xC2U && byte(1) < 0xA0U;
    if (character.size() != 3 || byte(0) != 0xE2U) return false;
    const bool separator_or_direction = byte(1) == 0x80U && byte(2) >= 0xA8U && byte(2) <= 0xAEU;
    const bool mark = byte(1) == 0x80U && (byte(2) == 0x8EU || byte(2) == 0x8FU);
    const bool isolate = byte(1) == 0x81U && byte(2) >= 0xA6U && byte(2) <= 0xA9U;
    return separator_or_direction || mark || isolate;
}

/// Text from outside as a message may quote it: control characters and what is not UTF-8 as \x1B, byte by
/// byte, and cut, with "..." at the end, after at most `longest` bytes of `text`, but not inside a character.
[[nodiscard]] inline std::string readable(std::string_view text, std::size_t longest = longest_quote) {
    std::string shown;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t length = utf8_length(text.substr(at));
        const std::string_view character = text.substr(at, std::max<std::size_t>(length, 1));
        if (at + character.size() > longest) return shown + "...";
        if (length > 0 && !is_control(character)) {
            shown += character;
        } else {
            for (const char c : character) shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
        }
        at += character.size();
    }
    return shown;
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
