#include "sandbox/window/reference_view.hpp"

#include <candela/tools/flip.hpp>
#include <candela/tools/picture_error.hpp>
#include <candela/tools/tool_error.hpp>

namespace candela::sandbox {
namespace {

/// Blotches are as wide as a share of the picture, so that few pixels show them, in a time that does not
/// delay the window.
constexpr int most_pixels_across = 320;

ReferenceErrors compared(const tools::Picture& shown, const tools::ReferencePicture& reference) {
    const int side = (shown.size.x + most_pixels_across - 1) / most_pixels_across;
    const tools::Picture small = tools::blocks_of(shown, reference.hit, side).means;
    const tools::Blocks right = tools::blocks_of(reference.radiance, reference.hit, side);
    return {.rel_mse = tools::relative_mse(shown, reference.radiance, reference.hit),
            .blotch = tools::blotch(small, right.means, right.hit),
            .flip = tools::flip_of_light(small, right.means, right.hit).mean};
}

}  // namespace

void ReferenceView::follow(const std::optional<tools::ReferenceRequest>& request) {
    if (!tracer_ || request == request_) return;
    request_ = request;
    picture_.reset();
    radiance_.reset();
    fault_.clear();
    if (request_) {
        tracer_->start(*request_);
    } else {
        tracer_->stop();
    }
}

bool ReferenceView::update() {
    if (!tracer_ || !request_) return false;
    std::string fault = tracer_->fault();
    const bool new_fault = fault != fault_;
    fault_ = std::move(fault);
    std::optional<tools::ReferencePicture> newest = tracer_->newest();
    if (!newest) return new_fault;
    picture_ = std::move(newest);
    radiance_ = std::make_shared<const tools::Picture>(picture_->radiance);
    return true;
}

std::optional<ReferenceErrors> ReferenceView::errors_of(const tools::Picture& shown) const {
    if (!picture_ || picture_->samples == 0 || shown.size != picture_->radiance.size) return std::nullopt;
    try {
        return compared(shown, *picture_);
    } catch (const tools::ToolError&) {
        return std::nullopt;  // no surface is seen, or the picture is not finite
    }
}

}  // namespace candela::sandbox
