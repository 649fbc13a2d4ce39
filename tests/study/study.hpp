#pragma once

#include <filesystem>
#include <vector>

#include "renderer/renderer.hpp"

namespace candela::study {

// The parts of `candela-study`. Each prints a table and takes what follows its name on the command line.

/// What the frame graph itself costs. Arguments are Google Benchmark's.
int graph(int count, char** arguments);
/// Forward against deferred shading, and a frame in which nothing changed.
int shading(const std::filesystem::path& scene);
/// Error, bias and spikes of the indirect light for several bounds of the geometry term.
int bound(const std::filesystem::path& scene);

/// Which shading paths are timed on what.
struct PathStudy {
    std::filesystem::path scene;
    std::vector<ShadingPath> paths{all_shading_paths.begin(),
                                   all_shading_paths.end()};  ///< ratios are to the first
    glm::uvec2 size{640, 480};
    int rounds = 5;
    std::uint32_t vpls = 0;
    std::filesystem::path csv;  ///< lines are appended to it; empty: none
};
/// Frame times of shading paths, interleaved, with the share that goes into building lists.
int paths(const PathStudy& study);

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
    /// Four floats a pixel, row 0 at the bottom.
    [[nodiscard]] std::vector<float> pixels() const { return target_.read_floats(); }
    [[nodiscard]] Renderer& renderer() { return renderer_; }

 private:
    const World* world_;
    Entity camera_;
    Renderer renderer_;
    gl::Texture target_;
    gl::Framebuffer framebuffer_;
};

[[nodiscard]] double median(std::vector<double> values);

}  // namespace candela::study
