#include "sandbox/window/session_state.hpp"

#include <candela/scene/hierarchy.hpp>
#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

namespace {

glm::vec3 position_of(const World& world, Entity entity) {
    return {world_matrix(world, entity)[3]};
}

void describe_document(const Document& document, UiRecord& record) {
    const World& world = document.scene.world;
    const Interaction& interaction = document.interaction;
    record.undo = interaction.history().undo_count();
    record.redo = interaction.history().redo_count();
    record.scene_file = document.scene.path.string();
    record.eye = position_of(world, interaction.viewer());
    if (!interaction.selected) return;
    record.selected = name_of(world, *interaction.selected);
    record.position = position_of(world, *interaction.selected);
}

}  // namespace

Status status_of(const SessionState& state) {
    Status status;
    status.busy = state.busy;
    status.frame_ms = state.costs.frame().last_ms();
    status.mean_ms = state.costs.frame().mean_ms;
    if (!state.shown) return status;
    status.quality = state.shown->quality;
    status.settled = state.is_settled();
    const Report* report = state.report();
    if (report == nullptr) return status;
    if (report->vpls) status.vpls = report->vpls->alive;
    status.refined = report->refined;
    const RefinementSettings& refinement = state.shown->configuration.refinement;
    status.to_refine = refinement.enabled ? refinement.frames : 0;
    return status;
}

UiRecord record_of(const SessionState& state) {
    UiRecord record;
    record.submitted = state.submitted;
    record.settled = state.is_settled();
    record.busy = state.busy;
    record.scene = state.layout.scene;
    record.configuration = name_of(state.app.configuration);
    record.show = to_string(state.app.configuration.show);
    record.compare = state.app.comparison.mode;
    record.view = state.selection.resource;
    record.errors = state.app.errors;
    record.rel_mse = state.app.error;
    if (state.shown) record.picture = state.shown->request;
    if (const Report* report = state.report()) record.refined = report->refined;
    if (state.document) describe_document(*state.document, record);
    return record;
}

FrameRequest frame_request(SessionState& state, glm::uvec2 size) {
    const AppState& app = state.app;
    FrameRequest request{.world = state.document->copy_of_world(),
                         .camera = state.document->interaction.viewer(),
                         .size = size,
                         .configuration = app.configuration,
                         .read_vpls = app.vpls,
                         .read_radiance = app.reference};
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

std::optional<ReferenceRequest> reference_request(SessionState& state, glm::uvec2 size) {
    if (!state.app.reference || !state.shown) return std::nullopt;
    ReferenceRequest request;
    request.world = state.document->copy_of_world();
    request.camera = state.document->interaction.viewer();
    request.size = size;
    request.antialiased = state.app.configuration.refinement.enabled;
    return request;
}

}  // namespace candela::sandbox
