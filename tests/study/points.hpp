#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/study/json_line.hpp"

namespace candela::study {

/// A configuration of the study's matrix.
struct Point {
    std::string id;       ///< unique, and part of file names
    std::string request;  ///< differences from the default configuration, as JSON; not validated
    std::vector<std::uint32_t> seeds{0};  ///< of the VPLs; never empty
    bool fresh_seeds = false;             ///< in an animation, a different seed for each frame
};

/// Reads [{"id": "...", "config": {...}, "seeds": [0, 1], "fresh_seeds": false}, ...]; all members except
/// `id` are optional. `name` is the name of the list in messages. Throws std::invalid_argument that names the
/// point and the error.
[[nodiscard]] std::vector<Point> read_points(const Json& json, std::string_view name);

}  // namespace candela::study
