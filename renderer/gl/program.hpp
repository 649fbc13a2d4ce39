#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/objects.hpp"
#include "renderer/gl/shader_source.hpp"
#include "renderer/gl/uniforms.hpp"

namespace candela::gl {

/// A linked program. Each use gives all its uniforms, by name. One that is declared but not active is
/// ignored, because drivers remove uniforms that a variant does not use.
class Program : public Object {
 public:
    Program() = default;
    /// Links compiled shaders; the caller keeps their ownership. `declared`: the uniforms that the shader
    /// files declare. Throws ProgramError with the linker's messages.
    Program(Device& device, std::string_view label, std::span<const GLuint> shaders,
            const std::set<std::string>& declared);

    /// Uses the program for the next draws or dispatches, with these uniforms. Throws ProgramError for one
    /// that is active and missing, given twice or of another type, and for one that no shader file declares.
    void use(const Uniforms& uniforms = {}) const;

 private:
    void link(std::string_view label, std::span<const GLuint> shaders) const;
    void find_uniforms();
    void require_each_once(const Uniforms& uniforms) const;

    struct Known {
        GLint location = -1;
        /// Index in Uniform::Value of its type; none for textures and images, and if it is not active.
        std::optional<std::size_t> value_index{};
    };
    std::string label_;
    std::map<std::string, Known, std::less<>> uniforms_;
};

/// Compiles and links shader files. The file extension gives the stage: .vert, .frag, .geom or .comp.
/// `compile(device, library, {"surfaces/mesh_surface.vert", "surfaces/gbuffer.frag"}, {{"MASKED", "1"}})`.
/// Throws ProgramError with the driver's messages, by file and line.
[[nodiscard]] Program compile(Device& device, const ShaderLibrary& library,
                              const std::vector<std::string>& stages,
                              const std::vector<Define>& defines = {});

}  // namespace candela::gl
