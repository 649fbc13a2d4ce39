#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "renderer/renderer.hpp"
#include "sandbox/picture.hpp"
#include "tests/study/measures.hpp"

namespace candela::study {

/// The camera that everything is measured through: the scene's first. Throws std::invalid_argument if there
/// is none.
[[nodiscard]] Entity first_camera(const World& world);

/// Renders linear radiance of one scene through its first camera.
class Bench {
 public:
    /// The world and the context outlive the bench; the context is current.
    Bench(const gl::GetProc& get_proc, const World& world, glm::uvec2 size);

    /// Throws std::invalid_argument with the faults. Tone mapping is off whatever is asked.
    void configure(Configuration configuration);
    /// One frame, finished on the GPU: milliseconds of wall time. Another `jitter` than the last makes all
    /// that depends on the view run.
    double frame(glm::vec2 jitter);
    /// What the last frame shows.
    [[nodiscard]] sandbox::Picture picture() const;
    /// Pixels at which the last frame has something to shade.
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
