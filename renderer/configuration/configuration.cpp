#include <candela/settings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/read_json.hpp"
#include "engine/readable.hpp"

namespace candela {
namespace {

using Json = nlohmann::json;

constexpr auto path_choices = [] {
    std::array<Choice, shading_paths.size()> choices;
    std::ranges::transform(shading_paths, choices.begin(), [](const ShadingPathInfo& path) {
        return Choice{path.name, path.description};
    });
    return choices;
}();
constexpr std::array<Choice, all_shows.size()> show_choices{{
    {"total", "all light"},
    {"direct", "light that comes straight from lights, the sky and surfaces that emit it"},
    {"indirect", "light that surfaces reflect onto others"},
    {"irradiance", "light that arrives, in lux / π: the picture if all surfaces were white"},
    {"albedo", "the part of the light that surfaces reflect, 0 to 1"},
    {"normals", "0.5 n + 0.5, in world space"},
    {"roughness", "of what surfaces reflect in the mirror direction, 0 to 1"},
    {"metalness", "the share of the surfaces that is metal, 0 to 1"},
}};
constexpr std::array<Choice, 2> placement_choices{{{"paths", ""}, {"surfels", ""}}};
constexpr std::array<Choice, 3> visibility_choices{{{"none", ""}, {"maps", ""}, {"rays", ""}}};
constexpr std::array<Choice, 5> interleave_choices{
    {{"auto", "by the number of VPLs and the size of the picture"},
     {"1", "each pixel evaluates all VPLs"},
     {"2", ""},
     {"4", ""},
     {"8", ""}}};
constexpr std::array<Choice, 3> curve_choices{
    {{"filmic", "Narkowicz' curve: strong contrast, each channel by itself"},
     {"neutral", "Khronos PBR Neutral: base colours stay as they are, only highlights are compressed"},
     {"aces", "Hill's fit to ACES, as in many glTF viewers: strong contrast, highlights fade to white"}}};

// The JSON value of a setting of each type.

template <std::integral Value>  // bool, too
Json as_json(Value value) {
    return value;
}
/// JSON has no infinity; it is written as a string.
Json as_json(float value) {
    return std::isinf(value) ? Json("infinity") : Json(value);
}
Json as_json(const std::optional<float>& value) {
    return value ? as_json(*value) : Json("auto");
}
/// A name that consists of digits is written as a number.
template <class Enum>
requires std::is_enum_v<Enum> Json as_json(Enum value) {
    const std::string_view name = to_string(value);
    const bool is_number = name.find_first_not_of("0123456789") == std::string_view::npos;
    return is_number ? Json::parse(name) : Json(name);
}

/// Compares in the value's own type, in which a limit such as 1e-6 may be rounded.
template <class T>
bool is_within(T value, const Range& range) {
    return value >= static_cast<T>(range.least) && value <= static_cast<T>(range.most);
}

// Each reads the value of a setting, or returns what is wrong with it.

using Fault = std::optional<std::string>;

Fault read(const Json& json, const Range& /*range*/, bool& value) {
    if (!json.is_boolean()) return "is not true or false";
    value = json.get<bool>();
    return {};
}
Fault read(const Json& json, const Range& range, std::uint32_t& value) {
    if (!json.is_number_integer() || !is_within(json.get<double>(), range)) {
        return fmt::format("is not a whole number from {} to {}", range.least, range.most);
    }
    value = json.get<std::uint32_t>();
    return {};
}
Fault read(const Json& json, const Range& range, float& value) {
    if (!json.is_number() && json != "infinity") return "is not a number";
    const float number = json.is_number() ? json.get<float>() : std::numeric_limits<float>::infinity();
    if (!is_within(number, range)) return fmt::format("is not from {} to {}", range.least, range.most);
    value = number;
    return {};
}
Fault read(const Json& json, const Range& range, std::optional<float>& value) {
    if (json == "auto") {
        value.reset();
        return {};
    }
    return read(json, range, value.emplace(value.value_or(0.0F)));
}
std::string names_of(std::span<const Choice> choices) {
    std::string names;
    for (const Choice& choice : choices) {
        names += (names.empty() ? "" : ", ") + std::string(choice.name);
    }
    return names;
}
template <class Enum>
requires std::is_enum_v<Enum> Fault read(const Json& json, const Range& /*range*/, Enum& value) {
    const std::string given = json.is_string()   ? json.get<std::string>()
                              : json.is_number() ? json.dump()
                                                 : "";
    const std::span<const Choice> choices = choices_of(value);
    const auto chosen = std::ranges::find(choices, given, &Choice::name);
    if (chosen == choices.end()) return fmt::format("is not one of {}", names_of(choices));
    value = static_cast<Enum>(chosen - choices.begin());
    return {};
}

/// The members that an object may have, by its name; the outermost object has an empty one.
using KnownMembers = std::map<std::string_view, std::set<std::string_view>>;

KnownMembers known_members() {
    KnownMembers known;
    const Configuration any;
    for_each_setting(any, [&](const Setting& setting, const auto& /*value*/) {
        known[setting.group()].insert(setting.name());
        if (!setting.group().empty()) known[""].insert(setting.group());
    });
    return known;
}

/// Adds what is wrong with the names of an object's members.
void check_names(const Json& object, std::string_view group, const KnownMembers& known,
                 std::vector<std::string>& errors) {
    for (const auto& [name, value] : object.items()) {
        const std::string path = fmt::format("{}{}{}", group, group.empty() ? "" : ".", readable(name));
        const bool is_group = group.empty() && known.contains(name);
        if (!known.at(group).contains(name)) {
            errors.push_back(path + ": is unknown");
        } else if (is_group && value.is_object()) {
            check_names(value, name, known, errors);
        } else if (is_group) {
            errors.push_back(path + ": is not an object");
        }
    }
}

/// Changes the settings that `json` has. Returns what is wrong with it.
std::vector<std::string> read_members(const Json& json, Configuration& configuration) {
    if (!json.is_object()) return {"not a JSON object"};
    std::vector<std::string> errors;
    for_each_setting(configuration, [&](const Setting& setting, auto& value) {
        const Json* const member = find_member(json, setting.path);
        if (const Fault fault = member ? read(*member, setting.range, value) : Fault()) {
            errors.push_back(fmt::format("{}: {}", setting.path, *fault));
        }
    });
    check_names(json, "", known_members(), errors);
    return errors;
}

/// Adds what is wrong with the value of a setting.
template <class T>
void check(const Setting& setting, const T& value, std::vector<std::string>& errors) {
    if constexpr (std::is_same_v<T, std::optional<float>>) {
        if (value) check(setting, *value, errors);
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
        const auto& [least, most, step] = setting.range;
        const bool is_multiple = std::is_floating_point_v<T> || std::fmod(value, step) == 0;
        if (!is_within(value, setting.range)) {
            errors.push_back(fmt::format("{}: {} is not from {} to {}", setting.path, value, least, most));
        } else if (!is_multiple) {
            errors.push_back(fmt::format("{}: {} is not a multiple of {}", setting.path, value, step));
        }
    }
}

}  // namespace

ConfigurationResult read_configuration(std::string_view text, const Configuration& base) {
    ConfigurationResult result;
    Configuration configuration = base;
    try {
        result.errors = first_ten(read_members(parse_json(text), configuration));
    } catch (const std::runtime_error& error) {
        result.errors = {error.what()};
    }
    // Rejected members kept their old values; this adds errors that depend on several values.
    const std::vector<std::string> of_values = validate(configuration);
    result.errors.insert(result.errors.end(), of_values.begin(), of_values.end());
    if (result.errors.empty()) result.configuration = configuration;
    return result;
}

std::string write_configuration(const Configuration& configuration) {
    nlohmann::ordered_json json;
    for_each_setting(configuration, [&](const Setting& setting, const auto& value) {
        auto& object = setting.group().empty() ? json : json[setting.group()];
        object[setting.name()] = as_json(value);
    });
    return json.dump(2);
}

std::vector<std::string> validate(const Configuration& configuration) {
    std::vector<std::string> errors;
    for_each_setting(configuration,
                     [&](const Setting& setting, const auto& value) { check(setting, value, errors); });
    if (configuration.vpls.placement == VplPlacement::surfels && configuration.vpls.count > most_surfels) {
        errors.push_back(fmt::format("vpls.count: {} surfels are too many; {} are possible",
                                     configuration.vpls.count, most_surfels));
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

std::span<const Choice> choices_of(ShadingPath /*type*/) {
    return path_choices;
}
std::span<const Choice> choices_of(Show /*type*/) {
    return show_choices;
}
std::span<const Choice> choices_of(VplPlacement /*type*/) {
    return placement_choices;
}
std::span<const Choice> choices_of(VplVisibility /*type*/) {
    return visibility_choices;
}
std::span<const Choice> choices_of(Interleave /*type*/) {
    return interleave_choices;
}
std::span<const Choice> choices_of(ToneCurve /*type*/) {
    return curve_choices;
}

}  // namespace candela
