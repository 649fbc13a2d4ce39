#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/error.hpp"

namespace candela::gl {

/// A file of shaders/, by its name there.
struct EmbeddedShader {
    std::string_view name;
    std::string_view text;
};

/// The files of shaders/ as they were when the library was built.
[[nodiscard]] std::span<const EmbeddedShader> embedded_shaders();

/// Where shader files come from: memory, or a directory that is read anew at each load.
class ShaderLibrary {
 public:
    /// `files` outlive the library: `ShaderLibrary{embedded_shaders()}`.
    explicit ShaderLibrary(std::span<const EmbeddedShader> files) : files_(files) {}
    explicit ShaderLibrary(std::filesystem::path directory) : directory_(std::move(directory)) {}

    [[nodiscard]] bool contains(std::string_view name) const;
    /// Text of a file. Throws ProgramError that names it if there is none.
    [[nodiscard]] std::string load(std::string_view name) const;

 private:
    std::span<const EmbeddedShader> files_;
    std::filesystem::path directory_;
};

/// `#define name value`, ahead of the first line of each stage.
struct Define {
    std::string name;
    std::string value = "1";
};

/// A stage with its includes resolved, ready for the driver.
struct ShaderSource {
    std::string text;
    std::vector<std::string> files;  ///< by the number that the text's #line directives give them
};

/// Text of the stage file `name`. Ahead of it come `#version 450 core` and the defines, so files have no
/// #version. A line `#include "file"` is replaced by that file of the library, once a stage, before the
/// driver's preprocessor sees it: keep includes out of #if. `#line` directives keep the driver's line numbers
/// those of the files. Throws ProgramError that names file and line of the include where a file is missing or
/// includes itself.
[[nodiscard]] ShaderSource assemble(const ShaderLibrary& library, std::string_view name,
                                    std::span<const Define> defines = {});

/// A driver's message with file numbers turned into names: Mesa's "2:42(10): error: ..." and NVIDIA's
/// "2(42) : error ..." become "shaders/lighting.glsl:42: error: ...". Lines of another form stay as they are.
[[nodiscard]] std::string map_log(std::string_view log, std::span<const std::string> files);

}  // namespace candela::gl
