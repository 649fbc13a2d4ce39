#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <candela/report.hpp>

namespace candela::sandbox {

/// What a pass has cost in its last runs.
struct PassCost {
    std::string name{};
    bool ran = false;     ///< in the last frame
    double cpu_ms = 0.0;  ///< in the last frame in which it ran
    double gpu_ms = 0.0;
    double mean_ms = 0.0;          ///< of the longer of both times, over the runs in `history`
    std::vector<float> history{};  ///< the longer of both times in the last runs, oldest first, milliseconds

    [[nodiscard]] double last_ms() const { return cpu_ms > gpu_ms ? cpu_ms : gpu_ms; }
};

/// The costs of all passes, and of whole frames, over the last frames.
class PassCosts {
 public:
    static constexpr std::size_t kept = 120;  ///< runs

    void add(const FrameReport& frame);
    /// In the order of the last frame; passes that are not in it are forgotten.
    [[nodiscard]] const std::vector<PassCost>& passes() const { return passes_; }
    [[nodiscard]] const PassCost& frame() const { return frame_; }

 private:
    std::vector<PassCost> passes_;
    PassCost frame_;
};

}  // namespace candela::sandbox
