#pragma once

#include <cstdint>

namespace candela {

/// What the GPU time of a pass grows with. A pass declares it with Pass::note; by this the frame budget
/// predicts what a frame of another quality costs. An extension's passes may declare it too.
enum class Workload : std::uint8_t {
    other,       ///< neither of the following
    pixels,      ///< the number of rendered pixels
    pixels_vpls  ///< the number of rendered pixels times the VPLs that each evaluates
};

}  // namespace candela
