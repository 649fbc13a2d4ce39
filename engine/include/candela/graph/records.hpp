#pragma once

#include <any>
#include <cstdint>
#include <string_view>
#include <vector>

namespace candela {

struct PassRecord {
    std::string_view name;  ///< valid until the next call of GraphRuntime::switch_to
    bool ran = false;
    bool verified = false;           ///< GraphRuntime::verify ran it again, with the same result
    const std::any* note = nullptr;  ///< see Pass::note; null without; valid as the name is
    double cpu_ms = 0.0;             ///< elapsed milliseconds on the CPU side; 0 without timing
};

struct FrameRecord {
    std::uint64_t frame = 0;         ///< number of runs completed before this one
    std::vector<PassRecord> passes;  ///< all passes that were not culled, in execution order
    bool complete = true;  ///< false: the host did not want it any more, and passes that had to run did not
};

/// Bytes of GPU storage that a runtime owns, without driver overhead.
struct MemoryUse {
    std::uint64_t texture_bytes = 0;
    std::uint64_t buffer_bytes = 0;
    /// What transients would need in addition if they did not share objects.
    std::uint64_t shared_by_aliasing_bytes = 0;
    /// The part of texture_bytes and buffer_bytes in the free pool, kept for a switch back to the previous
    /// graph.
    std::uint64_t free_pool_bytes = 0;
};

enum class Timing : bool { off, on };

}  // namespace candela
