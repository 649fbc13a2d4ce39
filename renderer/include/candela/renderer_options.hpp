#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace candela {

/// Options of a Renderer for its whole life.
struct RendererOptions {
    /// The shaders are read from this directory. Empty: those embedded in the library.
    std::filesystem::path shader_directory{};
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
};

}  // namespace candela
