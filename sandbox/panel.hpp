#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/renderer.hpp"
#include "sandbox/interaction.hpp"

namespace candela::sandbox {

/// The panel beside the picture: what is chosen, what a frame takes and where the light goes.
class Panel {
 public:
    bool visible = true;

    /// Draws it, and puts into effect what people change in it. Between Gui::begin_frame and end_frame.
    void draw(Renderer& renderer, World& world, Interaction& interaction, const FrameReport& frame);

 private:
    void draw_configuration(Renderer& renderer);
    void draw_account(Renderer& renderer);

    std::vector<std::string> faults_;  ///< of the configuration that was last refused
    std::optional<Report> report_;
    double report_time_ = 0.0;  ///< seconds since the start
};

}  // namespace candela::sandbox
