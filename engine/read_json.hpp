#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace candela {

/// The value of a whole JSON text; of several members with the same name the last counts. Throws
/// std::runtime_error, whose one line does not quote the text except a number too large for a double:
/// "invalid JSON: parse error at line 2, column 7: ..."; also if arrays and objects are nested more than 256
/// deep.
[[nodiscard]] nlohmann::json parse_json(std::string_view text);

/// What a path of member names joined by dots leads to: "asset.version". Null if there is nothing.
[[nodiscard]] const nlohmann::json* find_member(const nlohmann::json& object, std::string_view path);

}  // namespace candela
