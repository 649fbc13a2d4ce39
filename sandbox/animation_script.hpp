#pragma once

#include <filesystem>
#include <string_view>

#include "sandbox/animation.hpp"

namespace candela::sandbox {

// A script is a JSON object:
//
//     { "scene": "two-rooms",            a shipped scene, or a glTF file beside the script; may be left out
//       "frames": 60,                    how many, from 0 on
//       "loop": false,                   whether frame 60 is frame 0 again or 59 once more; left out: false
//       "tracks": [                      one for each node that is driven
//         { "node": "lamp",              its name in the scene: a light, a mesh, a camera or what holds them
//           "interpolation": "linear",   or "step", or "smooth"; left out: "linear"
//           "translation": [[0, [-1.9, 2, 0.5]], [59, [-0.9, 2, 0.5]]],
//           "rotation": [[0, [0, 0, 0, 1]], [30, {"axis": [0, 1, 0], "degrees": 90}]],
//           "scale": [[0, [1, 1, 1]]],
//           "intensity": [[0, 9]],
//           "colour": [[0, [1, 0.92, 0.8]]],
//           "enabled": [[0, true], [20, false]] } ] }
//
// A value's keys are pairs of a frame and what the value is there, in the order of their frames, which are
// whole numbers from 0 to "frames" (where a loop meets itself again). Values that are left out stay as the
// scene has them. Units are glTF's: metres to the parent, quaternions as [x, y, z, w], candela or lux, linear
// RGB. A turn between two keys goes the shorter way round, so that one of half a turn or more needs a key on
// its way. "enabled" steps, whatever the interpolation.

/// Reads a script. Throws std::runtime_error whose one line names the place and the fault: what is no JSON,
/// members that are missing, unknown or of the wrong type, keys out of order, numbers out of range, two
/// tracks for one node. Script::path stays empty.
[[nodiscard]] Script read_script(std::string_view json);

/// The script in this file, or else the shipped one of this name. Throws std::runtime_error whose one line
/// names the file and the fault.
[[nodiscard]] Script load_script(const std::filesystem::path& file_or_name);

/// The scene that the script is for, if it names one: a shipped scene, or, with the extension of a glTF file,
/// one relative to the script's folder.
[[nodiscard]] std::optional<std::filesystem::path> scene_of(const Script& script);

}  // namespace candela::sandbox
