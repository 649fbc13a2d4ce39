#include "sandbox/headless/stop_signals.hpp"

#include <cstddef>

namespace candela::sandbox {

namespace {

volatile std::sig_atomic_t noted = 0;  // 0: none

extern "C" void note_signal(int signal) {
    noted = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

StopSignals::StopSignals() {
    noted = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
        before_[i] = std::signal(signals[i], &note_signal);
        // What was started in the background may have to ignore a signal.
        if (before_[i] == SIG_IGN) std::signal(signals[i], SIG_IGN);
    }
}

StopSignals::~StopSignals() {
    for (std::size_t i = 0; i < signals.size(); ++i) std::signal(signals[i], before_[i]);
}

std::optional<int> StopSignals::received() const {
    const int signal = noted;
    return signal == 0 ? std::nullopt : std::optional(signal);
}

}  // namespace candela::sandbox
