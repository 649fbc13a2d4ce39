#include "sandbox/animation/script_writer.hpp"

#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <candela/tools/output_file.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Lines = std::vector<std::string>;

Json to_json(float number) {
    if (!std::isfinite(number)) throw std::runtime_error("a number is not finite");
    return shortest(number);
}

Json to_json(bool flag) {
    return flag;
}

Json to_json(const glm::vec3& vector) {
    return {to_json(vector.x), to_json(vector.y), to_json(vector.z)};
}

Json to_json(const glm::quat& rotation) {
    return {to_json(rotation.x), to_json(rotation.y), to_json(rotation.z), to_json(rotation.w)};
}

std::string text(const std::string& words) {
    try {
        return Json(words).dump();
    } catch (const Json::exception&) {
        throw std::runtime_error("a name is not UTF-8");
    }
}

const char* name_of(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::step:
            return "step";
        case Interpolation::smooth:
            return "smooth";
        case Interpolation::linear:
            break;
    }
    return "linear";
}

template <class T>
void add_keys(const char* member, const Keys<T>& keys, Lines& lines) {
    if (keys.empty()) return;
    Json list = Json::array();
    for (const Key<T>& key : keys) list.push_back({key.frame, to_json(key.value)});
    lines.push_back(fmt::format(R"(      "{}": {})", member, list.dump()));
}

std::string write_track(const Track& track) {
    Lines lines{fmt::format(R"(      "interpolation": "{}")", name_of(track.interpolation))};
    add_keys("translation", track.translation, lines);
    add_keys("rotation", track.rotation, lines);
    add_keys("scale", track.scale, lines);
    add_keys("intensity", track.intensity, lines);
    add_keys("colour", track.colour, lines);
    add_keys("enabled", track.enabled, lines);
    return fmt::format("    {{ \"node\": {},\n{} }}", text(track.node), fmt::join(lines, ",\n"));
}

/// The scene as a script names it: see Script::scene.
std::string scene_name(const fs::path& scene, const fs::path& script) {
    if (is_shipped("scenes", scene)) return scene.stem().string();
    return fs::proximate(fs::absolute(scene), fs::absolute(script).parent_path()).string();
}

}  // namespace

std::string write_script(const Script& script) {
    Lines tracks;
    for (const Track& track : script.tracks) tracks.push_back(write_track(track));
    const std::string scene = script.scene ? fmt::format("\"scene\": {}, ", text(*script.scene)) : "";
    return fmt::format("{{ {}\"frames\": {}, \"loop\": {},\n  \"tracks\": [\n{} ] }}\n", scene, script.frames,
                       script.loop, fmt::join(tracks, ",\n"));
}

void save_script(Script script, const fs::path& scene, const fs::path& file) {
    script.scene = scene_name(scene, file);
    std::string json;
    try {
        json = write_script(script);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
    }
    tools::write_text(file, json);
}

}  // namespace candela::sandbox
