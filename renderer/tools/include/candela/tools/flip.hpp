#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <candela/api.hpp>
#include <candela/tools/picture.hpp>

namespace candela::tools {

/// The difference that an observer notices when a picture and its reference alternate on a screen; 0 to 1.
struct Flip {
    double mean = 0.0;        ///< over the pixels that count
    std::vector<double> map;  ///< one value per pixel, row 0 at the top
};

/// The measure for low dynamic range of Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating
/// Images", 2020, for an observer who sees 67 pixels per degree. Pixels are linear RGB of the screen, clamped
/// to [0, 1]. The map covers all pixels; the mean excludes those that do not count in `hit`. Throws as
/// `relative_mse` does.
[[nodiscard]] CANDELA_API Flip flip(const Picture& picture, const Picture& reference,
                                    std::span<const std::uint8_t> hit = {});

/// The same of pictures of radiance as a renderer with automatic exposure would show them: both with the
/// exposure of the reference (automatic_exposure) and the filmic curve (displayed).
[[nodiscard]] CANDELA_API Flip flip_of_light(const Picture& picture, const Picture& reference,
                                             std::span<const std::uint8_t> hit = {});

/// The factor that ToneMapSettings::automatic_exposure gives a picture of radiance: 0.18 / its log-average
/// luminance (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equations 1 and 2),
/// within 2^-10 to 2^10. Pixels count as they do there; 1 if none does.
[[nodiscard]] CANDELA_API double automatic_exposure(const Picture& radiance);

/// Linear RGB of the screen, from 0 to 1, for radiance times `exposure`, by ToneCurve::filmic.
[[nodiscard]] CANDELA_API Picture displayed(const Picture& radiance, double exposure);

}  // namespace candela::tools
