#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include <candela/renderer.hpp>
#include <candela/tools/picture.hpp>
#include "renderer/gl/texture.hpp"
#include "tests/study/measures.hpp"

namespace candela::study {

/// The camera used for all measurements: the scene's first one. Throws std::invalid_argument if there is
/// none.
[[nodiscard]] Entity first_camera(const World& world);

/// Renders linear radiance of one scene through its first camera.
class Bench {
 public:
    /// The world and the context must outlive the bench; the context must be current.
    Bench(const gl::GetProc& get_proc, const World& world, glm::uvec2 size);

    /// Throws std::invalid_argument with the errors. Tone mapping is always off.
    void configure(Configuration configuration);
    /// Renders one frame and waits for the GPU; returns milliseconds of wall time. A `jitter` different from
    /// that of the last frame makes everything run that depends on the view.
    double frame(glm::vec2 jitter);
    /// Renders the last frame again and returns VplReport::estimated_error; none without VPLs.
    std::optional<double> estimate_error();
    /// The picture of the last frame.
    [[nodiscard]] tools::Picture picture() const;
    /// The number of pixels that show a surface in the last frame.
    [[nodiscard]] std::size_t covered_pixels() const;
    [[nodiscard]] Renderer& renderer() { return renderer_; }

 private:
    const World* world_;
    Entity camera_;
    Renderer renderer_;
    gl::Texture target_;
    gl::Framebuffer framebuffer_;
};

[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] Errors mean(std::span<const Errors> errors);

}  // namespace candela::study
