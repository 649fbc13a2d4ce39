#pragma once

#include <string_view>

#include "tests/study/reference_files.hpp"

namespace candela::study {

/// Identifies the path tracer's sources.
[[nodiscard]] std::string_view tracer_name();

/// Traces the request as seen by the world's first camera. Throws std::invalid_argument if there is none.
[[nodiscard]] Reference trace_request(const World& world, const Request& request);

}  // namespace candela::study
