#include "sandbox/window/reference_view.hpp"

#include <candela/tools/picture_error.hpp>
#include <candela/tools/tool_error.hpp>

namespace candela::sandbox {

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

std::optional<double> ReferenceView::error_of(const tools::Picture& shown) const {
    if (!picture_ || picture_->samples == 0 || shown.size != picture_->radiance.size) return std::nullopt;
    try {
        return tools::relative_mse(shown, picture_->radiance, picture_->hit);
    } catch (const tools::ToolError&) {
        return std::nullopt;  // no surface is seen, or the picture is not finite
    }
}

}  // namespace candela::sandbox
