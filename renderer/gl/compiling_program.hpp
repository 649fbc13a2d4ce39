#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "renderer/gl/program.hpp"
#include "renderer/gl/shader_source.hpp"

namespace candela::gl {

class ProgramCache;

/// One stage of a program.
struct ProgramStage {
    std::string file;  ///< relative to shaders/
    GLenum kind = GL_COMPUTE_SHADER;
    ShaderSource source;
};

/// What a program is compiled from.
using ProgramSource = std::vector<ProgramStage>;

/// Reads shader files for a program. The file extension gives the stage: .vert, .frag, .geom or .comp.
/// `assemble_program(library, {"surfaces/mesh_surface.vert", "surfaces/gbuffer.frag"}, {{"MASKED", "1"}})`.
/// Throws ProgramError if a file is missing, includes itself or has another extension.
[[nodiscard]] ProgramSource assemble_program(const ShaderLibrary& library,
                                             const std::vector<std::string>& stages,
                                             const std::vector<Define>& defines = {});

/// A program that the driver compiles and links, perhaps on threads of its own, while the caller starts
/// others.
class CompilingProgram {
 public:
    /// Starts. `cache`: where the linked program is taken from, if it is there, and stored otherwise; may be
    /// null. It must outlive the object.
    CompilingProgram(Device& device, ProgramSource source, ProgramCache* cache);

    /// Whether the driver says that it is done, so that `finish` does not wait. Always false if it cannot
    /// say.
    [[nodiscard]] bool is_done() const;

    /// Waits for the driver. To be called once. Throws ProgramError with the driver's messages, by file and
    /// line.
    [[nodiscard]] Program finish();

 private:
    /// A shader object.
    class Shader {
     public:
        Shader(const Functions& gl, const ProgramStage& stage);
        Shader(Shader&& other) noexcept;
        Shader(const Shader&) = delete;
        Shader& operator=(const Shader&) = delete;
        Shader& operator=(Shader&&) = delete;
        ~Shader();
        [[nodiscard]] GLuint name() const { return name_; }

     private:
        const Functions* gl_;
        GLuint name_;
    };

    void start_compiling();
    [[nodiscard]] bool is_linked() const;
    void require_compiled() const;

    Device* device_;
    ProgramSource source_;
    ProgramCache* cache_;
    Program program_;
    std::vector<Shader> shaders_;  ///< none while a binary of the cache is tried
};

/// Starts and finishes.
[[nodiscard]] Program compile(Device& device, const ShaderLibrary& library,
                              const std::vector<std::string>& stages,
                              const std::vector<Define>& defines = {});

/// As long as it exists, the driver may compile on as many threads as it likes, whatever the host has set.
class AllCompilerThreads {
 public:
    explicit AllCompilerThreads(const Functions& gl);
    AllCompilerThreads(const AllCompilerThreads&) = delete;
    AllCompilerThreads& operator=(const AllCompilerThreads&) = delete;
    ~AllCompilerThreads();

 private:
    const Functions& gl_;
    GLuint threads_ = 0;  ///< the host's limit
};

}  // namespace candela::gl
