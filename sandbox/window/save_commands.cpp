#include "sandbox/window/save_commands.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <candela/tools/output_file.hpp>
#include "sandbox/animation/script_writer.hpp"
#include "sandbox/files/numbered_file.hpp"

namespace candela::sandbox {

namespace {

bool moves_anything(const Script& script) {
    return std::ranges::any_of(script.tracks, [](const Track& track) {
        return !track.translation.empty() || !track.rotation.empty() || !track.scale.empty() ||
               !track.intensity.empty() || !track.colour.empty();
    });
}

}  // namespace

SavedScene save_document(const Document& document) {
    const std::filesystem::path path = next_numbered_file(".gltf");
    const std::array of_app{document.interaction.viewer()};
    return {path, save_scene(document.scene.world, path, of_app)};
}

std::filesystem::path save_configuration(const Configuration& configuration) {
    std::filesystem::path path = next_numbered_file("-config.json");
    tools::write_text(path, write_configuration(configuration) + "\n");
    return path;
}

std::string toggle_recording(Document& document) {
    if (!document.recorder) {
        const std::optional<Entity> selected = document.interaction.selected;
        if (!selected) throw std::runtime_error("select what is to be recorded first");
        document.recorder.emplace(document.scene.world, *selected);
        return "recording the motion of the selection; Ctrl+R ends it";
    }
    const Script script = document.recorder->finish();
    document.recorder.reset();
    if (!moves_anything(script)) return "nothing has moved: no script was written";
    const std::filesystem::path path = next_numbered_file("-animation.json");
    save_script(script, document.scene.path, path);
    return written(path);
}

std::string written(const std::filesystem::path& path) {
    return fmt::format("wrote {}", std::filesystem::absolute(path).lexically_normal().string());
}

}  // namespace candela::sandbox
