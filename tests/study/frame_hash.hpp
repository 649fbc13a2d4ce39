#pragma once

#include <string>
#include <string_view>

#include "sandbox/animation.hpp"

namespace candela::study {

/// 16 hexadecimal digits that stand for a scene, itself known by its hash, as a script has it in frame
/// `frame`, >= 0, of a run. Frames in which everything is at the same place have the same.
[[nodiscard]] std::string frame_hash(std::string_view scene_hash, const sandbox::Script& script, int frame);

}  // namespace candela::study
