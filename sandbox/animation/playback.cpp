#include "sandbox/animation/playback.hpp"

namespace candela::sandbox {

void Playback::toggle() {
    if (!playing_ && at_end()) seek(0);
    playing_ = !playing_;
}

void Playback::step() {
    seek((frame_ + 1) % frames());
}

void Playback::seek(int frame) {
    frame_ = frame;
    playing_ = false;
    shown_.reset();
}

void Playback::advance(World& world) {
    if (playing_ && shown_) {
        playing_ = !at_end();
        frame_ = frame_of(animation_->script(), frame_ + 1);
    }
    jumped_ = !shown_;
    if (shown_ == frame_) return;
    animation_->apply(world, frame_);
    shown_ = frame_;
}

}  // namespace candela::sandbox
