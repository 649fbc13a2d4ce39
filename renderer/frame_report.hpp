#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace candela {

/// GPU and CPU time of one pass in one frame, in milliseconds. A pass that had nothing to do takes none.
struct PassReport {
    std::string name;
    bool ran = false;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
};

struct FrameReport {
    std::uint64_t index = 0;
    double cpu_ms = 0.0;
    double gpu_ms = 0.0;
    std::vector<PassReport> passes;
};

}  // namespace candela
