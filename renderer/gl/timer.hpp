#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "renderer/gl/objects.hpp"

namespace candela::gl {

struct PassTime {
    std::uint32_t pass = 0;
    double ms = 0.0;
};

/// GPU times of one frame; `ms` spans its first to its last timestamp, `passes` are in the order of their
/// begins.
struct FrameTime {
    std::uint64_t frame = 0;
    double ms = 0.0;
    std::vector<PassTime> passes;
};

/// Measures GPU time by timestamps that are read only once the driver has them: nothing ever waits, but for
/// `finish`. Frames in flight are as many as the driver lags behind; their queries are used again.
class Timer {
 public:
    explicit Timer(Device& device) : device_(&device) {}

    /// A frame that has begun but not ended is dropped.
    void begin_frame(std::uint64_t frame);
    /// Passes are timed one after the other, not nested; outside of a frame they are not timed.
    void begin_pass(std::uint32_t pass);
    void end_pass();
    void end_frame();

    /// Frames whose times have arrived since the last call, in order.
    [[nodiscard]] std::vector<FrameTime> collect();
    /// All frames ended so far that were not collected yet; waits for the GPU.
    [[nodiscard]] std::vector<FrameTime> finish();
    /// Frames ended whose times were not collected yet.
    [[nodiscard]] std::size_t pending() const { return pending_.size(); }

 private:
    struct Span {
        std::uint32_t pass = 0;
        Query begin;
        Query end;
    };
    struct Frame {
        std::uint64_t index = 0;
        Query begin;
        Query end;
        std::vector<Span> spans;
    };

    [[nodiscard]] Query stamp();
    [[nodiscard]] bool arrived(const Frame& frame) const;
    [[nodiscard]] std::uint64_t take(Query query);
    [[nodiscard]] FrameTime read(Frame frame);

    Device* device_;
    std::optional<Frame> current_;
    std::deque<Frame> pending_;
    std::vector<Query> free_;
};

}  // namespace candela::gl
