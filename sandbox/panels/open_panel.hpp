#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace candela::sandbox {

/// A list of scenes under a heading.
struct SceneList {
    std::string heading;
    std::vector<std::filesystem::path> files;
};

/// A window in which the user names a file, or picks one from lists.
class OpenPanel {
 public:
    /// Shows it from the next frame on.
    void show(std::vector<SceneList> lists);
    [[nodiscard]] bool is_shown() const { return shown_; }
    void hide() { shown_ = false; }

    /// Draws it if it is shown. The file that the user has chosen, in one frame.
    [[nodiscard]] std::optional<std::filesystem::path> draw();

 private:
    bool shown_ = false;
    bool appearing_ = false;
    std::string typed_;
    std::vector<SceneList> lists_;
};

}  // namespace candela::sandbox
