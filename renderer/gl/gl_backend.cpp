#include <candela/gl_backend.hpp>

#include "renderer/gl/graph_backend.hpp"

namespace candela {

struct GlBackend::State {
    explicit State(const gl::GetProc& get_proc) : device(get_proc, gl::DebugOutput::off), backend(device) {
        backend.expect_any_state();
    }

    gl::Device device;
    gl::GraphBackend backend;
};

GlBackend::GlBackend(const gl::GetProc& get_proc) : state_(std::make_unique<State>(get_proc)) {}
GlBackend::~GlBackend() = default;

Backend& GlBackend::backend() {
    return state_->backend;
}

void GlBackend::begin_frame(std::uint64_t frame) {
    state_->backend.timer().begin_frame(frame);
}

void GlBackend::end_frame() {
    state_->backend.timer().end_frame();
}

std::vector<FrameTime> GlBackend::take_times() {
    return state_->backend.timer().collect();
}

}  // namespace candela
