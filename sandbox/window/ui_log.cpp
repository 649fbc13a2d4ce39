#include "sandbox/window/ui_log.hpp"

#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sandbox/candela_private.hpp"
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/editing/placing.hpp"

namespace candela::sandbox {

namespace {

using Json = nlohmann::json;

Json to_json(const Rectangle& at) {
    return {at.corner.x, at.corner.y, at.size.x, at.size.y};
}

Json to_json(const glm::vec3& point) {
    return {point.x, point.y, point.z};
}

template <class T>
Json to_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

std::string_view to_string(CompareMode mode) {
    switch (mode) {
        case CompareMode::divider:
            return "divider";
        case CompareMode::difference:
            return "difference";
        case CompareMode::off:
            break;
    }
    return "off";
}

Json to_json(const Document& document) {
    const World& world = document.scene.world;
    const Interaction& interaction = document.interaction;
    const std::optional<Entity> selected = interaction.selected;
    return {{"scene_file", document.scene.path.string()},
            {"eye", to_json(position_of(world, interaction.viewer()))},
            {"selected", selected ? Json(name_of(world, *selected)) : Json()},
            {"position", selected ? to_json(position_of(world, *selected)) : Json()},
            {"undo", interaction.history().undo_count()},
            {"redo", interaction.history().redo_count()}};
}

/// What is the same while nothing happens.
Json lasting(const SessionState& state, const UiFrame& frame) {
    const AppState& app = state.app;
    const Report* report = state.report();
    Json controls = Json::object();
    for (const auto& [label, place] : frame.controls) controls[label] = to_json(place);
    Json json{{"picture", state.shown ? state.shown->request : 0},
              {"submitted", state.submitted},
              {"settled", state.is_settled()},
              {"busy", state.busy.empty() ? Json() : Json(state.busy)},
              {"latency", to_json(frame.latency)},
              {"scene", to_json(state.layout.scene)},
              {"scale", frame.scale},
              {"configuration", name_of(app.configuration)},
              {"show", to_string(app.configuration.show)},
              {"compare", to_string(app.comparison.mode)},
              {"view", to_json(state.selection.resource)},
              {"errors", app.errors},
              {"refined", report != nullptr ? report->refined : 0},
              {"rel_mse", app.error ? Json(app.error->rel_mse) : Json()},
              {"controls", std::move(controls)}};
    if (state.document) json.update(to_json(*state.document));
    return json;
}

}  // namespace

UiLog::UiLog(const std::filesystem::path& path) : file_(path) {
    if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
}

void UiLog::add(const SessionState& state, const UiFrame& frame) {
    Json content = lasting(state, frame);
    std::string text = content.dump();
    if (text == last_) return;
    Json line{{"frame", frame.number}, {"time", frame.time}};
    line.update(content);
    file_ << line.dump() << '\n' << std::flush;
    last_ = std::move(text);
}

}  // namespace candela::sandbox
