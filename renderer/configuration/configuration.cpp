#include <candela/configuration.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "engine/json/json.hpp"
#include "engine/readable.hpp"

namespace candela {
namespace {

constexpr auto path_names = [] {
    std::array<std::string_view, shading_paths.size()> names;
    std::ranges::transform(shading_paths, names.begin(), &ShadingPathInfo::name);
    return names;
}();
constexpr std::array<std::string_view, all_shows.size()> show_names{"total",      "direct", "indirect",
                                                                    "irradiance", "albedo", "normals"};
constexpr std::array<std::string_view, 3> visibility_names{"none", "maps", "rays"};
constexpr std::array<std::string_view, 2> placement_names{"paths", "surfels"};
constexpr std::array<std::string_view, 5> interleave_names{"auto", "1", "2", "4", "8"};

std::span<const std::string_view> names_of(ShadingPath /*type*/) {
    return path_names;
}
std::span<const std::string_view> names_of(Show /*type*/) {
    return show_names;
}
std::span<const std::string_view> names_of(VplVisibility /*type*/) {
    return visibility_names;
}

std::span<const std::string_view> names_of(VplPlacement /*type*/) {
    return placement_names;
}

std::span<const std::string_view> names_of(Interleave /*type*/) {
    return interleave_names;
}

struct Range {
    double least;
    double most;
};

/// Names every member once, with the range of its values. Reading, writing and validating all use it, through
/// `visitor.group(name, members)`, `visitor.member(name, value)` and `visitor.member(name, value, range)`.
template <class Config, class Visitor>
void visit(Config& c, Visitor& visitor) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    visitor.member("path", c.path);
    visitor.member("show", c.show);
    visitor.member("indirect", c.indirect);
    visitor.group("vpls", [&] {
        visitor.member("placement", c.vpls.placement);
        visitor.member("count", c.vpls.count, {0, 1 << 20});
        visitor.member("bounces", c.vpls.bounces, {0, 64});
        visitor.member("seed", c.vpls.seed, {0, std::numeric_limits<std::uint32_t>::max()});
        visitor.member("interleave", c.interleave);
        visitor.member("visibility", c.visibility.method);
        visitor.member("map_resolution", c.visibility.map_resolution, {8, 1024});
        visitor.member("geometry_bound", c.geometry_bound, {1e-6, infinity});
    });
    visitor.group("lists", [&] {
        visitor.member("tile_size", c.lists.tile_size, {16, 64});
        visitor.member("slices", c.lists.slices, {2, 256});
    });
    visitor.group("shadows", [&] {
        visitor.member("enabled", c.shadows.enabled);
        visitor.member("cube_resolution", c.shadows.cube_resolution, {16, 8192});
        visitor.member("map_resolution", c.shadows.map_resolution, {16, 8192});
        visitor.member("budget_mib", c.shadows.budget_mib, {0, 1 << 16});
    });
    visitor.group("refinement", [&] {
        visitor.member("enabled", c.refinement.enabled);
        visitor.member("frames", c.refinement.frames, {1, 1 << 20});
    });
    visitor.group("tone_map", [&] {
        visitor.member("enabled", c.tone_map.enabled);
        visitor.member("exposure_ev", c.tone_map.exposure_ev, {-32, 32});
    });
    visitor.member("frame_budget_ms", c.frame_budget_ms, {0, 1e6});
}

class Writer {
 public:
    explicit Writer(Json& root) : json_(&root) {}

    template <class Members>
    void group(const char* name, Members members) {
        Json* outer = std::exchange(json_, &(*json_)[name]);
        members();
        json_ = outer;
    }
    template <class T>
    void member(const char* name, const T& value, Range /*range*/ = {}) {
        if constexpr (std::is_enum_v<T>) {
            (*json_)[name] = as_json(names_of(value)[static_cast<std::size_t>(value)]);
        } else if constexpr (std::is_same_v<T, float>) {
            write_float((*json_)[name], value);
        } else if constexpr (std::is_same_v<T, std::optional<float>>) {
            (*json_)[name] = value ? Json(*value) : Json("auto");
        } else {
            (*json_)[name] = value;
        }
    }

