#pragma once

#include <functional>

#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/options.hpp"
#include "sandbox/files/config_watch.hpp"
#include "sandbox/scene/scene.hpp"
#include "sandbox/window/reference_view.hpp"
#include "sandbox/window/scene_loader.hpp"
#include "sandbox/window/window.hpp"

namespace candela::sandbox {

/// Opens the scene with `open`, in another thread, shows it, plays its animation and handles the user's input
/// until the window is closed or the requested number of frames is done. Applies the configurations that
/// `watch` returns; errors in them are shown over the picture and on stderr, and the current configuration
/// stays. Then writes the picture of the last frame (without panels), the report and the graph, as the
/// options ask for.
///
/// Throws what `open` throws, std::runtime_error for outputs that cannot be written, gl::GlError, and
/// PictureError if the light does not add up. Ends the process if the window is closed while a frame takes
/// longer than a user should wait, because drivers do not interrupt frames.
void run_window(Window& window, const OpenScene& open, const Configuration& chosen, ConfigWatch& watch,
                const Options& options, const MakeReference& make_reference);

}  // namespace candela::sandbox
