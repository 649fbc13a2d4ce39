#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "renderer/configuration/configuration.hpp"
#include "sandbox/options.hpp"

namespace candela::sandbox {

/// Reads the configuration file anew whenever it is saved, in place or by replacing it. A file that is not
/// there is no save: it is read once it is back.
class ConfigWatch {
 public:
    using Clock = std::chrono::steady_clock;
    /// Between two looks at the file. A save is read once two looks in a row find the same, so that a file
    /// that is still being written is left alone.
    static constexpr std::chrono::milliseconds interval{200};

    /// Knows the file as it is now: to miss no save, make this before the file is first read. Watches nothing
    /// without `options.config`.
    explicit ConfigWatch(Options options);

    /// To be called often. Once after each save: the configuration that choose_configuration gives a window,
    /// or what is wrong with it. Throws nothing for files that are missing or faulty.
    [[nodiscard]] std::optional<ConfigurationResult> poll(Clock::time_point now);

 private:
    /// Tells one state of the file from another without reading it.
    struct Stamp {
        std::filesystem::file_time_type written;
        std::uintmax_t bytes = 0;
        bool operator==(const Stamp&) const = default;
    };
    [[nodiscard]] std::optional<Stamp> look() const;

    Options options_;
    std::optional<Stamp> seen_;  ///< at the last look
    std::optional<Stamp> read_;  ///< when it was last read
    Clock::time_point next_look_{};
};

}  // namespace candela::sandbox
