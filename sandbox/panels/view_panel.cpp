#include "sandbox/panels/view_panel.hpp"

#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

void draw_mode(Comparison& comparison, const Configuration& present) {
    const auto offer = [&](const char* label, CompareMode mode, const char* tip) {
        if (!choice(label, comparison.mode == mode, tip)) return;
        if (comparison.mode == CompareMode::off) comparison.other = present;
        comparison.mode = mode;
    };
    offer("no comparison", CompareMode::off, "one configuration");
    ImGui::SameLine();
    offer("divider", CompareMode::divider,
          "A, the configuration, left of a line that can be dragged; B, a second one, right of it");
    ImGui::SameLine();
    offer("difference", CompareMode::difference, "|A - B| of the shown colours, times a factor");
}

void draw_comparison(AppState& state) {
    Comparison& comparison = state.comparison;
    draw_mode(comparison, state.configuration);
    if (comparison.mode == CompareMode::off) return;
    if (comparison.mode == CompareMode::divider) {
        slide("position", comparison.divider, 0.0F, 1.0F, "of the line, a fraction of the picture's width");
    }
    if (comparison.mode == CompareMode::difference) {
        slide("factor", comparison.factor, 1.0F, 100.0F, "on differences of colours between 0 and 1");
    }
    if (button("swap A and B", "the panel's settings are those of A")) {
        std::swap(state.configuration, comparison.other);
    }
    ImGui::SameLine();
    if (button("B = A", "makes B the same as A")) comparison.other = state.configuration;
    ImGui::PushID("B");
    if (ImGui::BeginCombo("B", std::string(name_of(comparison.other)).c_str())) {
        for (const NamedConfiguration& named : named_configurations()) {
            if (ImGui::Selectable(std::string(named.name).c_str())) {
                comparison.other = choose_named(state.configuration, named);
            }
            note_control(std::string("B ") + std::string(named.name), nullptr);
        }
        ImGui::EndCombo();
    }
    note_control("B", "the second configuration");
    ImGui::PopID();
}

void draw_reference(AppState& state, const ReferenceView& reference, double frame_ms) {
    if (!reference.is_built_in()) {
        ImGui::TextDisabled("No reference: built without Embree (libembree-dev).");
        return;
    }
    checkbox("trace the reference", state.reference,
             "a path tracer refines the same picture in the background, on half of the cores");
    if (!state.reference) return;
    Comparison& comparison = state.comparison;
    if (checkbox("compare with it", comparison.with_reference, "B is the reference") &&
        comparison.with_reference && comparison.mode == CompareMode::off) {
        comparison.mode = CompareMode::divider;
    }
    if (!reference.fault().empty()) text(reference.fault());
    const tools::ReferencePicture* picture = reference.picture();
    if (picture == nullptr) return text("tracing the first picture");
    text(fmt::format("{} paths a pixel, {:.0f} s", picture->samples, picture->seconds));
    constexpr double measurable = 0.05;  // noise above it may be far more than it is estimated to be
    if (!state.error || !picture->noise || *picture->noise > measurable) {
        return text("too noisy to measure with, so far");
    }
    text(fmt::format("relMSE {:.4f} in {:.1f} ms a frame", state.error->rel_mse, frame_ms));
    text(fmt::format("of that, noise of the reference: {:.4f}", *picture->noise));
    text(fmt::format("blotches {:.4f}, FLIP {:.3f}", state.error->blotch, state.error->flip));
}

}  // namespace

void draw_view_panel(AppState& state, const Report* report, const ReferenceView& reference, double frame_ms) {
    Show& show = state.configuration.show;
    show = static_cast<Show>(choose(choices_of(show), static_cast<std::size_t>(show), nullptr));
    checkbox("VPLs as dots", state.vpls,
             "each in the colour of its flux, with its normal; point at one to see its values, click on it "
             "to see its lights "
             "and its neighbours");
    checkbox("values under the pointer", state.probe,
             "the radiance and the colour of the picture's pixel there");
    checkbox("estimate their error", state.estimate_error,
             "from another set of as many VPLs, which takes time whenever something moves");
    if (state.estimate_error && report != nullptr && report->vpls && report->vpls->estimated_error) {
        text(fmt::format("relMSE about {:.2g}", *report->vpls->estimated_error));
    }
    ImGui::Separator();
    draw_comparison(state);
    ImGui::Separator();
    draw_reference(state, reference, frame_ms);
}

}  // namespace candela::sandbox
