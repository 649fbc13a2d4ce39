#pragma once

#include <vector>

#include "tests/window/app.hpp"

namespace candela::sandbox {

/// Drags the light through the shipped Cornell box, which the app shows by its own camera: `steps` movements
/// of the pointer, 20 ms apart. Then undoes that. Returns the seconds from a movement to the picture that
/// shows its effect, for each such picture.
[[nodiscard]] std::vector<double> drag_light(App& app, int steps);

}  // namespace candela::sandbox
