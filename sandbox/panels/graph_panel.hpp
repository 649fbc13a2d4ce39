#pragma once

#include <optional>
#include <string>

#include <candela/inspection.hpp>
#include "sandbox/panels/graph_picture.hpp"
#include "sandbox/panels/pass_costs.hpp"

namespace candela::sandbox {

/// What the user has chosen in the drawn graph.
struct GraphSelection {
    std::optional<std::string> pass;      ///< whose resources are listed
    std::optional<std::string> resource;  ///< that is shown instead of the picture
    Inspection inspection;                ///< how it is shown; its resource is not used
};

/// Draws the frame graph: the passes in the order in which they run, one per line, coloured by what they
/// cost, with arcs from the passes whose results they need. A click on a pass lists its resources; a click on
/// a resource shows it.
void draw_graph_panel(GraphSelection& selection, const GraphPicture& graph, const PassCosts& costs);

}  // namespace candela::sandbox
