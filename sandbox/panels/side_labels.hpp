#pragma once

#include <string>

#include <candela/configuration.hpp>
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// What the two sides of a comparison are, one or more lines each, for example "A: balanced" and "B: custom"
/// with a line "vpls.count 64".
struct SideLabels {
    std::string a;
    std::string b;
};

/// Two configurations by their names and, if these do not tell them apart, by the settings in which they
/// differ.
[[nodiscard]] SideLabels side_labels(const Configuration& a, const Configuration& b);

/// Of what is compared: two configurations, or one with the reference.
[[nodiscard]] SideLabels side_labels(const AppState& state, const ReferenceView& reference);

}  // namespace candela::sandbox
