#include "sandbox/window/ui_log.hpp"

#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "sandbox/candela_private.hpp"

namespace candela::sandbox {

namespace {

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

/// What is the same while nothing happens.
Json lasting(const UiRecord& record) {
    Json controls = Json::object();
    for (const auto& [label, place] : record.controls) controls[label] = to_json(place);
    return {{"picture", record.picture},
            {"submitted", record.submitted},
            {"settled", record.settled},
            {"busy", record.busy.empty() ? Json() : Json(record.busy)},
            {"latency", to_json(record.latency)},
            {"scene", to_json(record.scene)},
            {"scale", record.scale},
            {"scene_file", record.scene_file},
            {"eye", to_json(record.eye)},
            {"selected", to_json(record.selected)},
            {"position", record.position ? to_json(*record.position) : Json()},
            {"configuration", record.configuration},
            {"show", record.show},
            {"compare", to_string(record.compare)},
            {"view", to_json(record.view)},
            {"errors", Json::array({record.errors.begin(), record.errors.end()})},
            {"undo", record.undo},
            {"redo", record.redo},
            {"refined", record.refined},
            {"rel_mse", to_json(record.rel_mse)},
            {"controls", std::move(controls)}};
}

}  // namespace

UiLog::UiLog(const std::filesystem::path& path) : file_(path) {
    if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
}

void UiLog::add(const UiRecord& record) {
    Json content = lasting(record);
    std::string text = content.dump();
    if (text == last_) return;
    Json line{{"frame", record.frame}, {"time", record.time}};
    line.update(content);
    file_ << line.dump() << '\n' << std::flush;
    last_ = std::move(text);
}

}  // namespace candela::sandbox
