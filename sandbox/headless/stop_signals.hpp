#pragma once

#include <array>
#include <csignal>
#include <optional>

namespace candela::sandbox {

/// As long as one exists, SIGINT and SIGTERM do not end the program but are noted, so that work can come to
/// an end without losing what is done. The same signal ends the program if it comes again. There must be one
/// at most.
class StopSignals {
 public:
    StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals();

    /// The last signal that has come.
    [[nodiscard]] std::optional<int> received() const;

 private:
    using Handler = void (*)(int);
    static constexpr std::array<int, 2> signals{SIGINT, SIGTERM};

    std::array<Handler, signals.size()> before_{};
};

}  // namespace candela::sandbox
