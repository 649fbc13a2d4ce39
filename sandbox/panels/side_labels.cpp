#include "sandbox/panels/side_labels.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include <candela/settings.hpp>
#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

namespace {

struct SettingWords {
    std::string_view path;
    std::string value;
    bool has_effect = true;
};

template <class T>
std::string value_words(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return value ? "on" : "off";
    } else if constexpr (std::is_same_v<T, std::optional<float>>) {
        return value ? fmt::format("{:.4g}", *value) : "auto";
    } else if constexpr (std::is_enum_v<T>) {
        return std::string(choices_of(value)[static_cast<std::size_t>(value)].name);
    } else if constexpr (std::is_floating_point_v<T>) {
        return fmt::format("{:.4g}", value);
    } else {
        return fmt::format("{}", value);
    }
}

std::vector<SettingWords> settings_of(const Configuration& configuration) {
    std::vector<SettingWords> settings;
    for_each_setting(configuration, [&](const Setting& setting, const auto& value) {
        settings.push_back({setting.path, value_words(value), setting.has_effect});
    });
    return settings;
}

/// The values of `own` that are others in `other`, a line each; those without an effect on either are left
/// out.
std::string differences(const std::vector<SettingWords>& own, const std::vector<SettingWords>& other) {
    constexpr std::size_t most = 4;
    std::string lines;
    std::size_t count = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (own[i].value == other[i].value || !(own[i].has_effect || other[i].has_effect)) continue;
        if (++count <= most) lines += fmt::format("\n{} {}", own[i].path, own[i].value);
    }
    if (count > most) lines += fmt::format("\nand {} more", count - most);
    return lines;
}

}  // namespace

SideLabels side_labels(const Configuration& a, const Configuration& b) {
    const std::string_view a_name = name_of(a);
    const std::string_view b_name = name_of(b);
    SideLabels labels{fmt::format("A: {}", a_name), fmt::format("B: {}", b_name)};
    if (a == b) {
        labels.b += ", the same as A";
    } else if (a_name == b_name || a_name == "custom" || b_name == "custom") {
        const std::vector<SettingWords> of_a = settings_of(a);
        const std::vector<SettingWords> of_b = settings_of(b);
        labels.a += differences(of_a, of_b);
        labels.b += differences(of_b, of_a);
    }
    return labels;
}

SideLabels side_labels(const AppState& state, const ReferenceView& reference) {
    if (!state.comparison.with_reference) return side_labels(state.configuration, state.comparison.other);
    const tools::ReferencePicture* picture = reference.picture();
    return {fmt::format("A: {}", name_of(state.configuration)),
            picture == nullptr ? "B: the reference, not there yet"
                               : fmt::format("B: the reference, {} paths a pixel", picture->samples)};
}

}  // namespace candela::sandbox
