#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
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

/// A linked program. Uniforms are set by name, whether or not the program is in use. An array is set by its
/// name without "[0]", starting with its first element. Setting a uniform that no shader file declares throws
/// ProgramError. One that is declared but not active is ignored, because drivers remove uniforms that a
/// variant does not use.
class Program : public Object {
 public:
    Program() = default;
    /// Links compiled shaders; the caller keeps their ownership. `declared`: the uniforms that the shader
    /// files declare. Throws ProgramError with the linker's messages.
    Program(Device& device, std::string_view label, std::span<const GLuint> shaders,
            const std::set<std::string>& declared);

    void use() const;
    /// Uses the program for the next draws or dispatches, with these uniforms. Throws ProgramError if one
    /// that is active is missing or given twice, and if no shader file declares one.
    void use(const Uniforms& uniforms) const;

    /// Whether `uniform` is an active uniform outside of uniform blocks.
    [[nodiscard]] bool has(std::string_view uniform) const;

    void set(std::string_view uniform, bool value) const;
    void set(std::string_view uniform, int value) const;
    void set(std::string_view uniform, std::uint32_t value) const;
    void set(std::string_view uniform, float value) const;
    void set(std::string_view uniform, const glm::vec2& value) const;
    void set(std::string_view uniform, const glm::vec3& value) const;
    void set(std::string_view uniform, const glm::vec4& value) const;
    void set(std::string_view uniform, const glm::ivec2& value) const;
    void set(std::string_view uniform, const glm::ivec3& value) const;
    void set(std::string_view uniform, const glm::uvec2& value) const;
    void set(std::string_view uniform, const glm::uvec3& value) const;
    void set(std::string_view uniform, const glm::uvec4& value) const;
    void set(std::string_view uniform, const glm::mat3& value) const;
    void set(std::string_view uniform, const glm::mat4& value) const;
    void set(std::string_view uniform, std::span<const float> values) const;
    void set(std::string_view uniform, std::span<const glm::vec4> values) const;
    void set(std::string_view uniform, std::span<const glm::mat4> values) const;

 private:
    void link(std::string_view label, std::span<const GLuint> shaders) const;
    void find_uniforms();
    /// -1, which OpenGL ignores, for uniforms that are not active.
    [[nodiscard]] GLint location(std::string_view uniform) const;
    void require_each_once(const Uniforms& uniforms) const;

    std::string label_;
    struct Known {
        GLint location = -1;  // -1: declared, but not active
        std::optional<std::size_t>
            value_index{};  // of Uniform::Value; none: not active, a texture or an image
    };
    std::map<std::string, Known, std::less<>> uniforms_;
};

/// Compiles and links shader files. The file extension gives the stage: .vert, .frag, .geom or .comp.
/// `compile(device, library, {"surfaces/mesh_surface.vert", "surfaces/gbuffer.frag"}, {{"MASKED", "1"}})`.
/// Throws ProgramError with the driver's messages, by file and line.
[[nodiscard]] Program compile(Device& device, const ShaderLibrary& library,
                              const std::vector<std::string>& stages,
                              const std::vector<Define>& defines = {});

}  // namespace candela::gl
