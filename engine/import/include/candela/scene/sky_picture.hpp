#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include <candela/api.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>

namespace candela {

/// Reads an equirectangular picture of the sky from a Radiance (.hdr) or OpenEXR (.exr) file. It must be
/// twice as wide as high and at most 16,384 pixels wide. Throws SceneError, whose message is one line that
/// names the file and the problem.
[[nodiscard]] CANDELA_API std::shared_ptr<const SkyPicture> load_sky_picture(
    const std::filesystem::path& path);

/// The same from memory. The message names no file.
[[nodiscard]] CANDELA_API std::shared_ptr<const SkyPicture> decode_sky_picture(
    std::span<const unsigned char> bytes);

}  // namespace candela
