#pragma once

#include <optional>
#include <string>
#include <vector>

#include <candela/renderer.hpp>
#include "sandbox/interaction.hpp"
#include "sandbox/playback.hpp"

namespace candela::sandbox {

/// The panel over the picture: the settings, the cost of a frame and the energy account.
class Panel {
 public:
    bool visible = true;
    /// What the scene's file asks for and the picture lacks.
    std::vector<std::string> warnings;
    /// The errors of the configuration that was last requested, in the panel or elsewhere.
    std::vector<std::string> errors;

    /// Draws the panel and applies the user's changes. `playback` is null without an animation. Call this
    /// between Gui::begin_frame and Gui::end_frame.
    void draw(Renderer& renderer, World& world, Interaction& interaction, Playback* playback,
              const FrameReport& frame);

 private:
    void draw_configuration(Configuration& wanted, const Quality& present);
    void draw_account(Renderer& renderer);

    std::optional<Report> report_;
    double report_time_ = 0.0;  ///< seconds since the start
};

}  // namespace candela::sandbox
