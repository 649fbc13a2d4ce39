#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/study/measures.hpp"

namespace candela::study {

/// Members stay in the order in which they are written.
using Json = nlohmann::ordered_json;

/// JSON without line breaks. Throws std::domain_error that names the member if a number is NaN or infinite,
/// which JSON can only write as null.
[[nodiscard]] std::string to_line(const Json& json);

/// Prints the line and flushes it, so that finished results survive a crash.
void print_line(const Json& json);

/// Throws std::runtime_error that names the file if it cannot be read or is not valid JSON.
[[nodiscard]] Json read_json(const std::filesystem::path& path);

[[nodiscard]] Json to_json(const Errors& errors);

}  // namespace candela::study
