#include "sandbox/animation/animation_script.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include <candela/tools/output_file.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/files/input_file.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& place, std::string_view error) {
    throw std::runtime_error(place.empty() ? std::string(error) : fmt::format("{}: {}", place, error));
}

/// The path of a member, for error messages. The path of the script itself is empty.
std::string member_of(const std::string& place, std::string_view member) {
    return place.empty() ? std::string(member) : fmt::format("{}.{}", place, member);
}

std::string element_of(const std::string& place, std::size_t index) {
    return fmt::format("{}[{}]", place, index);
}

const Json& require(const Json& object, const std::string& place, const char* member) {
    const Json* const found = find_member(object, member);
    if (!found) fail(member_of(place, member), "is missing");
    return *found;
}

/// Checks that it is an object with no members other than `known`.
void check_object(const Json& json, const std::string& place, std::initializer_list<std::string_view> known) {
    if (!json.is_object()) fail(place, "is not an object");
    for (const auto& [member, value] : json.items()) {
        if (std::find(known.begin(), known.end(), member) == known.end()) {
            fail(member_of(place, readable(member)), "is unknown");
        }
    }
}

void check_array(const Json& json, const std::string& place, std::size_t size, std::string_view of_what) {
    if (!json.is_array() || json.size() != size) fail(place, fmt::format("is not {}", of_what));
}

int read_whole(const Json& json, const std::string& place, int least, int most) {
    const bool fits = json.is_number_integer() && json.get<double>() >= least && json.get<double>() <= most;
    if (!fits) fail(place, fmt::format("is not a whole number from {} to {}", least, most));
    return json.get<int>();
}

bool read_bool(const Json& json, const std::string& place) {
    if (!json.is_boolean()) fail(place, "is not true or false");
    return json.get<bool>();
}

std::string read_text(const Json& json, const std::string& place) {
    if (!json.is_string() || json.get_ref<const std::string&>().empty()) fail(place, "is not a word");
    return json;
}

float read_float(const Json& json, const std::string& place) {
    if (!json.is_number()) fail(place, "is not a number");
    const auto number = json.get<double>();
    // Converting a number outside the range of float would give infinity.
    if (std::abs(number) > std::numeric_limits<float>::max()) fail(place, "is too large");
    return static_cast<float>(number);
}

float read_strength(const Json& json, const std::string& place) {
    const float strength = read_float(json, place);
    if (strength < 0.0F) fail(place, "is negative");
    return strength;
}

glm::vec3 read_vector(const Json& json, const std::string& place) {
    check_array(json, place, 3, "three numbers");
    glm::vec3 vector;
    for (int i = 0; i < 3; ++i) {
        const auto index = static_cast<std::size_t>(i);
        vector[i] = read_float(json[index], element_of(place, index));
    }
    return vector;
}

glm::vec3 read_colour(const Json& json, const std::string& place) {
    const glm::vec3 colour = read_vector(json, place);
    if (std::min({colour.r, colour.g, colour.b}) < 0.0F) fail(place, "is negative");
    return colour;
}

/// In double precision, so that the length of a quaternion of floats cannot overflow.
glm::quat unit_quaternion(const glm::dquat& rotation, const std::string& place) {
    const double length = glm::length(rotation);
    if (!(length > 0.0)) fail(place, "has no length");
    return {is_unit_length(length) ? rotation : rotation / length};
}

glm::quat read_turn(const Json& json, const std::string& place) {
    check_object(json, place, {"axis", "degrees"});
    const std::string axis_place = member_of(place, "axis");
    const glm::dvec3 axis = read_vector(require(json, place, "axis"), axis_place);
    const double length = glm::length(axis);
    if (!(length > 0.0)) fail(axis_place, "has no length");
    const float degrees = read_float(require(json, place, "degrees"), member_of(place, "degrees"));
    return {glm::angleAxis(glm::radians(static_cast<double>(degrees)), axis / length)};
}

glm::quat read_rotation(const Json& json, const std::string& place) {
    if (json.is_object()) return read_turn(json, place);
    check_array(json, place, 4, "a quaternion [x, y, z, w] or a turn {axis, degrees}");
    const auto part = [&](std::size_t i) -> double { return read_float(json[i], element_of(place, i)); };
    return unit_quaternion(glm::dquat(part(3), part(0), part(1), part(2)), place);
}

Interpolation read_interpolation(const Json& json, const std::string& place) {
    if (json == "linear") return Interpolation::linear;
    if (json == "step") return Interpolation::step;
    if (json == "smooth") return Interpolation::smooth;
    fail(place, "is not one of linear, step, smooth");
}

