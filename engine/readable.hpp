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

/// The bytes of the UTF-8 character that `text`, which is not empty, begins with, 1 to 4; 0 if it begins with
/// none. The Unicode Standard, table 3-7.
[[nodiscard]] inline std::size_t utf8_length(std::string_view text) {
    const auto is_within = [text](std::size_t i, unsigned least, unsigned most) {
        const unsigned byte = i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
        return byte >= least && byte <= most;
    };
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x80U) return 1;
    if (first < 0xC2U || first > 0xF4U) return 0;
    // Limits of the second byte: neither longer than needed, nor a surrogate, nor beyond U+10FFFF.
    const unsigned least = first == 0xE0U ? 0xA0U : first == 0xF0U ? 0x90U : 0x80U;
    const unsigned most = first == 0xEDU ? 0x9FU : first == 0xF4U ? 0x8FU : 0xBFU;
    const std::size_t length = first < 0xE0U ? 2 : first < 0xF0U ? 3 : 4;
    const bool is_whole = is_within(1, least, most) && (length < 3 || is_within(2, 0x80U, 0xBFU)) &&
                          (length < 4 || is_within(3, 0x80U, 0xBFU));
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
