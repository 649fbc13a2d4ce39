#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "renderer/configuration/configuration.hpp"
#include "renderer/context/headless.hpp"

namespace candela::study {

// The parts of `candela-study`. Each prints a table and takes what follows its name on the command line.

/// What the frame graph itself costs. Arguments are Google Benchmark's.
int graph(int count, char** arguments);
/// Forward against deferred shading, and a frame in which nothing changed.
int shading(const std::filesystem::path& scene);

/// What interleaved gathering is timed on.
struct GatherStudy {
    std::filesystem::path scene;
    glm::uvec2 size{512, 512};
    std::vector<std::uint32_t> vpls{256, 1024};
    int rounds = 5;
};
/// Time and difference of indirect light that is gathered interleaved, of asking all VPLs at every pixel.
int gather(const GatherStudy& study);

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

/// How `reference` traces: see reference::Settings.
struct ReferenceStudy {
    std::filesystem::path scene;
    glm::uvec2 size{1};  ///< pixels
    std::uint32_t samples = 0;
    std::optional<std::uint32_t> bounces;
    std::uint32_t seed = 0;
    std::filesystem::path out;  ///< the folder; left alone if it holds the same already
};
/// Traces what the renderer's pictures are measured against.
int reference(const ReferenceStudy& study);

/// What the path tracer is asked for in the place of the renderer.
struct BaselineStudy {
    std::filesystem::path scene;
    std::filesystem::path reference;  ///< the folder
    std::vector<std::uint32_t> samples;
    std::uint32_t rounds = 3;
};
/// Error and time of the path tracer itself: a line of JSON for each number of samples a pixel.
int baseline(const BaselineStudy& study);

/// Which points are measured against which reference.
struct MeasureStudy {
    std::filesystem::path scene;
    std::filesystem::path reference;  ///< the folder
    std::filesystem::path points;     ///< see read_points
    std::filesystem::path pictures;   ///< the folder that pictures and heat maps go to
    std::uint32_t rounds = 3;         ///< of times; 0: errors only
    ContextKind context = ContextKind::egl;
};
/// Error, work, memory and times of configurations, a line of JSON as each is known.
int measure(const MeasureStudy& study);

/// Which points are played through which script.
struct AnimateStudy {
    std::filesystem::path script;      ///< a file, or the name of a shipped one; it names its scene
    std::filesystem::path references;  ///< the folder of the frames' references, each in a folder of its own
    std::filesystem::path points;      ///< see read_points; of seeds only the first counts
    glm::uvec2 size{1};                ///< pixels
    std::uint32_t samples = 0;         ///< of the references, and so on: see reference::Settings
    std::optional<std::uint32_t> bounces;
    std::uint32_t seed = 0;
    int frames = 0;  ///< 0: as many as the script has
    ContextKind context = ContextKind::egl;
};
/// Error, time and work of each frame of a script, a line of JSON each, and a point's flicker at its end.
/// Frames that show the same share a reference.
int animate(const AnimateStudy& study);

/// What a frame costs in which nothing, the camera or a light moved.
struct MovesStudy {
    glm::uvec2 size{128, 96};
    std::uint32_t vpls = 256;
    int rounds = 15;
};
/// Prints ratios of what frames spend before shading, and on VPLs, in the Cornell box.
int moves(const MovesStudy& study);

}  // namespace candela::study
