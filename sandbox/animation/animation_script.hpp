#pragma once

#include <filesystem>
#include <string_view>

#include "sandbox/animation/animation.hpp"

namespace candela::sandbox {

// A script is a JSON object:
//
//     { "scene": "two-rooms",            a shipped scene, or a glTF file relative to the script; optional
//       "frames": 60,                    number of frames, counted from 0
//       "loop": false,                   true: frame 0 follows frame 59; false (default): frame 59 stays
//       "tracks": [                      one per animated node
//         { "node": "lamp",              its name in the scene: a light, mesh, camera or a parent of these
//           "interpolation": "linear",   or "step", or "smooth"; default: "linear"
//           "translation": [[0, [-1.9, 2, 0.5]], [59, [-0.9, 2, 0.5]]],
//           "rotation": [[0, [0, 0, 0, 1]], [30, {"axis": [0, 1, 0], "degrees": 90}]],
//           "scale": [[0, [1, 1, 1]]],
//           "intensity": [[0, 9]],
//           "colour": [[0, [1, 0.92, 0.8]]],
//           "enabled": [[0, true], [20, false]] } ] }
//
// The keys of a value are pairs of a frame and the value at that frame, sorted by frame. Frames are integers
// from 0 to "frames"; a key at "frames" is where a loop starts again. Values that are left out stay as they
// are in the scene. Units are those of glTF: metres relative to the parent, quaternions as [x, y, z, w],
// candela or lux, linear RGB. A rotation between two keys takes the shorter arc, so a rotation by 180 degrees
// or more needs a key in between. "enabled" is always stepped, whatever the interpolation.

/// Parses a script. Throws std::runtime_error with a one-line message that names the place and the error:
/// invalid JSON, members that are missing, unknown or of the wrong type, keys out of order, numbers out of
/// range, two tracks for the same node. Script::path stays empty.
[[nodiscard]] Script read_script(std::string_view json);

/// Loads the script from this file, or, if there is no such file, the shipped script of this name. Throws
/// std::runtime_error with a one-line message that names the file and the error.
[[nodiscard]] Script load_script(const std::filesystem::path& file_or_name);

/// The scene that the script animates, if it names one: a shipped scene, or, if the name has the extension of
/// a glTF file, a file relative to the script's folder.
[[nodiscard]] std::optional<std::filesystem::path> scene_of(const Script& script);

}  // namespace candela::sandbox
