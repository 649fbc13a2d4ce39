#pragma once

// Particles of a host's: small white squares that face up, lit by Candela's functions. GL must be included
// before.

#include <map>
#include <string>
#include <vector>

#include <candela/ecs/world_reader.hpp>
#include <candela/view.hpp>

#include "host.hpp"

namespace host {

/// The host's own component.
struct Sparks {
    std::vector<glm::vec3> positions;  ///< world space, metres
    bool operator==(const Sparks&) const = default;
};

/// `lighting`: PointLighting::glsl(). Compiled once for each text.
inline GLuint particle_program(const std::string& lighting) {
    static std::map<std::string, GLuint> programs;
    GLuint& program = programs[lighting];
    if (program != 0) return program;
    const std::string vertex = lighting + R"(
layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform vec3 position;
out vec3 reflected;
void main() {
    gl_Position = clip_from_world * vec4(position, 1.0);
    gl_PointSize = 3.0;
    reflected = candela_irradiance(position, vec3(0.0, 1.0, 0.0), 0u) / PI;
})";
    const std::string fragment = R"(
in vec3 reflected;
layout(location = 0) out vec4 radiance;
void main() { radiance = vec4(reflected, 1.0); })";
    program = make_program(vertex, fragment);
    return program;
}

/// Draws those of the world, hidden by what is nearer.
inline void draw_particles(GLuint program, const candela::CameraView& view,
                           const candela::WorldReader& world) {
    static const GLuint no_vertices = [] {
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        return name;
    }();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glUseProgram(program);
    glBindVertexArray(no_vertices);
    glUniformMatrix4fv(0, 1, GL_FALSE, &view.clip_from_world[0][0]);
    for (const auto& [entity, sparks] : world.view<Sparks>()) {
        for (const glm::vec3& position : sparks.positions) {
            glUniform3fv(1, 1, &position[0]);
            glDrawArrays(GL_POINTS, 0, 1);
        }
    }
}

}  // namespace host
