#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "sandbox/panels/controls.hpp"
#include "sandbox/window/session_state.hpp"

namespace candela::sandbox {

/// A frame of the window.
struct UiFrame {
    int number = 0;
    double time = 0.0;  ///< seconds since the start
    /// Seconds from the oldest input event that its picture answers to its presentation.
    std::optional<double> latency;
    float scale = 1.0F;  ///< of the display
    ControlPlaces controls;
};

/// Writes a JSON object per line to a file whenever something in the window has changed: for automatic tests,
/// which find the controls by their labels in it.
class UiLog {
 public:
    /// Throws std::runtime_error that names the file if it cannot be written.
    explicit UiLog(const std::filesystem::path& path);

    void add(const SessionState& state, const UiFrame& frame);

 private:
    std::ofstream file_;
    std::string last_;  ///< without what changes in every frame
};

}  // namespace candela::sandbox
