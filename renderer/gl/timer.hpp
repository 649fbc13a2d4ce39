#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <candela/gl_backend.hpp>
#include "renderer/gl/objects.hpp"

namespace candela::gl {

/// Measures GPU time by timestamp queries. `collect` reads only results that are available, so that
/// only `finish` waits: for the results themselves, which a driver may have later than it has finished
/// its work. Query objects are reused.
class Timer {
 public:
    explicit Timer(Device& device) : device_(&device) {}

    /// Starts a frame; `frame` is returned as FrameTime::frame. Drops a frame that has not ended.
    void begin_frame(std::uint64_t frame);
    /// Passes must not be nested. Outside of a frame, passes are not timed.
    void begin_pass(std::uint32_t pass);
    void end_pass();
    void end_frame();

    /// Frames whose times have arrived since the last call, oldest first. Does not wait.
    [[nodiscard]] std::vector<FrameTime> collect();
    /// All ended frames that were not collected yet, oldest first; waits for the GPU.
    [[nodiscard]] std::vector<FrameTime> finish();
    /// Number of ended frames whose times were not collected yet.
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
