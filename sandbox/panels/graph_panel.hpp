#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <candela/graph/describe.hpp>
#include <candela/inspection.hpp>
#include "sandbox/panels/pass_costs.hpp"

namespace candela::sandbox {

/// What the user has chosen in the drawn graph.
struct GraphSelection {
    std::optional<std::string> pass;      ///< whose resources are listed
    std::optional<std::string> resource;  ///< that is shown instead of the picture
    Inspection inspection;                ///< how it is shown; its resource is not used
};

/// Whether a pass or a resource with this name serves the view of resources itself, which is not drawn.
[[nodiscard]] bool is_of_inspection(std::string_view name);

/// Whether a resource of the graph can be shown instead of the picture: a texture or a buffer that a pass has
/// written before those that end the frame, the choice of the exposure and the tone map.
[[nodiscard]] bool can_be_shown(const GraphDescription& graph, std::size_t resource);

/// Draws the frame graph: the passes in the order in which they run, one per line, coloured by what they
/// cost, with arcs from the passes whose results they need. A click on a pass lists its resources; a click on
/// a resource shows it.
void draw_graph_panel(GraphSelection& selection, const GraphDescription& graph, const PassCosts& costs);

}  // namespace candela::sandbox
