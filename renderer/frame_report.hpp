#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace candela {

/// CPU and GPU time of one pass in one frame, in milliseconds; 0 if the pass had nothing to do.
struct PassReport {
    std::string name;
    bool ran = false;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
};

/// Times of one frame, in milliseconds. `index` counts the frames of a renderer from 0; `passes` are in graph
/// order.
struct FrameReport {
    std::uint64_t index = 0;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
    std::vector<PassReport> passes;
};

}  // namespace candela
