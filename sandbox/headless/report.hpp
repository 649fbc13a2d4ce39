#pragma once

#include <stdexcept>
#include <string>

#include <candela/report.hpp>
#include <candela/tools/picture.hpp>

namespace candela::sandbox {

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
void check_finite(const tools::Picture& picture, int frame);

/// Throws PictureError, which names the scene, if more than 1 % of the emitted flux is unaccounted for. With
/// surfels it throws only if the account is not finite.
void check_energy(const std::string& scene, const Report& state);

}  // namespace candela::sandbox
