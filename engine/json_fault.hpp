#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace candela {

/// What is wrong with text that could not be parsed, in one line: "invalid JSON: parse error at line 2,
/// column 7: ..." and what was expected there. Does not quote the text, except a number too large for a
/// double, which has no place.
inline std::string json_fault(const nlohmann::json::exception& error) {
    const std::string_view message = error.what();
    const std::size_t prefix = message.find("] ");  // [json.exception.parse_error.101]
    std::string fault(message.substr(prefix == std::string_view::npos ? 0 : prefix + 2));
    if (const std::size_t quote = fault.find("; last read: "); quote != std::string::npos) {
        const std::size_t expected = fault.rfind("; expected ");
        fault.erase(quote, expected == std::string::npos || expected < quote ? expected : expected - quote);
    }
    return "invalid JSON: " + fault;
}

}  // namespace candela
