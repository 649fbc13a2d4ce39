#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/renderer.hpp"
#include "sandbox/interaction.hpp"
#include "sandbox/playback.hpp"

namespace candela::sandbox {

/// The panel beside the picture: what is chosen, what a frame takes and where the light goes.
class Panel {
 public:
    bool visible = true;
    /// Of the configuration that was last asked for, in the panel or elsewhere.
    std::vector<std::string> faults;

    /// Draws it, and puts into effect what people change in it. `playback` is null without an animation.
    /// Between Gui::begin_frame and end_frame.
    void draw(Renderer& renderer, World& world, Interaction& interaction, Playback* playback,
              const FrameReport& frame);

 private:
    void draw_configuration(Configuration& wanted, const Quality& present);
    void draw_account(Renderer& renderer);

    std::optional<Report> report_;
    double report_time_ = 0.0;  ///< seconds since the start
};

}  // namespace candela::sandbox
