#include "sandbox/panels/quality_panel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <candela/settings.hpp>
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

void draw_presets(Configuration& value) {
    bool first = true;
    for (const NamedConfiguration& named : named_configurations()) {
        if (named.kind != NamedFor::purpose) continue;
        const std::string name(named.name);
        if (!first) same_line_if_it_fits(name);
        first = false;
        const bool chosen = choose_named(value, named) == value;
        if (choice(name, chosen, std::string(named.description).c_str())) value = choose_named(value, named);
    }
}

// A control for a setting of each type.

void control(const char* label, const char* tip, const Range& /*range*/, bool& value) {
    checkbox(label, value, tip);
}
template <class Number>
void control(const char* label, const char* tip, const Range& range, Number& value) {
    constexpr double largest = std::numeric_limits<Number>::max();
    const float speed = 0.05F + 0.005F * std::abs(static_cast<float>(value));
    drag(label, value, speed, static_cast<Number>(range.least),
         static_cast<Number>(std::min(range.most, largest)), tip);
    if constexpr (std::is_integral_v<Number>) value -= value % range.step;
}
void control(const char* label, const char* tip, const Range& range, std::optional<float>& value) {
    bool automatic = !value;
    if (checkbox(fmt::format("{}: auto", label).c_str(), automatic, tip)) {
        value = automatic ? std::nullopt : std::optional(0.0F);
    }
    if (value) control(label, tip, range, *value);
}
template <class Enum>
requires std::is_enum_v<Enum>
void control(const char* label, const char* tip, const Range& /*range*/, Enum& value) {
    text(label);
    value = static_cast<Enum>(choose(choices_of(value), static_cast<std::size_t>(value), tip));
}

/// A control for each setting that has an effect, named as in JSON.
void draw_settings(Configuration& configuration) {
    std::string_view group;
    for_each_setting(configuration, [&](const Setting& setting, auto& value) {
        if (!setting.has_effect) return;
        if (setting.group() != std::exchange(group, setting.group())) ImGui::Separator();
        control(std::string(setting.path).c_str(), std::string(setting.help).c_str(), setting.range, value);
    });
}

void draw_noise_limit(double& limit) {
    constexpr float most = 100.0F;
    auto percent = static_cast<float>(100.0 * limit);
    if (drag("end refinement at noise, %", percent, 0.01F, 0.0F, most,
             "of the picture's mean radiance: refinement ends when the estimated noise of a pixel falls to "
             "it, "
             "or after the number of frames; 0: only then")) {
        limit = static_cast<double>(percent) / 100.0;
    }
}

}  // namespace

void draw_quality_panel(Configuration& configuration, double& noise_limit, const Quality& present) {
    draw_presets(configuration);
    ImGui::Separator();
    draw_settings(configuration);
    if (configuration.refinement.enabled) draw_noise_limit(noise_limit);
    text(fmt::format("now: {:.0f} % of the sides, one in {} VPLs a pixel", 100.0F * present.scale,
                     present.interleave * present.interleave));
}

}  // namespace candela::sandbox
