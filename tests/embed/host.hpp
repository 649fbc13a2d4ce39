#pragma once

// What the hosts that draw with OpenGL have in common: a context, framebuffers, programs. GL must be included
// before.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <candela/headless_context.hpp>
#include <candela/renderer.hpp>
#include <candela/scene/components.hpp>

namespace host {

/// Prints what went wrong, and remembers it for the exit status.
class Checks {
 public:
    void check(bool holds, const std::string& what) {
        if (!holds) {
            std::fprintf(stderr, "wrong: %s\n", what.c_str());
            status_ = 1;
        }
    }
    [[nodiscard]] int status() const { return status_; }

 private:
    int status_ = 0;
};

inline std::unique_ptr<candela::HeadlessContext> make_context() {
    auto context = candela::HeadlessContext::create(candela::ContextKind::egl);
    context->make_current();
    return context;
}

/// Turns the tone map off, so that targets hold linear radiance. Returns the configuration.
inline candela::Configuration show_radiance(candela::Renderer& renderer, Checks& checks) {
    candela::Configuration configuration;
    configuration.tone_map.enabled = false;
    checks.check(renderer.configure(configuration).empty(), "the configuration");
    return configuration;
}

/// A texture, and a framebuffer with it as its first colour attachment.
struct Picture {
    GLuint texture = 0;
    GLuint framebuffer = 0;
    glm::uvec2 size{0};
};

inline GLuint make_texture(glm::uvec2 size, GLenum format) {
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y));
    return texture;
}

inline Picture make_picture(glm::uvec2 size, GLenum format = GL_RGBA32F) {
    Picture picture{make_texture(size, format), 0, size};
    glCreateFramebuffers(1, &picture.framebuffer);
    glNamedFramebufferTexture(picture.framebuffer, GL_COLOR_ATTACHMENT0, picture.texture, 0);
    return picture;
}

inline std::vector<glm::vec4> read(const Picture& picture) {
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(picture.size.x) * picture.size.y);
    glGetTextureImage(picture.texture, 0, GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)), pixels.data());
    return pixels;
}

inline GLuint make_shader(GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const std::string whole = "#version 450 core\n" + source;
    const char* text = whole.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

inline GLuint make_program(const std::string& vertex, const std::string& fragment) {
    const GLuint program = glCreateProgram();
    for (const GLuint shader :
         {make_shader(GL_VERTEX_SHADER, vertex), make_shader(GL_FRAGMENT_SHADER, fragment)}) {
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) std::fprintf(stderr, "a program does not link\n");
    return program;
}

/// One triangle that covers the viewport.
inline const std::string whole_viewport = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";

/// A square of `half` metres to each side in the plane y = 0, facing +Y.
inline std::shared_ptr<const candela::Mesh> ground(float half, float albedo) {
    auto material = std::make_shared<candela::Material>();
    material->base_colour = glm::vec4(glm::vec3(albedo), 1.0F);
    candela::Primitive square;
    square.material = material;
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)}) {
        square.vertices.push_back({{half * corner.x, 0.0F, half * corner.y}, {0, 1, 0}, {0, 0}});
    }
    square.indices = {0, 1, 2, 0, 2, 3};
    auto mesh = std::make_shared<candela::Mesh>();
    mesh->primitives.push_back(std::move(square));
    return mesh;
}

/// Looks straight down from 3 m above the origin.
inline candela::Transform from_above() {
    return {.translation = {0, 3, 0}, .rotation = glm::quat(std::sqrt(0.5F), -std::sqrt(0.5F), 0.0F, 0.0F)};
}

/// A ground of albedo 0.5 with a lamp of 3 cd, 1 m above its centre.
struct Scene {
    candela::World world;
    candela::Entity camera;
    candela::Entity lamp;
};

inline Scene make_scene() {
    Scene scene;
    const candela::Entity floor = scene.world.create();
    scene.world.set(floor, candela::MeshInstance{ground(4.0F, 0.5F)});
    scene.camera = scene.world.create();
    scene.world.set(scene.camera, from_above());
    scene.world.set(scene.camera, candela::Camera{});
    scene.lamp = scene.world.create();
    scene.world.set(scene.lamp, candela::Transform{.translation = {0, 1, 0}});
    scene.world.set(scene.lamp, candela::PointLight{.intensity = 3.0F});
    return scene;
}

/// Surfaces as a host draws them by itself.
struct Gbuffer {
    GLuint framebuffer = 0;
    GLuint depth = 0;
    GLuint normal = 0;  ///< world space, 0.5 n + 0.5
    GLuint albedo = 0;
};

/// Draws the ground of the scene, with the depth state that is set.
inline Gbuffer draw_ground(const glm::mat4& clip_from_world, glm::uvec2 size) {
    const char* const vertex = R"(
layout(location = 0) uniform mat4 clip_from_world;
void main() {
    vec2 corner = vec2((gl_VertexID & 1) * 8 - 4, (gl_VertexID & 2) * 4 - 4);
    gl_Position = clip_from_world * vec4(corner.x, 0.0, corner.y, 1.0);
})";
    const char* const fragment = R"(
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 albedo;
void main() {
    normal = vec4(0.5, 1.0, 0.5, 0.0);  // (0, 1, 0), stored without a sign
    albedo = vec4(vec3(0.5), 1.0);
})";
    Gbuffer drawn{.depth = make_texture(size, GL_DEPTH_COMPONENT32F),
                  .normal = make_texture(size, GL_RGBA8),
                  .albedo = make_texture(size, GL_RGBA8)};
    glCreateFramebuffers(1, &drawn.framebuffer);
    glNamedFramebufferTexture(drawn.framebuffer, GL_COLOR_ATTACHMENT0, drawn.normal, 0);
    glNamedFramebufferTexture(drawn.framebuffer, GL_COLOR_ATTACHMENT1, drawn.albedo, 0);
    glNamedFramebufferTexture(drawn.framebuffer, GL_DEPTH_ATTACHMENT, drawn.depth, 0);
    const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(drawn.framebuffer, 2, targets);
    GLuint no_vertices = 0;
    glCreateVertexArrays(1, &no_vertices);
    const GLuint program = make_program(vertex, fragment);
    glProgramUniformMatrix4fv(program, 0, 1, GL_FALSE, &clip_from_world[0][0]);
    glBindFramebuffer(GL_FRAMEBUFFER, drawn.framebuffer);
    glViewport(0, 0, static_cast<GLsizei>(size.x), static_cast<GLsizei>(size.y));
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program);
    glBindVertexArray(no_vertices);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    return drawn;
}

}  // namespace host
