#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace candela {

/// What is wrong with text that could not be parsed, in one line: "invalid JSON: parse error at line 2,
/// column 7: ..." and what was expected there. A number too large for a double has no place, but is quoted.
inline std::string json_fault(const nlohmann::json::exception& error) {
    const std::string_view message = error.what();
    const std::size_t prefix = message.find("] ");  // [json.exception.parse_error.101]
    return "invalid JSON: " + std::string(message.substr(prefix == std::string_view::npos ? 0 : prefix + 2));
}

}  // namespace candela
