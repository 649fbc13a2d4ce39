#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include <candela/configuration.hpp>
#include <candela/headless_context.hpp>

namespace candela::study {

// The subcommands of `candela-study`. Each prints a table or JSON lines.

/// The cost of the frame graph itself. The arguments are those of Google Benchmark.
int graph(int count, char** arguments);
/// The cost of World, likewise.
int world(int count, char** arguments);
/// Runs the benchmarks that are registered; for those two.
int run_benchmarks(int count, char** arguments);

/// Compares forward with deferred shading, and measures a frame in which nothing changed.
int shading(const std::filesystem::path& scene);

/// The input of `frames`.
struct FramesStudy {
    std::filesystem::path scene;
    glm::uvec2 size{1920, 1080};
    std::vector<std::uint32_t> vpls{512, 4096};
    int rounds = 9;
};
/// Times of a frame in which nothing changed, of one after the camera and one after a light moved by a
/// millimetre, and of one that is computed anew; with the GPU's times of their passes.
int frames(const FramesStudy& study);

/// The input of `gather`.
struct GatherStudy {
    std::filesystem::path scene;
    glm::uvec2 size{512, 512};
    std::vector<std::uint32_t> vpls{256, 1024};
    int rounds = 5;
};
/// Compares interleaved gathering of indirect light with gathering all VPLs at every pixel: time and
/// difference.
int gather(const GatherStudy& study);

/// The input of `paths`.
struct PathStudy {
    std::filesystem::path scene;
    std::vector<ShadingPath> paths{all_shading_paths.begin(),
                                   all_shading_paths.end()};  ///< ratios are relative to the first one
    glm::uvec2 size{640, 480};
    int rounds = 5;
    std::uint32_t vpls = 0;
    std::filesystem::path csv;  ///< lines are appended to it; empty: no file
};
/// Frame times of shading paths, measured in turns, with the share that building lists takes.
int paths(const PathStudy& study);

/// The input of `reference`: see reference::Settings.
struct ReferenceStudy {
    std::filesystem::path scene;
    glm::uvec2 size{1};  ///< pixels
    std::uint32_t samples = 0;
    std::optional<std::uint32_t> bounces;
    std::uint32_t seed = 0;
    bool no_caustics = false;
    std::filesystem::path out;  ///< the folder; unchanged if it already holds the same
};
/// Traces a reference for the renderer's pictures.
int reference(const ReferenceStudy& study);

/// The input of `baseline`.
struct BaselineStudy {
    std::filesystem::path scene;
    std::filesystem::path reference;  ///< the folder
    std::vector<std::uint32_t> samples;
    std::uint32_t rounds = 3;
};
/// Error and time of the path tracer itself: one line of JSON for each number of samples per pixel.
int baseline(const BaselineStudy& study);

/// The input of `measure`: which points are measured against which reference.
struct MeasureStudy {
    std::filesystem::path scene;
    std::filesystem::path reference;              ///< the folder
    std::filesystem::path points;                 ///< see read_points
    std::filesystem::path pictures;               ///< the folder for pictures and heat maps
    std::uint32_t rounds = 3;                     ///< of time measurements; 0: errors only
    std::optional<std::filesystem::path> beside;  ///< a scene that is timed in turns with this one
    ContextKind context = ContextKind::egl;
};
/// Error, work, memory and times of configurations; a line of JSON as soon as each is known.
int measure(const MeasureStudy& study);

/// The input of `animate`: which points are rendered with which script.
struct AnimateStudy {
    std::filesystem::path script;      ///< a file, or the name of a shipped one; it must name its scene
    std::filesystem::path references;  ///< the folder of the frames' references, one folder each
    std::filesystem::path points;      ///< see read_points; only the first seed is used
    glm::uvec2 size{1};                ///< pixels
    std::uint32_t samples = 0;         ///< of the references, like the next two: see reference::Settings
    std::optional<std::uint32_t> bounces;
    std::uint32_t seed = 0;
    int frames = 0;  ///< 0: the length of the script
    ContextKind context = ContextKind::egl;
};
/// Error, time and work of each frame of a script, as one line of JSON per frame, and the flicker of each
/// point at its end. Frames that show the same share a reference.
int animate(const AnimateStudy& study);

/// The input of `moves`.
struct MovesStudy {
    glm::uvec2 size{128, 96};
    std::uint32_t vpls = 256;
    int rounds = 15;
};
/// Prints the cost of such frames in the Cornell box: of a still one relative to the passes of a full frame
/// before shading, of the others for VPLs.
int moves(const MovesStudy& study);

/// The input of `edits`.
struct EditsStudy {
    int rounds = 5;                     ///< of two edits each
    std::vector<std::uint32_t> things;  ///< worlds of so many; none: a few scenes with large meshes
};
/// Prints the CPU time and the uploaded bytes of frames in which meshes come, go or move.
int edits(const EditsStudy& study);

/// The input of `start`.
struct StartStudy {
    std::filesystem::path scene;
    glm::uvec2 size{200, 150};
    int rounds = 5;
};
/// Prints what it takes from the constructor of a renderer to its first picture, of an empty world and of a
/// scene: without a program cache, with one that was filled before, and what of it `prepare` can do ahead.
/// Each start is a process of its own, in which the driver's own cache is empty if the driver is Mesa.
int start(const StartStudy& study);

/// The input of `scale`.
struct ScaleStudy {
    std::filesystem::path scene;
    glm::uvec2 size{512, 512};
};
/// Prints, as a line of JSON, the time to load a scene, that of its first frame with clustered
/// deferred shading, and the largest memory of the process.
int scale(const ScaleStudy& study);

/// The input of `figures`.
struct FigureStudy {
    std::uint32_t figures = 100;
    bool own_clips = false;  ///< a clip for each figure, in place of one that all share
    int rounds = 200;        ///< frames
};
/// Prints the CPU time that animated figures with skeletons take in each frame, on one thread, without the
/// renderer.
int figures(const FigureStudy& study);

}  // namespace candela::study
