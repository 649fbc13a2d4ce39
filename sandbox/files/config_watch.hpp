#pragma once

#include <optional>
#include <utility>

#include <candela/configuration.hpp>
#include "sandbox/command_line/options.hpp"
#include "sandbox/files/save_watch.hpp"

namespace candela::sandbox {

/// Reads the configuration file again whenever it is saved. A missing file is read once it is back.
class ConfigWatch {
 public:
    /// Records the current state of the file. To miss no save, create this before the file is first read.
    /// Watches nothing if `options.config` is not set.
    explicit ConfigWatch(Options options) : options_(std::move(options)), saves_(options_.config) {}

    /// Call this often. Returns a result once after each save: the configuration that choose_configuration
    /// gives for a window, or its errors. Does not throw if the file is missing or invalid.
    [[nodiscard]] std::optional<ConfigurationResult> poll(SaveWatch::Clock::time_point now);

 private:
    Options options_;
    SaveWatch saves_;
};

}  // namespace candela::sandbox
