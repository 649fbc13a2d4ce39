#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/configuration.hpp>
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// How two configurations are compared.
enum class CompareMode : std::uint8_t {
    off,
    divider,    ///< the first left of a line that can be dragged, the second right of it
    difference  ///< |first - second|, times a factor
};

/// The comparison of the configuration with a second one.
struct Comparison {
    CompareMode mode = CompareMode::off;
    Configuration other;
    bool with_reference = false;  ///< the second picture is the path tracer's, not that of `other`
    float divider = 0.5F;         ///< position of the line, a fraction of the picture's width
    float factor = 8.0F;          ///< of differences
};

/// What the user has chosen to see, and what the app has to say about it. Panels change it; the session acts
/// on it.
struct AppState {
    double update_budget_ms = 0.0;  ///< see UpdateBudget
    double noise_limit = 0.005;     ///< see FrameRequest
    Configuration configuration;    ///< wanted; a faulty one is not taken over: see errors
    Comparison comparison;
    bool panel = true;
    bool help = false;
    bool vpls = false;                    ///< VPLs are shown as dots
    std::optional<glm::vec3> chosen_vpl;  ///< place: of the VPL next to it the details are shown
    bool estimate_error = false;          ///< of the VPLs' light
    bool probe = false;                   ///< the values of the pixel under the pointer are shown
    std::optional<glm::uvec2> probed;     ///< that pixel, across and up
    /// The path tracer's picture of what is shown is refined in the background, and compared with it.
    bool reference = false;
    /// What the scene's file asks for and the picture lacks, and what the renderer left out.
    std::vector<std::string> warnings;
    std::vector<std::string> errors;       ///< of the last thing that failed
    std::optional<ReferenceErrors> error;  ///< of the picture over the reference
    std::string notice;                    ///< what was last done, for example which file was written
};

}  // namespace candela::sandbox
