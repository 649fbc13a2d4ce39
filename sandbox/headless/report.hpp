#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/renderer.hpp>
#include <candela/scene/components.hpp>
#include "sandbox/files/picture.hpp"

namespace candela::sandbox {

/// The contents of report.json.
struct RunReport {
    std::string context;  ///< "window", "EGL device /dev/dri/card0", "OSMesa", ...
    std::string scene;
    std::optional<std::string> animation;  ///< the script file
    glm::ivec2 size{0};                    ///< pixels
    Configuration configuration;
    std::vector<FrameReport> frames;
    Report state;               ///< after the last frame
    Environment environment{};  ///< after the last frame; radiance 0: none
};

/// As JSON; energies per colour channel, times in milliseconds, memory in bytes.
[[nodiscard]] std::string to_json(const RunReport& report);

/// A short table for the terminal: passes with their times, then light counts and the energy account.
[[nodiscard]] std::string to_table(const FrameReport& frame, const Report& state);

/// The flux that the account does not explain, relative to the emitted flux: the largest of the three
/// channels; infinite if a channel is not finite.
[[nodiscard]] double relative_residual(const EnergyAccount& flux);

/// A picture was rendered, but is wrong: its light does not add up, or pixels are not finite.
struct PictureError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws PictureError if the picture of this frame has pixels that are not finite.
void check_finite(const Picture& picture, int frame);

/// Throws PictureError, which names the scene, if more than 1 % of the emitted flux is unaccounted for. With
/// surfels it throws only if the account is not finite.
void check_energy(const std::string& scene, const Report& state);

/// An entry of the account, for tables.
struct EnergyLine {
    const char* name;
    glm::dvec3 value;
};
[[nodiscard]] std::vector<EnergyLine> energy_lines(const EnergyAccount& flux);

}  // namespace candela::sandbox
