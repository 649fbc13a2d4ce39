#include "sandbox/config_watch.hpp"

#include <stdexcept>
#include <system_error>
#include <utility>

#include "sandbox/choose_configuration.hpp"

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

ConfigWatch::ConfigWatch(Options options) : options_(std::move(options)), seen_(look()), read_(seen_) {}

std::optional<ConfigurationResult> ConfigWatch::poll(Clock::time_point now) {
    if (now < next_look_) return std::nullopt;
    next_look_ = now + interval;
    const std::optional<Stamp> stamp = look();
    const bool settled = stamp == std::exchange(seen_, stamp);
    if (!stamp || !settled || stamp == read_) return std::nullopt;
    ConfigurationResult result = read(options_);
    // The file was saved again in the meantime: what was read may be a mix of both versions.
    if (look() != stamp) return std::nullopt;
    read_ = stamp;
    return result;
}

std::optional<ConfigWatch::Stamp> ConfigWatch::look() const {
    if (!options_.config) return std::nullopt;
    std::error_code no_time;
    std::error_code no_size;
    const Stamp stamp{std::filesystem::last_write_time(*options_.config, no_time),
                      std::filesystem::file_size(*options_.config, no_size)};
    return no_time || no_size ? std::nullopt : std::optional(stamp);
}

}  // namespace candela::sandbox
