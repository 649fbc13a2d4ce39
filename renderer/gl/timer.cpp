#include "renderer/gl/timer.hpp"

#include <utility>

namespace candela::gl {
namespace {

double milliseconds(std::uint64_t begin, std::uint64_t end) {
    return end > begin ? static_cast<double>(end - begin) * 1e-6 : 0.0;  // timestamps are in nanoseconds
}

}  // namespace

void Timer::begin_frame(std::uint64_t frame) {
    current_ = Frame{.index = frame, .begin = stamp(), .end = {}, .spans = {}};
}

void Timer::begin_pass(std::uint32_t pass) {
    if (current_) current_->spans.push_back({.pass = pass, .begin = stamp(), .end = {}});
}

void Timer::end_pass() {
    if (current_) current_->spans.back().end = stamp();
}

void Timer::end_frame() {
    current_->end = stamp();
    pending_.push_back(std::move(*current_));
    current_.reset();
}

std::vector<FrameTime> Timer::collect() {
    std::vector<FrameTime> times;
    while (!pending_.empty() && arrived(pending_.front())) {
        times.push_back(read(std::move(pending_.front())));
        pending_.pop_front();
    }
    return times;
}

std::vector<FrameTime> Timer::finish() {
    std::vector<FrameTime> times;
    for (Frame& frame : pending_) times.push_back(read(std::move(frame)));
    pending_.clear();
    return times;
}

Query Timer::stamp() {
    Query query;
    if (free_.empty()) {
        query = Query(*device_, "timestamp", GL_TIMESTAMP);
    } else {
        query = std::move(free_.back());
        free_.pop_back();
    }
    device_->gl().QueryCounter(query.name(), GL_TIMESTAMP);
    return query;
}

bool Timer::arrived(const Frame& frame) const {
    // Results of queries of one type become available in the order of issue: checking the last one is enough.
    GLint available = GL_FALSE;
    device_->gl().GetQueryObjectiv(frame.end.name(), GL_QUERY_RESULT_AVAILABLE, &available);
    return available == GL_TRUE;
}

std::uint64_t Timer::take(Query query) {
    GLuint64 nanoseconds = 0;
    device_->gl().GetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &nanoseconds);
    free_.push_back(std::move(query));
    return nanoseconds;
}

FrameTime Timer::read(Frame frame) {
    const std::uint64_t begin = take(std::move(frame.begin));
    FrameTime times{.frame = frame.index, .ms = 0.0, .passes = {}};
    for (Span& span : frame.spans) {
        const std::uint64_t from = take(std::move(span.begin));
        times.passes.push_back({.pass = span.pass, .ms = milliseconds(from, take(std::move(span.end)))});
    }
    times.ms = milliseconds(begin, take(std::move(frame.end)));
    return times;
}

}  // namespace candela::gl
