#include "tests/study/json_line.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace candela::study {

std::string to_line(const Json& json) {
    const Json members = json.flatten();  // each under its path: "/errors/total/bias"
    for (const auto& [place, value] : members.items()) {
        if (value.is_number_float() && !std::isfinite(value.get<double>())) {
            throw std::domain_error(fmt::format("{} is {}", place, value.get<double>()));
        }
    }
    // Paths may contain bytes that are not valid UTF-8.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_line(const Json& json) {
    fmt::print("{}\n", to_line(json));
    std::fflush(stdout);
}

Json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    Json json = Json::parse(file, nullptr, false);
    if (!file.is_open()) throw std::runtime_error(fmt::format("{}: cannot be read", path.string()));
    if (json.is_discarded()) throw std::runtime_error(fmt::format("{}: is not valid JSON", path.string()));
    return json;
}

Json to_json(const Errors& errors) {
    return {{"rel_mse", errors.rel_mse},
            {"rmse", errors.rmse},
            {"bias", errors.bias},
            {"spikes", errors.spikes},
            {"blotch", errors.blotch}};
}

}  // namespace candela::study
