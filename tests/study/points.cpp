#include "tests/study/points.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>

namespace candela::study {
namespace {

constexpr std::array members{"id", "config", "seeds", "fresh_seeds"};

[[noreturn]] void fail(const std::string& error) {
    throw std::invalid_argument(error);
}

void require_known_members(const Json& point) {
    for (const auto& [name, value] : point.items()) {
        if (std::find(members.begin(), members.end(), name) == members.end()) {
            fail(fmt::format("\"{}\" is unknown", name));
        }
    }
}

/// Ids are used in file names.
std::string id_of(const Json& point) {
    const auto found = point.find("id");
    if (found == point.end() || !found->is_string()) fail("\"id\" is not a text");
    auto id = found->get<std::string>();
    if (id.empty() || id.front() == '.' || id.find('/') != id.npos) {
        fail("\"id\" is empty, begins with a point or has a slash in it");
    }
    return id;
}

std::string request_of(const Json& point) {
    const Json config = point.value("config", Json::object());
    if (!config.is_object()) fail("\"config\" is not an object");
    return config.dump();
}

bool is_seed(const Json& value) {
    return value.is_number_unsigned() &&
           value.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
}

std::vector<std::uint32_t> seeds_of(const Json& point) {
    const Json seeds = point.value("seeds", Json::array({0U}));
    if (!seeds.is_array() || seeds.empty() || !std::all_of(seeds.begin(), seeds.end(), is_seed)) {
        fail("\"seeds\" is not a list of whole numbers of 32 bits");
    }
    return seeds.get<std::vector<std::uint32_t>>();
}

bool fresh_seeds_of(const Json& point) {
    const Json fresh = point.value("fresh_seeds", Json(false));
    if (!fresh.is_boolean()) fail("\"fresh_seeds\" is neither true nor false");
    return fresh.get<bool>();
}

Point read_point(const Json& point) {
    if (!point.is_object()) fail("is not an object");
    require_known_members(point);
    return {id_of(point), request_of(point), seeds_of(point), fresh_seeds_of(point)};
}

}  // namespace

std::vector<Point> read_points(const Json& json, std::string_view name) {
    if (!json.is_array()) fail(fmt::format("{}: is not a list of points", name));
    std::vector<Point> points;
    points.reserve(json.size());
    std::set<std::string> ids;
    for (const Json& point : json) {
        try {
            points.push_back(read_point(point));
        } catch (const std::invalid_argument& error) {
            fail(fmt::format("{}: point {}: {}", name, points.size(), error.what()));
        }
        if (!ids.insert(points.back().id).second) {
            fail(fmt::format("{}: \"{}\" is the id of two points", name, points.back().id));
        }
    }
    return points;
}

}  // namespace candela::study
