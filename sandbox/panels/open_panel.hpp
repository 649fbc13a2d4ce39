#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sandbox/files/folder.hpp"

namespace candela::sandbox {

/// A list of scenes under a heading.
struct SceneList {
    std::string heading;
    std::vector<std::filesystem::path> files;
};

/// A window in which the user picks a file from lists, or from a folder. There it can be typed, completed
/// with Tab and marked with the arrow keys.
class OpenPanel {
 public:
    /// Shows it from the next frame on, at this folder.
    void show(std::vector<SceneList> lists, const std::filesystem::path& folder);
    [[nodiscard]] bool is_shown() const { return browser_.has_value(); }
    void hide() { browser_.reset(); }

    /// Draws it if it is shown. The file that the user has chosen, in one frame.
    [[nodiscard]] std::optional<std::filesystem::path> draw();

 private:
    using Chosen = std::optional<std::filesystem::path>;

    [[nodiscard]] Chosen draw_name();
    [[nodiscard]] Chosen draw_lists() const;
    [[nodiscard]] Chosen draw_folder();
    [[nodiscard]] Chosen pick(const std::filesystem::path& path);

    std::vector<SceneList> lists_;
    std::optional<FolderBrowser> browser_;  ///< while the window is shown
    std::string typed_;
    bool focuses_ = false;  ///< the field gets the keyboard
    bool scrolls_ = false;  ///< to the marked entry
};

}  // namespace candela::sandbox
