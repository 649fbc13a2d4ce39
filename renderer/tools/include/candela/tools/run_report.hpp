#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/configuration.hpp>
#include <candela/report.hpp>
#include <candela/scene/components.hpp>

namespace candela::tools {

/// What a program has rendered, how, and how long it took.
struct RunReport {
    std::string context;                   ///< "window", or HeadlessContext::description
    std::string scene;                     ///< the file
    std::optional<std::string> animation;  ///< the file with what has moved
    glm::ivec2 size{0};                    ///< pixels
    Configuration configuration;
    std::vector<FrameReport> frames;
    Report state;               ///< after the last frame
    Environment environment{};  ///< after the last frame; radiance 0: none
};

/// As JSON, with the names of the members of these structs; those of `state` are beside the others. Energies
/// are lists of one number per colour channel, times in milliseconds, memory in bytes; `config` is what
/// write_configuration writes.
[[nodiscard]] CANDELA_API std::string to_json(const RunReport& report);

/// An entry of the account, for tables.
struct EnergyLine {
    const char* name;
    glm::dvec3 value;
};
[[nodiscard]] CANDELA_API std::vector<EnergyLine> energy_lines(const EnergyAccount& flux);

}  // namespace candela::tools
