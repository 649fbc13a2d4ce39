#pragma once

#include <filesystem>
#include <optional>

#include "renderer/context/headless.hpp"
#include "renderer/renderer.hpp"
#include "sandbox/options.hpp"
#include "sandbox/report.hpp"
#include "sandbox/scene.hpp"

namespace candela::sandbox {

/// Where the headless picture goes: what --out says; else "candela.png" in the working directory, unless a
/// report or a graph is all that is asked for.
[[nodiscard]] std::optional<std::filesystem::path> picture_path(const Options& options);

/// The frames of a headless run: those asked for, else those of the scene's animation, else one.
[[nodiscard]] int frames_of(const Options& options, const Scene& scene);

/// Renders the frames, moving the scene by its animation, writes what the options ask for and prints a table
/// of the last frame. `context` is current. Throws std::runtime_error for outputs that cannot be written, and
/// gl::GlError for impossible sizes.
void run_headless(const HeadlessContext& context, Scene& scene, Entity camera,
                  const Configuration& configuration, const Options& options, glm::ivec2 size);

/// Writes --report and --describe-graph, as far as they are asked for.
void write_documents(const Options& options, const RunReport& report, const Renderer& renderer);

/// The configuration, which is valid, into a renderer that has just been made. Throws std::runtime_error.
void apply(Renderer& renderer, const Configuration& configuration);

}  // namespace candela::sandbox
