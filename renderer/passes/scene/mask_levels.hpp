#pragma once

#include <optional>

#include <candela/scene/components.hpp>

namespace candela {

/// The share of an image whose alpha, interpolated, is at least `cutoff`: by 4,096 places, which are off by
/// about 0.1 %.
[[nodiscard]] float coverage(const Image& image, float cutoff);

/// A mip level with its alpha scaled so that a mask with this cutoff covers a share of it as near as possible
/// to `share`, in ]0, 1[ (Castaño, "Computing Alpha Mipmaps", 2010): the means of small holes and of what is
/// between them are all holes, or none, otherwise. Nullopt if that is not near: where alpha hardly varies any
/// more, no scale has a part of it above the cutoff.
[[nodiscard]] std::optional<Image> with_coverage(const Image& level, float cutoff, float share);

}  // namespace candela
