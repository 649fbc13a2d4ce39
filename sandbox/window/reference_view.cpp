#include "sandbox/window/reference_view.hpp"

#include <candela/tools/flip.hpp>
#include <candela/tools/picture_error.hpp>
#include <candela/tools/tool_error.hpp>

namespace candela::sandbox {
namespace {

/// Blotches are as wide as a share of the picture, so that few pixels show them, in a time that does not
/// delay the window.
constexpr int most_pixels_across = 320;

/// Where most of a block of pixels counts.
tools::Mask scaled_down(const tools::Mask& hit, glm::ivec2 size, int factor) {
    tools::Picture shares{size, {}};
    for (const std::uint8_t counts : hit) shares.pixels.emplace_back(counts != 0 ? 1.0F : 0.0F);
    tools::Mask mask;
    for (const glm::vec3& share : tools::scaled_down(shares, factor).pixels) {
        mask.push_back(share.r > 0.5F ? 1 : 0);
    }
    return mask;
}

ReferenceErrors compared(const tools::Picture& shown, const tools::ReferencePicture& reference) {
    const int factor = (shown.size.x + most_pixels_across - 1) / most_pixels_across;
    const tools::Picture small = tools::scaled_down(shown, factor);
    const tools::Picture small_reference = tools::scaled_down(reference.radiance, factor);
    const tools::Mask hit = scaled_down(reference.hit, shown.size, factor);
    return {.rel_mse = tools::relative_mse(shown, reference.radiance, reference.hit),
            .blotch = tools::blotch(small, small_reference, hit),
            .flip = tools::flip_of_light(small, small_reference, hit).mean};
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
