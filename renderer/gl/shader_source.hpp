#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <candela/gl_error.hpp>

namespace candela::gl {

/// A file of shaders/; `name` is relative to that folder.
struct EmbeddedShader {
    std::string_view name;
    std::string_view text;
};

/// The files of shaders/ as of the build of the library. Static storage duration.
[[nodiscard]] std::span<const EmbeddedShader> embedded_shaders();

/// Source of shader files: memory, or a directory that is read at each load.
class ShaderLibrary {
 public:
    /// `files` must outlive the library: `ShaderLibrary{embedded_shaders()}`.
    explicit ShaderLibrary(std::span<const EmbeddedShader> files) : files_(files) {}
    explicit ShaderLibrary(std::filesystem::path directory) : directory_(std::move(directory)) {}

    [[nodiscard]] bool contains(std::string_view name) const;
    /// Text of a file. Throws ProgramError that names the file if there is none.
    [[nodiscard]] std::string load(std::string_view name) const;

 private:
    std::span<const EmbeddedShader> files_;
    std::filesystem::path directory_;
};

/// `#define name value`, inserted before the first line of each stage.
struct Define {
    std::string name;
    std::string value = "1";
};

/// Source of a stage with its includes resolved, ready for the driver.
struct ShaderSource {
    std::string text;
    std::vector<std::string> files;  ///< indexed by the file number in the text's #line directives
};

/// Assembles the source of the stage file `name`. `#version 450 core` and the defines come first, so the
/// files contain no #version. A line `#include "file"` is replaced by that file of the library, once per
/// stage. This happens before the driver's preprocessor runs: do not put includes inside #if. `#line`
/// directives make the driver report the line numbers of the original files. Throws ProgramError, with file
/// and line of the include, if a file is missing or includes itself.
[[nodiscard]] ShaderSource assemble(const ShaderLibrary& library, std::string_view name,
                                    std::span<const Define> defines = {});

/// The same as a part of a host's shader: without #version and #line.
[[nodiscard]] std::string assemble_part(const ShaderLibrary& library, std::string_view name,
                                        std::span<const Define> defines = {});

/// Replaces the file numbers in a driver's messages by names. Mesa's "2:42(10): error: ..." becomes
/// "shaders/shading/lighting.glsl:42: error: ...", and so does NVIDIA's "2(42) : error ...". Lines of another
/// form do not change.
[[nodiscard]] std::string map_log(std::string_view log, std::span<const std::string> files);

}  // namespace candela::gl