 private:
    /// A name that consists of digits is written as a number.
    static Json as_json(std::string_view name) {
        const bool is_number = name.find_first_not_of("0123456789") == std::string_view::npos;
        return is_number ? Json::parse(name) : Json(name);
    }
    /// JSON has no infinity; it is written as the string "infinity".
    static void write_float(Json& json, float value) {
        if (std::isinf(value)) {
            json = "infinity";
        } else {
            json = value;
        }
    }
    Json* json_;
};

/// Checks the ranges of the values of a configuration.
class Validator {
 public:
    explicit Validator(std::vector<std::string>& errors) : errors_(&errors) {}

    template <class Members>
    void group(const char* name, Members members) {
        const std::string outer = std::exchange(prefix_, fmt::format("{}{}.", prefix_, name));
        members();
        prefix_ = outer;
    }
    template <class T>
    void member(const char* /*name*/, const T& /*value*/) {}
    void member(const char* name, const std::optional<float>& value, Range range) {
        if (value) {
            member(name, *value, range);
        }
    }
    template <class T>
    void member(const char* name, const T& value, Range range) {
        // In the value's own type, in which a limit such as 1e-6 may be rounded.
        const auto number = static_cast<double>(value);
        const auto rounded = [](double limit) { return static_cast<double>(static_cast<T>(limit)); };
        if (number >= rounded(range.least) && number <= rounded(range.most)) {
            return;
        }
        errors_->push_back(
            fmt::format("{}{}: {} is not from {} to {}", prefix_, name, number, range.least, range.most));
    }

 private:
    std::vector<std::string>* errors_;
    std::string prefix_;
};

class Reader {
 public:
    Reader(const Json& root, std::vector<std::string>& errors) : json_(&root), errors_(&errors) {}

    template <class Members>
    void group(const char* name, Members members) {
        known_.insert(prefix_ + name);
        const Json* const found = json_->find(name);
        if (!found) {
            return;
        }
        if (!found->is_object()) {
            return error(name, "is not an object");
        }
        const Json* outer = std::exchange(json_, found);
        const std::string outer_prefix = std::exchange(prefix_, fmt::format("{}{}.", prefix_, name));
        members();
        report_unknown();
        prefix_ = outer_prefix;
        json_ = outer;
    }
    template <class T>
    void member(const char* name, T& value, Range range = {}) {
        known_.insert(prefix_ + name);
        if (const Json* const found = json_->find(name)) {
            read(name, *found, value, range);
        }
    }
    void report_unknown() {
        for (const auto& [name, value] : json_->members()) {
            if (!known_.contains(prefix_ + name)) {
                error(readable(name), "is unknown");
            }
        }
    }

 private:
    void error(std::string_view name, std::string_view what) {
        errors_->push_back(fmt::format("{}{}: {}", prefix_, name, what));
    }
    void read(const char* name, const Json& json, bool& value, Range /*range*/) {
        if (!json.is_boolean()) {
            return error(name, "is not true or false");
        }
        value = json.flag();
    }
    void read(const char* name, const Json& json, std::uint32_t& value, Range range) {
        const bool fits = json.is_whole() && json.number() >= range.least && json.number() <= range.most;
        if (!fits) {
            return error(name, fmt::format("is not a whole number from {} to {}", range.least, range.most));
        }
        value = json.whole<std::uint32_t>();
    }
    void read(const char* name, const Json& json, float& value, Range range) {
        const bool infinite = json.is("infinity");
        if (!json.is_number() && !infinite) {
            return error(name, "is not a number");
        }
        const double number = infinite ? std::numeric_limits<double>::infinity() : json.number();
        const bool is_large_enough = static_cast<float>(number) >= static_cast<float>(range.least);
        if (!is_large_enough || number > range.most) {
            return error(name, fmt::format("is not from {} to {}", range.least, range.most));
        }
        value = static_cast<float>(number);
    }
    void read(const char* name, const Json& json, std::optional<float>& value, Range range) {
        if (json.is("auto")) {
            value.reset();
        } else {
            read(name, json, value.emplace(value.value_or(0.0F)), range);
        }
    }
    template <class E>
    requires std::is_enum_v<E>
    void read(const char* name, const Json& json, E& value, Range /*range*/) {
        const auto names = names_of(value);
        std::string given;
        if (json.is_string()) {
            given = json.text();
        } else if (json.is_number()) {
            given = json.dump();
        }
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (given == names[i]) {
                value = static_cast<E>(i);
                return;
            }
        }
        error(name, fmt::format("is not one of {}", fmt::join(names, ", ")));
    }

