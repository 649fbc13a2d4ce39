#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace candela::sandbox {

/// Notices when files are saved, in place or by replacing them.
class SaveWatch {
 public:
    using Clock = std::chrono::steady_clock;
    /// Time between two looks. Files count as saved once two looks in a row find the same state, so that
    /// nothing is read while it is being written.
    static constexpr std::chrono::milliseconds interval{200};

    /// Watches a file, or all files in a folder and its folders; nothing without a path. Records the current
    /// state. To miss no save, create this before the file is first read.
    explicit SaveWatch(std::optional<std::filesystem::path> path);

    /// Call this often. Whether something was saved since `accept` was last called. A missing file does not
    /// count as saved.
    [[nodiscard]] bool has_saved(Clock::time_point now);
    /// Call this after reading: takes note of the state that was read. False if it was saved again in the
    /// meantime: what was read may then be a mix of both versions.
    [[nodiscard]] bool accept();

 private:
    /// Identifies a state of a file without reading it.
    struct Stamp {
        std::filesystem::path path;
        std::filesystem::file_time_type written;
        std::uintmax_t bytes = 0;
        bool operator==(const Stamp&) const = default;
    };
    using Stamps = std::vector<Stamp>;
    [[nodiscard]] Stamps look() const;

    std::optional<std::filesystem::path> path_;
    Stamps seen_;  ///< at the last look
    Stamps read_;  ///< when they were last read
    Clock::time_point next_look_{};
};

}  // namespace candela::sandbox
