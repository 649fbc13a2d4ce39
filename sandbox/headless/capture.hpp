#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <candela/renderer.hpp>
#include "sandbox/files/picture.hpp"
#include "sandbox/headless/canvas.hpp"

namespace candela::sandbox {

/// The offset of the i-th of `count` samples from the pixel centre, in pixels. The mean of all offsets is 0.
[[nodiscard]] glm::vec2 pixel_jitter(int i, int count);

/// The cost of one picture: the sums over its samples, and the renderer's state after the last one.
struct CaptureReport {
    FrameReport frame;
    Report state;
};

/// Renders pictures for output files, into its own framebuffer.
class Capture {
 public:
    /// Keeps a reference to the renderer and leaves its configuration unchanged. `size` is in pixels. Throws
    /// gl::GlError if the driver does not support the size.
    Capture(Renderer& renderer, glm::ivec2 size);

    /// The mean of `samples` frames in linear radiance, jittered within the pixel (a box filter). With
    /// refinement the renderer does the jittering and averaging itself; then `samples` further frames go into
    /// its running mean, and that mean is returned.
    [[nodiscard]] Picture render(const World& world, Entity camera, int samples, CaptureReport& report);

    /// Renders the last frame again and returns VplReport::estimated_error; none without VPLs.
    [[nodiscard]] std::optional<double> estimate_error(const World& world, Entity camera);

    /// The picture through the renderer's tone map: sRGB, 3 bytes per pixel, row 0 at the top.
    [[nodiscard]] std::vector<std::uint8_t> tone_mapped(const Picture& picture);

    /// Writes the format that the file extension names: .png tone-mapped, .exr and .pfm linear. Throws
    /// std::runtime_error that names the file and the error.
    void write(const std::filesystem::path& path, const Picture& picture);

 private:
    void add_pixels(std::vector<glm::vec3>& sum) const;

    Renderer* renderer_;
    glm::uvec2 size_;
    Canvas linear_;
    Canvas encoded_;
};

}  // namespace candela::sandbox
