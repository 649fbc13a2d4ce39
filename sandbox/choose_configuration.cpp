#include "sandbox/choose_configuration.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace candela::sandbox {

namespace {

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        const std::string fault = std::generic_category().message(errno);
        throw std::runtime_error(fmt::format("{}: cannot be read: {}", path.string(), fault));
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

Configuration read_file(const std::filesystem::path& path) {
    const ConfigurationResult result = read_configuration(read_text(path));
    if (result.configuration) return *result.configuration;
    throw std::runtime_error(fmt::format("{}: {}", path.string(), fmt::join(result.faults, "; ")));
}

template <class T>
void override_by(const std::optional<T>& flag, T& value) {
    if (flag) value = *flag;
}

}  // namespace

Configuration choose_configuration(const Options& options) {
    Configuration configuration = options.config ? read_file(*options.config) : Configuration{};
    override_by(options.show, configuration.show);
    override_by(options.path, configuration.path);
    override_by(options.indirect, configuration.indirect);
    override_by(options.vpls, configuration.vpls.count);
    override_by(options.bounces, configuration.vpls.bounces);
    override_by(options.seed, configuration.vpls.seed);
    const std::vector<std::string> faults = validate(configuration);
    if (!faults.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(faults, "; ")));
    return configuration;
}

std::string list_configurations() {
    std::string text;
    for (const NamedConfiguration& named : named_configurations())
        text += fmt::format("{:<12} {}\n", named.name, named.description);
    return text;
}

}  // namespace candela::sandbox
