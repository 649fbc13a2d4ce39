#include "sandbox/choose_configuration.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sandbox/input_file.hpp"

namespace candela::sandbox {

namespace {

Configuration read_over(const Configuration& base, const std::filesystem::path& path) {
    const ConfigurationResult result = read_configuration(read_file(path), base);
    if (result.configuration) return *result.configuration;
    throw std::runtime_error(fmt::format("{}: {}", path.string(), fmt::join(result.errors, "; ")));
}

template <class T>
void override_by(const std::optional<T>& flag, T& value) {
    if (flag) value = *flag;
}

bool is_one_picture_of_many_frames(const Options& options) {
    const bool one_picture = options.out && numbered(*options.out, 0) == *options.out;
    return one_picture && options.frames.value_or(1) > 1 && !options.animate;
}

}  // namespace

Configuration choose_configuration(const Options& options, bool in_window) {
    Configuration configuration;
    configuration.refinement.enabled = in_window || is_one_picture_of_many_frames(options);
    if (in_window) configuration.frame_budget_ms.reset();
    if (options.config) configuration = read_over(configuration, *options.config);
    override_by(options.show, configuration.show);
    override_by(options.path, configuration.path);
    override_by(options.indirect, configuration.indirect);
    override_by(options.vpl_placement, configuration.vpls.placement);
    override_by(options.vpls, configuration.vpls.count);
    override_by(options.bounces, configuration.vpls.bounces);
    override_by(options.seed, configuration.vpls.seed);
    override_by(options.vpl_visibility, configuration.visibility.method);
    override_by(options.interleave, configuration.interleave);
    const std::vector<std::string> errors = validate(configuration);
    if (!errors.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(errors, "; ")));
    return configuration;
}

std::string list_configurations() {
    std::string text;
    for (const NamedConfiguration& named : named_configurations())
        text += fmt::format("{:<12} {}\n", named.name, named.description);
    return text;
}

}  // namespace candela::sandbox
