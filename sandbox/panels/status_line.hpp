#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <candela/configuration.hpp>
#include <candela/report.hpp>
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// What the line at the top of the window says.
struct Status {
    double frame_ms = 0.0;  ///< of the last frame in which more than the target was drawn
    double mean_ms = 0.0;
    std::uint32_t vpls = 0;
    std::uint32_t refined = 0;      ///< frames that the picture averages
    std::uint32_t to_refine = 0;    ///< frames that it will average; 0: refinement is off
    std::optional<double> noise{};  ///< of the picture, relative
    Quality quality{};
    bool settled = false;
    std::string warning;  ///< why the picture may not be as wanted; empty: for no reason
    std::string busy;     ///< what takes long at present, for example "compiling shaders"; empty: nothing
};

/// The status as words, for example "9.3 ms (mean 10.1) · 512 VPLs · refined 12/1024".
[[nodiscard]] std::string to_words(const Status& status);

/// Draws the line. `seconds`: the time, which turns the spinner.
void draw_status_line(const Status& status, const Rectangle& at, double seconds);

}  // namespace candela::sandbox
