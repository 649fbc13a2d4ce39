#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/api.hpp>
#include <candela/gl_loader.hpp>
#include <candela/renderer.hpp>
#include <candela/tools/picture.hpp>

namespace candela::tools {

/// The offset of the i-th of `count` samples from the pixel centre, in pixels. The mean of all offsets is 0.
[[nodiscard]] CANDELA_API glm::vec2 pixel_jitter(int i, int count);

/// The cost of one picture: the sums over its samples, and the renderer's state after the last one.
struct CaptureReport {
    FrameReport frame;
    Report state;
};

/// Renders pictures for output files, into framebuffers of its own. The renderer's context must be current in
/// every call, including the destructor; its GL state is the same afterwards, as after Renderer::render.
class CANDELA_API Capture {
 public:
    /// Keeps a reference to the renderer and leaves its configuration unchanged. `get_proc` is what the
    /// renderer was made with; it is called only here. `size` is in pixels. Throws gl::GlError if the driver
    /// does not support the size.
    Capture(Renderer& renderer, const gl::GetProc& get_proc, glm::ivec2 size);
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;
    ~Capture();

    /// The mean of `samples` >= 1 frames in linear radiance, jittered within the pixel (a box filter). With
    /// refinement the renderer does the jittering and averaging itself; then `samples` further frames go into
    /// its running mean, and that mean is returned. `goes_on`, if any, is asked after each frame; false:
    /// there are no more samples than those until then. Throws what Renderer::render throws.
    [[nodiscard]] Picture render(const World& world, Entity camera, int samples, CaptureReport& report,
                                 const std::function<bool()>& goes_on = {});
    [[nodiscard]] Picture render(const World& world, Entity camera, int samples);

    /// Renders the last frame again and returns VplReport::estimated_error; none without VPLs.
    [[nodiscard]] std::optional<double> estimate_error(const World& world, Entity camera);

    /// A picture of the same size through the renderer's tone map: sRGB, 3 bytes per pixel, row 0 at the top.
    /// Throws gl::GlError if it has another size.
    [[nodiscard]] std::vector<std::uint8_t> tone_mapped(const Picture& picture);

    /// Writes the format that the file extension names: .png tone-mapped, .exr and .pfm linear. Throws
    /// ToolError that names the file and the error.
    void write(const std::filesystem::path& path, const Picture& picture);

 private:
    class State;

    std::unique_ptr<State> state_;
};

}  // namespace candela::tools
