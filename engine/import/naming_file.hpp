#pragma once

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>

namespace candela::gltf {

/// The message as one line of limited length. It may quote arbitrary strings from the file.
[[nodiscard]] inline std::string one_line(std::string_view message) {
    constexpr std::size_t longest = 300;
    std::string line(message.substr(0, longest));
    std::ranges::replace_if(
        line, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, ' ');
    line.erase(line.find_last_not_of(" .") + 1);
    return line;
}

/// Runs the import or export and turns every exception into a SceneError that names the file.
template <class Action>
auto naming_file(std::string_view name, Action action) {
    try {
        return action();
    } catch (const std::bad_alloc&) {
        throw SceneError(fmt::format("{}: it does not fit into memory", name));
    } catch (const std::exception& error) {
        throw SceneError(fmt::format("{}: {}", name, one_line(error.what())));
    }
}

}  // namespace candela::gltf
