#pragma once

#include "renderer/configuration/configuration.hpp"
#include "sandbox/config_watch.hpp"
#include "sandbox/options.hpp"
#include "sandbox/scene.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Shows the scene, plays its animation and lets people change it until they close the window or the frames
/// asked for are done. Configurations that `watch` gives go into force; faulty ones are reported in the panel
/// and on stderr while the present one goes on. Then writes the last frame's picture (without panels), report
/// and graph, as far as the options ask for them. Throws std::runtime_error for outputs that cannot be
/// written, and gl::GlError.
void run_window(Window& window, Scene& scene, Entity camera, const Configuration& configuration,
                ConfigWatch& watch, const Options& options);

}  // namespace candela::sandbox
