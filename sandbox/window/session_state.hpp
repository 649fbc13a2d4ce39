#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <candela/graph/describe.hpp>

#include "sandbox/panels/graph_panel.hpp"
#include "sandbox/panels/pass_costs.hpp"
#include "sandbox/panels/status_line.hpp"
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/document.hpp"
#include "sandbox/window/frame_request.hpp"
#include "sandbox/window/layout.hpp"
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// What a window shows: events and commands change it, and each frame draws it.
struct SessionState {
    AppState app;
    std::optional<Document> document;  ///< none before the first scene is loaded
    ReferenceView reference;
    std::uint64_t submitted = 0;         ///< number of the newest request
    std::optional<RenderedFrame> shown;  ///< the newest frame
    PassCosts costs;
    GraphDescription graph;    ///< of the renderer
    GraphSelection selection;  ///< in the graph
    Layout layout;
    bool loading = false;  ///< a scene
    std::string busy;      ///< what takes long at present; empty: nothing

    /// Null before the first picture.
    [[nodiscard]] const Report* report() const { return shown ? shown->report.get() : nullptr; }
    [[nodiscard]] bool is_playing() const { return document && document->is_playing(); }
    /// Whether the newest request has been answered, perhaps by a picture that gets better yet.
    [[nodiscard]] bool is_answered() const { return shown && shown->request == submitted; }
    /// Whether nothing will change by itself.
    [[nodiscard]] bool is_settled() const {
        return is_answered() && shown->settled && !loading && !is_playing();
    }
};

/// What the status line says of it.
[[nodiscard]] Status status_of(const SessionState& state);

/// The picture that it asks for, `size` in pixels.
[[nodiscard]] FrameRequest frame_request(SessionState& state, glm::uvec2 size);

/// The reference that it asks for: that of the scene at rest, so while something moves, a new one each time.
[[nodiscard]] std::optional<tools::ReferenceRequest> reference_request(SessionState& state, glm::uvec2 size);

}  // namespace candela::sandbox
