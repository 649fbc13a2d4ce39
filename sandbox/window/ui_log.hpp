#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "sandbox/panels/controls.hpp"
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// What the window shows in one frame.
struct UiRecord {
    int frame = 0;
    double time = 0.0;            ///< seconds since the start
    std::uint64_t picture = 0;    ///< number of the request whose picture is shown; 0: none yet
    std::uint64_t submitted = 0;  ///< number of the newest request
    bool settled = false;         ///< nothing more will change by itself
    std::string busy;             ///< what takes long; empty: nothing
    /// Seconds from the oldest input event that this picture answers to its presentation.
    std::optional<double> latency;
    Rectangle scene;
    float scale = 1.0F;
    std::string scene_file;
    glm::vec3 eye{0.0F};                  ///< world space, metres
    std::optional<std::string> selected;  ///< name
    std::optional<glm::vec3> position;    ///< of the selected, world space, metres
    std::string configuration;
    std::string show;
    CompareMode compare = CompareMode::off;
    std::optional<std::string> view;  ///< resource of the frame graph that is shown
    std::vector<std::string> errors;
    std::size_t undo = 0;  ///< edits that can be undone
    std::size_t redo = 0;
    std::uint32_t refined = 0;
    std::optional<double> rel_mse;
    ControlPlaces controls;
};

/// Writes a JSON object per line to a file whenever something in the window has changed: for automatic tests,
/// which find the controls by their labels in it.
class UiLog {
 public:
    /// Throws std::runtime_error that names the file if it cannot be written.
    explicit UiLog(const std::filesystem::path& path);

    void add(const UiRecord& record);

 private:
    std::ofstream file_;
    std::string last_;  ///< without what changes in every frame
};

}  // namespace candela::sandbox
