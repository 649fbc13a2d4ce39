#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace candela {

/// Options of a Renderer for its whole life.
struct RendererOptions {
    /// The shaders are read from this directory. Empty: those embedded in the library.
    std::string shader_directory{};
    /// The compiled programs are kept in this directory, in the driver's own form, from which a later
    /// renderer has them faster. It is made if it is not there. Empty: nowhere. Each program is a file, named
    /// after a hash of its sources and of the driver's vendor, name and version. Other files, damaged ones
    /// and those that the driver refuses do no harm. Several renderers and processes may use the directory at
    /// a time, and the host may empty it at any time; nothing else does. If it cannot be written, `log` is
    /// told once. A driver need not give programs away: then the directory stays empty. The files are handed
    /// to the driver as they are, so that nobody else should be able to write them.
    std::string program_cache{};
    /// Turns on the debug output of the context, synchronously, as long as the renderer lives, and reports
    /// errors of the driver to `log`. A debug callback that the host has installed before still receives
    /// every message. Off: the debug state of the context is neither read nor changed.
    bool debug_output = false;
    /// Receives warnings, without a line break at their ends; the same line only once per renderer. Called
    /// during calls of the renderer, in the same thread. It must not throw, nor call GL or the renderer.
    /// Without it, warnings are lost: the library prints nothing.
    std::function<void(std::string_view line)> log{};
    /// Throws SceneError where parts of a world would otherwise be left out with a warning (see
    /// Renderer::render), and also if a normal is not of unit length, or if the surfaces of a HostSurfaces
    /// lie elsewhere than those of the world, or face another way. For development: the last of these waits
    /// for the GPU.
    bool checked = false;
    /// The host's GL state is the same after each call of the renderer as before: see Renderer::render. That
    /// takes about 300 state queries a frame. Off: nothing is asked or restored, and what the renderer has
    /// set stays, for hosts that set all state that they need; transform feedback must not be active.
    bool keeps_gl_state = true;
    /// Passes run in another order than usual, one of those that their declarations allow, which follows from
    /// this seed. For tests: if the picture is another one, a pass, perhaps the host's, has not declared what
    /// it depends on.
    std::optional<std::uint32_t> shuffle_passes{};
};

}  // namespace candela
