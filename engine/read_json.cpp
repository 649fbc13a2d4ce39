#include "engine/read_json.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/readable.hpp"

namespace candela {

namespace {

/// How deeply arrays and objects are nested. The parser could ask after each value, but then it looks at all
/// items of an array after each object in it.
std::ptrdiff_t depth_of(std::string_view text) {
    std::ptrdiff_t depth = 0;
    std::ptrdiff_t deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') in_string = !in_string;
        if (in_string && c == '\\') ++i;
        if (in_string) continue;
        if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
        if (c == ']' || c == '}') --depth;
    }
    return deepest;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
    if (depth_of(text) > 256) throw std::runtime_error("its JSON is nested too deeply");
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        const std::string_view message = error.what();  // [json.exception.parse_error.101] ...
        const std::string_view fault = message.substr(message.find("] ") + 2);
        throw std::runtime_error(
            fmt::format("invalid JSON: {}", readable(fault.substr(0, fault.find("; last read: ")))));
    }
}

const nlohmann::json* find_member(const nlohmann::json& object, std::string_view path) {
    const std::size_t dot = path.find('.');
    const auto member = object.find(path.substr(0, dot));
    if (member == object.end()) return nullptr;
    return dot == std::string_view::npos ? &*member : find_member(*member, path.substr(dot + 1));
}

}  // namespace candela
