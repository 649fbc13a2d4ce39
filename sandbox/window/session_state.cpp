#include "sandbox/window/session_state.hpp"

namespace candela::sandbox {

Status status_of(const SessionState& state) {
    Status status;
    status.busy = state.busy;
    status.frame_ms = state.costs.frame().last_ms();
    status.mean_ms = state.costs.frame().mean_ms;
    if (state.document && state.app.configuration.shadows.enabled) {
        status.warning = words_of(state.document->scene.world, state.document->interaction.enclosed());
    }
    if (!state.shown) return status;
    status.quality = state.shown->quality;
    status.settled = state.is_settled();
    const Report* report = state.report();
    if (report == nullptr) return status;
    if (report->vpls) status.vpls = report->vpls->alive;
    status.refined = report->refined;
    status.noise = state.shown->noise;
    const RefinementSettings& refinement = state.shown->configuration.refinement;
    status.to_refine = refinement.enabled ? refinement.frames : 0;
    return status;
}

FrameRequest frame_request(SessionState& state, glm::uvec2 size) {
    const AppState& app = state.app;
    FrameRequest request{.world = state.document->copy_of_world(),
                         .camera = state.document->interaction.viewer(),
                         .size = size,
                         .configuration = app.configuration,
                         .update_budget_ms = app.update_budget_ms,
                         .read_vpls = app.vpls,
                         .read_radiance = app.reference,
                         .estimate_error = app.estimate_error,
                         .noise_limit = app.noise_limit};
    if (app.probe && !state.selection.resource) request.probe = app.probed;
    if (state.selection.resource) {
        request.inspection = state.selection.inspection;
        request.inspection->resource = *state.selection.resource;
    }
    const Comparison& comparison = app.comparison;
    if (comparison.mode == CompareMode::off) return request;
    if (comparison.mode == CompareMode::difference) request.difference = comparison.factor;
    if (comparison.with_reference) {
        request.reference = state.reference.radiance();
    } else {
        request.other = comparison.other;
    }
    return request;
}

std::optional<tools::ReferenceRequest> reference_request(SessionState& state, glm::uvec2 size) {
    if (!state.app.reference || !state.shown) return std::nullopt;
    tools::ReferenceRequest request;
    request.world = state.document->copy_of_world();
    request.camera = state.document->interaction.viewer();
    request.size = size;
    request.antialiased = state.app.configuration.refinement.enabled;
    return request;
}

}  // namespace candela::sandbox
