#pragma once

#include <string>
#include <string_view>

#include "sandbox/animation/animation.hpp"

namespace candela::study {

/// 16 hexadecimal digits that identify a scene (given by its hash) in the state of a script's frame `frame`
/// (>= 0) of a run. Frames with the same state have the same hash.
[[nodiscard]] std::string frame_hash(std::string_view scene_hash, const sandbox::Script& script, int frame);

}  // namespace candela::study
