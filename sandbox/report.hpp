#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "renderer/renderer.hpp"

namespace candela::sandbox {

/// What a run leaves in report.json.
struct RunReport {
    std::string context;  ///< "window", "EGL device /dev/dri/card0", "OSMesa", ...
    std::string scene;
    std::optional<std::string> animation;  ///< the script's file
    glm::ivec2 size{0};                    ///< pixels
    Configuration configuration;
    std::vector<FrameReport> frames;
    Report state;  ///< after the last frame
};

/// As JSON; energies by colour, times in milliseconds, memory in bytes.
[[nodiscard]] std::string to_json(const RunReport& report);

/// A short table for the terminal: passes with their times, then counts and the energy account.
[[nodiscard]] std::string to_table(const FrameReport& frame, const Report& state);

/// Flux that the account does not explain, relative to what was emitted: the largest of the three channels;
/// infinite where one is not a number.
[[nodiscard]] double relative_residual(const EnergyAccount& flux);

/// The light of a picture does not add up.
struct EnergyError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws EnergyError, which names the scene, where more than a hundredth of the emitted flux is unaccounted
/// for; of surfels, only where it is not finite.
void check_energy(const std::string& scene, const Report& state);

/// An item of the account, for tables.
struct EnergyLine {
    const char* name;
    glm::dvec3 value;
};
[[nodiscard]] std::vector<EnergyLine> energy_lines(const EnergyAccount& flux);

}  // namespace candela::sandbox
