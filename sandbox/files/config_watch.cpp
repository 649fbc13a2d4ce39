#include "sandbox/files/config_watch.hpp"

#include <stdexcept>
#include <utility>

#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

namespace {

ConfigurationResult read(const Options& options) {
    try {
        return {choose_configuration(options, true), {}};
    } catch (const std::runtime_error& error) {
        return {std::nullopt, {error.what()}};
    }
}

}  // namespace

std::optional<ConfigurationResult> ConfigWatch::poll(SaveWatch::Clock::time_point now) {
    if (!saves_.has_saved(now)) return std::nullopt;
    ConfigurationResult result = read(options_);
    return saves_.accept() ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace candela::sandbox
