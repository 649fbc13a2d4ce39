#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include <candela/configuration.hpp>
#include "sandbox/options.hpp"

namespace candela::sandbox {

/// Reads the configuration file again whenever it is saved, in place or by replacing it. A missing file does
/// not count as saved; it is read once it is back.
class ConfigWatch {
 public:
    using Clock = std::chrono::steady_clock;
    /// Time between two checks of the file. A saved file is read once two checks in a row find the same
    /// state, so that a file is not read while it is being written.
    static constexpr std::chrono::milliseconds interval{200};

    /// Records the current state of the file. To miss no save, create this before the file is first read.
    /// Watches nothing if `options.config` is not set.
    explicit ConfigWatch(Options options);

    /// Call this often. Returns a result once after each save: the configuration that choose_configuration
    /// gives for a window, or its errors. Does not throw if the file is missing or invalid.
    [[nodiscard]] std::optional<ConfigurationResult> poll(Clock::time_point now);

 private:
    /// Identifies a state of the file without reading it.
    struct Stamp {
        std::filesystem::file_time_type written;
        std::uintmax_t bytes = 0;
        bool operator==(const Stamp&) const = default;
    };
    [[nodiscard]] std::optional<Stamp> look() const;

    Options options_;
    std::optional<Stamp> seen_;  ///< at the last check
    std::optional<Stamp> read_;  ///< when it was last read
    Clock::time_point next_look_{};
};

}  // namespace candela::sandbox
