#pragma once

#include <filesystem>
#include <optional>

#include <candela/headless_context.hpp>
#include <candela/renderer.hpp>
#include <candela/tools/capture.hpp>
#include <candela/tools/run_report.hpp>
#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/command_line/options.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// Where the headless picture goes: the file given by --out; otherwise "candela.png" in the working
/// directory, or no file if only a report or a graph is asked for.
[[nodiscard]] std::optional<std::filesystem::path> picture_path(const Options& options);

/// The number of frames of a headless run: as given by the options, else the length of the animation, else 1.
[[nodiscard]] int frames_of(const Options& options, const Scene& scene);

/// Renders the frames, applies the scene's animation, writes what the options ask for and prints a table of
/// the last frame. `context` must be current. Throws std::runtime_error for outputs that cannot be written,
/// gl::GlError for unsupported sizes, and PictureError if a picture is not finite or if the light of the last
/// frame does not add up. After SIGINT or SIGTERM, the frame that is being rendered is the last one, with the
/// samples that it has by then. Returns success, or by what signal it was stopped.
[[nodiscard]] ExitStatus run_headless(const HeadlessContext& context, Scene& scene, Entity camera,
                                      const Configuration& configuration, const Options& options,
                                      glm::ivec2 size);

/// Writes --report if it is asked for.
void write_report(const Options& options, const tools::RunReport& report);

/// Writes --describe-graph if it is asked for.
void write_graph(const Options& options, const Renderer& renderer);

/// Like Capture::render, but at full quality, whatever the frame budget is, and with all surfels traced. The
/// renderer has no limits from then on.
[[nodiscard]] tools::Picture whole_picture(Renderer& renderer, tools::Capture& capture, const World& world,
                                           Entity camera, int samples);

}  // namespace candela::sandbox