/// The keys of one value; empty if the track leaves it out. `frames` is the last valid frame of a key.
template <class T>
Keys<T> read_keys(const Json& track, const std::string& track_place, const char* member, int frames,
                  T (*read_value)(const Json&, const std::string&)) {
    const Json* const json = find_member(track, member);
    if (!json) return {};
    const std::string place = member_of(track_place, member);
    if (!json->is_array() || json->empty()) fail(place, "is not a list of keys");
    Keys<T> keys;
    keys.reserve(json->size());
    for (const Json& pair : *json) {
        const std::string key_place = element_of(place, keys.size());
        check_array(pair, key_place, 2, "a pair of a frame and a value");
        const int frame = read_whole(pair[0], element_of(key_place, 0), 0, frames);
        if (!keys.empty() && frame <= keys.back().frame) {
            fail(key_place, fmt::format("frame {} does not come after frame {}", frame, keys.back().frame));
        }
        keys.push_back({frame, read_value(pair[1], element_of(key_place, 1))});
    }
    return keys;
}

Track read_track(const Json& json, const std::string& place, int frames) {
    check_object(
        json, place,
        {"node", "interpolation", "translation", "rotation", "scale", "intensity", "colour", "enabled"});
    Track track;
    track.node = read_text(require(json, place, "node"), member_of(place, "node"));
    if (const Json* const interpolation = find_member(json, "interpolation")) {
        track.interpolation = read_interpolation(*interpolation, member_of(place, "interpolation"));
    }
    track.translation = read_keys(json, place, "translation", frames, read_vector);
    track.rotation = read_keys(json, place, "rotation", frames, read_rotation);
    track.scale = read_keys(json, place, "scale", frames, read_vector);
    track.intensity = read_keys(json, place, "intensity", frames, read_strength);
    track.colour = read_keys(json, place, "colour", frames, read_colour);
    track.enabled = read_keys(json, place, "enabled", frames, read_bool);
    return track;
}

std::vector<Track> read_tracks(const Json& json, int frames) {
    if (!json.is_array()) fail("tracks", "is not a list");
    std::vector<Track> tracks;
    tracks.reserve(json.size());
    std::set<std::string> nodes;
    for (const Json& track : json) {
        const std::string place = element_of("tracks", tracks.size());
        tracks.push_back(read_track(track, place, frames));
        const std::string& node = tracks.back().node;
        if (!nodes.insert(node).second) {
            fail(member_of(place, "node"), fmt::format("'{}' has a track already", readable(node)));
        }
    }
    return tracks;
}

/// The names of the shipped scripts, in alphabetical order.
std::vector<std::string> shipped_names() {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const fs::directory_entry& file : fs::directory_iterator(shipped_file("animations", ""), ignored)) {
        names.push_back(file.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

fs::path find_script(const fs::path& file_or_name) {
    std::error_code ignored;
    if (fs::exists(file_or_name, ignored) && !fs::is_directory(file_or_name, ignored)) return file_or_name;
    fs::path shipped = shipped_file("animations", file_or_name.string() + ".json");
    if (!file_or_name.has_parent_path() && fs::exists(shipped, ignored)) return shipped;
    throw std::runtime_error(fmt::format("{}: neither a file nor one of the shipped scripts: {}",
                                         file_or_name.string(), fmt::join(shipped_names(), ", ")));
}

}  // namespace

Script read_script(std::string_view text) {
    const Json json = parse_json(text);
    if (!json.is_object()) fail("", "not a JSON object");
    check_object(json, "", {"scene", "frames", "loop", "tracks"});
    Script script;
    script.frames = read_whole(require(json, "", "frames"), "frames", 1, std::numeric_limits<int>::max());
    if (const Json* const scene = find_member(json, "scene")) script.scene = read_text(*scene, "scene");
    if (const Json* const loop = find_member(json, "loop")) script.loop = read_bool(*loop, "loop");
    script.tracks = read_tracks(require(json, "", "tracks"), script.frames);
    return script;
}

Script load_script(const fs::path& file_or_name) {
    const fs::path path = find_script(file_or_name);
    const std::string text = read_file(path);
    try {
        Script script = read_script(text);
        script.path = path;
        return script;
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{}: {}", path.string(), error.what()));
    }
}

std::optional<fs::path> scene_of(const Script& script) {
    if (!script.scene) return std::nullopt;
    const fs::path scene = *script.scene;
    const std::string extension = tools::lower_extension(scene);
    if (extension == ".gltf" || extension == ".glb") return script.path.parent_path() / scene;
    return shipped_file("scenes", *script.scene + ".gltf");
}

}  // namespace candela::sandbox
