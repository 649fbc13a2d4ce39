#include "sandbox/command_line/choose_configuration.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sandbox/files/input_file.hpp"

namespace candela::sandbox {

namespace {

/// The named configuration that is given in place of a file; null if there is none.
const NamedConfiguration* named_in(const Options& options) {
    std::error_code ignored;
    const NamedConfiguration* named = options.config ? find_named(options.config->string()) : nullptr;
    return named != nullptr && !std::filesystem::exists(*options.config, ignored) ? named : nullptr;
}

Configuration read_over(const Configuration& base, const Options& options) {
    if (!options.config) return base;
    if (const NamedConfiguration* named = named_in(options)) return choose_named(base, *named);
    const ConfigurationResult result = read_configuration(read_file(*options.config), base);
    if (result.configuration) return *result.configuration;
    throw std::runtime_error(fmt::format("{}: {}", options.config->string(), fmt::join(result.errors, "; ")));
}

bool is_one_picture_of_many_frames(const Options& options) {
    const bool one_picture = options.out && !is_numbered(*options.out);
    return one_picture && options.frames.value_or(1) > 1 && !options.animate;
}

}  // namespace

Configuration choose_configuration(const Options& options, bool in_window) {
    Configuration base;
    base.tone_map.automatic_exposure = true;
    base.refinement.enabled = in_window || is_one_picture_of_many_frames(options);
    if (in_window) base.frame_budget_ms.reset();
    Configuration configuration = read_over(base, options);
    apply_settings(options, configuration);
    const std::vector<std::string> errors = validate(configuration);
    if (!errors.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(errors, "; ")));
    return configuration;
}

Configuration choose_named(const Configuration& present, const NamedConfiguration& named) {
    Configuration chosen = named.configuration;
    chosen.refinement = present.refinement;
    chosen.frame_budget_ms = present.frame_budget_ms;
    chosen.tone_map = present.tone_map;
    chosen.show = present.show;
    return chosen;
}

std::string_view name_of(const Configuration& configuration) {
    const auto named = named_configurations();
    const auto found = std::find_if(named.begin(), named.end(), [&](const NamedConfiguration& candidate) {
        return choose_named(configuration, candidate) == configuration;
    });
    return found == named.end() ? "custom" : found->name;
}

const NamedConfiguration* find_named(std::string_view name) {
    const auto named = named_configurations();
    const auto found = std::ranges::find(named, name, &NamedConfiguration::name);
    return found == named.end() ? nullptr : &*found;
}

std::string list_configurations() {
    const auto named = named_configurations();
    const auto longest =
        std::ranges::max(named, {}, [](const auto& one) { return one.name.size(); }).name.size();
    std::string text;
    for (const NamedConfiguration& one : named) {
        text += fmt::format("{:<{}}  {}\n", one.name, longest, one.description);
    }
    return text;
}

}  // namespace candela::sandbox
