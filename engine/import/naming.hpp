#pragma once

#include <cstddef>
#include <exception>
#include <new>
#include <string_view>

#include <fmt/format.h>

#include <candela/scene/gltf.hpp>
#include <candela/scene/scene_error.hpp>
#include "engine/import/piece_error.hpp"
#include "engine/readable.hpp"
#include "engine/scene/check.hpp"

namespace candela::gltf {

/// Longest message, without the name of the file. It may quote several names.
inline constexpr std::size_t longest_message = 300;

/// Throws what is wrong, if anything is.
inline void check(const Fault& fault) {
    if (fault) throw SceneError(*fault);
}

/// Runs a part of an import or export. A SceneError or PieceError then names what it concerns.
template <class Action>
auto naming(std::string_view what, Action action) {
    try {
        return action();
    } catch (const PieceError& error) {
        throw PieceError(fmt::format("{}: {}", what, error.what()));
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("{}: {}", what, error.what()));
    }
}

/// Runs the import or export and turns every exception into a SceneError that names the file.
template <class Action>
auto naming_file(std::string_view name, Action action) {
    try {
        return action();
    } catch (const ImportCancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw SceneError(fmt::format("{}: it does not fit into memory", readable(name)));
    } catch (const std::exception& error) {
        throw SceneError(fmt::format("{}: {}", readable(name), readable(error.what(), longest_message)));
    }
}

}  // namespace candela::gltf