    const Json* json_;
    std::vector<std::string>* errors_;
    std::string prefix_;
    std::set<std::string> known_;
};

/// Changes the members that `json` has.
void read_members(const Json& json, Configuration& configuration, std::vector<std::string>& errors) {
    if (!json.is_object()) {
        errors.emplace_back("not a JSON object");
        return;
    }
    Reader reader(json, errors);
    visit(configuration, reader);
    reader.report_unknown();
}

}  // namespace

ConfigurationResult read_configuration(std::string_view text, const Configuration& base) {
    ConfigurationResult result;
    Configuration configuration = base;
    try {
        read_members(Json::parse(text), configuration, result.errors);
    } catch (const JsonError& error) {
        result.errors.push_back(readable(error.what()));
    }
    result.errors = first_ten(std::move(result.errors));
    // Rejected members kept their old values; this adds errors that depend on several values.
    const std::vector<std::string> of_values = validate(configuration);
    result.errors.insert(result.errors.end(), of_values.begin(), of_values.end());
    if (result.errors.empty()) {
        result.configuration = configuration;
    }
    return result;
}

std::string write_configuration(const Configuration& configuration) {
    Json json;
    Writer writer(json);
    visit(configuration, writer);
    return json.dump(2);
}

std::vector<std::string> validate(const Configuration& configuration) {
    std::vector<std::string> errors;
    Validator validator(errors);
    visit(configuration, validator);
    if (configuration.vpls.placement == VplPlacement::surfels && configuration.vpls.count > most_surfels) {
        errors.push_back(fmt::format("vpls.count: {} surfels are too many; {} are possible",
                                     configuration.vpls.count, most_surfels));
    }
    if (configuration.lists.tile_size % 16 != 0) {
        errors.push_back(
            fmt::format("lists.tile_size: {} is not a multiple of 16", configuration.lists.tile_size));
    }
    return errors;
}

std::span<const NamedConfiguration> named_configurations() {
    static const std::vector<NamedConfiguration> configurations = [] {
        std::vector<NamedConfiguration> named;
        const auto add = [&](NamedFor kind, std::string_view name, std::string_view description,
                             auto change) {
            Configuration configuration;
            change(configuration);
            named.push_back({kind, name, description, configuration});
        };
        add(NamedFor::purpose, "draft", "fast: few VPLs with small depth maps", [](Configuration& c) {
            c.vpls.count = 192;
            c.vpls.bounces = 4;
            c.visibility.map_resolution = 32;
            c.interleave = Interleave::eight;
        });
        add(NamedFor::purpose, "balanced", "the default", [](Configuration&) {});
        add(NamedFor::purpose, "best", "accurate: 2048 VPLs with large depth maps", [](Configuration& c) {
            c.vpls.count = 2048;
            c.visibility.map_resolution = 128;
            c.interleave = Interleave::four;
        });
        // As in the report that this project began with; it had one bounce and no shadows of VPLs.
        add(NamedFor::purpose, "report",
            "instant radiosity: VPLs where light hits surfaces, seen through walls", [](Configuration& c) {
                c.vpls.placement = VplPlacement::paths;
                c.vpls.count = 256;
                c.vpls.bounces = 1;
                c.visibility.method = VplVisibility::none;
                c.interleave = Interleave::one;
            });
        for (const ShadingPathInfo& path : shading_paths) {
            add(NamedFor::path, path.name, path.description, [&](Configuration& c) { c.path = path.path; });
        }
        return named;
    }();
    return configurations;
}

std::string_view to_string(ShadingPath path) {
    return info_of(path).name;
}
std::string_view to_string(Show show) {
    return show_names[static_cast<std::size_t>(show)];
}
std::string_view to_string(VplVisibility visibility) {
    return visibility_names[static_cast<std::size_t>(visibility)];
}

std::string_view to_string(VplPlacement placement) {
    return placement_names[static_cast<std::size_t>(placement)];
}

std::string_view to_string(Interleave interleave) {
    return interleave_names[static_cast<std::size_t>(interleave)];
}

}  // namespace candela
