#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "renderer/renderer.hpp"
#include "sandbox/picture.hpp"

namespace candela::sandbox {

/// Where the i-th of `count` samples lies in a pixel, in pixels from its centre, on which their mean lies.
[[nodiscard]] glm::vec2 pixel_jitter(int i, int count);

/// What one picture took: the sums over its samples, and the state after them.
struct CaptureReport {
    FrameReport frame;
    Report state;
};

/// Renders pictures that go to files, into a framebuffer of its own.
class Capture {
 public:
    /// Refers to the renderer, whose configuration it leaves as it is. Throws gl::GlError if the driver does
    /// not allow the size (pixels).
    Capture(Renderer& renderer, glm::ivec2 size);

    /// The mean of so many frames, jittered within the pixel (a box filter), in linear radiance. With
    /// refinement, which does both, so many frames more are in its mean.
    [[nodiscard]] Picture render(const World& world, Entity camera, int samples, CaptureReport& report);

    /// The picture through the renderer's tone map: sRGB-encoded, three bytes a pixel, row 0 at the top.
    [[nodiscard]] std::vector<std::uint8_t> tone_mapped(const Picture& picture);

    /// Writes what the file's extension says: .png tone-mapped, .exr and .pfm linear. Throws
    /// std::runtime_error that names the file and the fault.
    void write(const std::filesystem::path& path, const Picture& picture);

 private:
    /// A colour texture, and the framebuffer that draws into it.
    struct Canvas {
        gl::Texture colour;
        gl::Framebuffer framebuffer;
        Canvas(gl::Device& device, glm::uvec2 size, Format format);
    };

    void add_pixels(std::vector<glm::vec3>& sum) const;

    Renderer* renderer_;
    glm::uvec2 size_;
    Canvas linear_;
    Canvas encoded_;
};

}  // namespace candela::sandbox
