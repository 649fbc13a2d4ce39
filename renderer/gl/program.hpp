#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "renderer/gl/objects.hpp"
#include "renderer/gl/uniforms.hpp"

namespace candela::gl {

/// A program, of use once it is linked: see CompilingProgram. Each use gives all its uniforms, by name. One
/// that is declared but not active is ignored, because drivers remove uniforms that a variant does not use.
class Program : public Object {
 public:
    Program() = default;
    /// A program that has yet to be linked.
    Program(Device& device, std::string_view label);

    /// Learns the uniforms of the program, which has been linked. `declared`: those that the shader files
    /// declare.
    void find_uniforms(const std::set<std::string>& declared);

    /// Uses the program for the next draws or dispatches, with these uniforms. Throws ProgramError for one
    /// that is active and missing, given twice or of another type, and for one that no shader file declares.
    void use(const Uniforms& uniforms = {}) const;

 private:
    void find_active_uniforms();
    void require_each_once(const Uniforms& uniforms) const;

    struct Known {
        GLint location = -1;
        /// Index in Uniform::Value of its type; none for textures and images, and if it is not active.
        std::optional<std::size_t> value_index{};
    };
    std::string label_;
    std::map<std::string, Known, std::less<>> uniforms_;
};

}  // namespace candela::gl
