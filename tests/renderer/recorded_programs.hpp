#pragma once

#include <compare>
#include <string>
#include <vector>

#include <candela/gl_loader.hpp>
#include "renderer/gl/functions.hpp"

namespace candela {

struct RecordedShader {
    GLenum stage = 0;
    std::string text;  ///< as the driver gets it
    auto operator<=>(const RecordedShader&) const = default;
};

struct RecordedProgram {
    GLuint name = 0;
    std::string label;  ///< the files of its stages: "a.vert and a.frag"
    std::vector<RecordedShader> shaders;
};

/// Records the programs that all renderers link from sources which are made with `recording`.
class RecordedPrograms {
 public:
    /// The same functions, with recording ones in the places of those that make programs.
    [[nodiscard]] static gl::GetProc recording(gl::GetProc get_proc);

    /// Since the last call.
    static std::vector<RecordedProgram> take();
};

/// The ending of files of this stage, by which compilers know it: "vert", "geom", "frag" or "comp".
[[nodiscard]] std::string file_ending(GLenum stage);

}  // namespace candela
