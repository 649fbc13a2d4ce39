#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include <glm/vec2.hpp>

#include <candela/configuration.hpp>
#include <candela/scene/gltf.hpp>
#include "sandbox/command_line/command_line.hpp"
#include "sandbox/scene/environment.hpp"

namespace candela::sandbox {

/// Where the GL context comes from. `automatic`: a window if there is a display, else EGL, else OSMesa.
enum class ContextChoice : std::uint8_t { automatic, window, egl, osmesa };

/// The command line.
struct Options {
    ImportLimits limits;   ///< of scenes
    bool confine = false;  ///< scenes may only refer to files in their own folder, or below it
    std::optional<std::filesystem::path> scene;  ///< default: the script's, else the shipped Cornell box
    bool headless = false;                       ///< also set by a `context` without windows
    ContextChoice context = ContextChoice::automatic;
    std::optional<glm::ivec2> size;  ///< pixels; default: 1280x720 in a window, 512x512 headless
    std::optional<int> frames;       ///< default: headless 1 or the script's length, unlimited in a window
    int samples = 1;                 ///< number of averaged frames, jittered within the pixel
    std::optional<double> update_budget;  ///< milliseconds, see UpdateBudget; default: 60 in a window, else 0
    std::optional<SkyChoice> environment;  ///< default: that of the scene
    std::optional<std::string> camera;     ///< name or index; default: the scene's first

    std::optional<std::string> clip;  ///< name or index; default: the scene's first
    double clip_time = 0.0;           ///< seconds, of the first frame in the clip

    std::map<std::string, std::string> settings;   ///< values by the flag that was given: "--vpls", "64"
    std::optional<std::filesystem::path> animate;  ///< a script file, or the name of a shipped script
    std::optional<std::filesystem::path> config;
    std::optional<std::filesystem::path> shaders;  ///< a directory; default: the shaders in the library
    bool print_config = false;

    std::optional<std::filesystem::path> out;             ///< .png, .exr or .pfm; default: see picture_path
    std::optional<std::filesystem::path> report;          ///< .json
    std::optional<std::filesystem::path> describe_graph;  ///< .txt
    std::optional<std::filesystem::path> ui_log;          ///< .jsonl
    bool list_configs = false;
};

/// Parses the command line; `arguments[0]` is the program. Of the files it checks only whether the
/// configuration file and the folders of output files exist. Errors have exit status 2.
[[nodiscard]] std::variant<Options, EarlyExit> parse_options(int count, const char* const* arguments);

/// Changes the settings whose flags were given. Throws FlagError.
void apply_settings(const Options& options, Configuration& configuration);

/// How scenes are imported.
[[nodiscard]] ImportOptions import_options(const Options& options);

/// The picture's file name for frame `frame`: every "%d" in the name is replaced by the number, and "%05d" by
/// the number with at least five digits. Without them all frames have the same name, and only the last one is
/// written.
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& out, int frame);
/// Whether each frame has a file of its own.
[[nodiscard]] bool is_numbered(const std::filesystem::path& out);

}  // namespace candela::sandbox
