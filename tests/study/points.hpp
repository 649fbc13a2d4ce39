#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/study/json_line.hpp"

namespace candela::study {

/// A place in the study's matrix.
struct Point {
    std::string id;       ///< unique, and part of file names
    std::string request;  ///< what differs from the default configuration, as JSON; not yet checked
    std::vector<std::uint32_t> seeds{0};  ///< of the VPLs; never empty
    bool fresh_seeds = false;             ///< in an animation another seed for each frame
};

/// Reads [{"id": "...", "config": {...}, "seeds": [0, 1], "fresh_seeds": false}, ...]; all but `id` may be
/// left out. `name` stands for the list in messages. Throws std::invalid_argument that names the point and
/// the fault.
[[nodiscard]] std::vector<Point> read_points(const Json& json, std::string_view name);

}  // namespace candela::study
