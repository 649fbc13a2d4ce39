#pragma once

#include <candela/configuration.hpp>
#include "sandbox/config_watch.hpp"
#include "sandbox/options.hpp"
#include "sandbox/scene.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Shows the scene, plays its animation and handles the user's input until the window is closed or the
/// requested number of frames is done. Applies the configurations that `watch` returns; errors in them are
/// reported in the panel and on stderr, and the current configuration stays. Then writes the picture of the
/// last frame (without panels), the report and the graph, as the options ask for. Throws std::runtime_error
/// for outputs that cannot be written, gl::GlError, and EnergyError if the light does not add up.
void run_window(Window& window, Scene& scene, Entity camera, const Configuration& configuration,
                ConfigWatch& watch, const Options& options);

}  // namespace candela::sandbox
