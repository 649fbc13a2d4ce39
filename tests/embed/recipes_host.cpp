// The pieces of code in recipes.md, word for word: CMakeLists.txt extracts them. Each runs in a block of its
// own, one after the other.

#include <epoxy/gl.h>

#include <cstdlib>

#include "host.hpp"
#include "particles.hpp"

#include "recipes_includes.inc"

#include <candela/scene/animation.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace {

constexpr glm::uvec2 picture_size{64, 48};

struct Fade {
    float share = 0.5F;
    bool operator==(const Fade&) const = default;
};

void warn(const std::string& line) {
    std::fprintf(stderr, "unexpected: %s\n", line.c_str());
    std::exit(1);
}

GLuint make_framebuffer(glm::uvec2 of_size) {
    return host::make_picture(of_size).framebuffer;
}

constexpr const char* copy_fragment = R"(
layout(binding = 0) uniform sampler2D radiance;
layout(location = 0) uniform float factor;
layout(location = 0) out vec4 result;
void main() { result = factor * texelFetch(radiance, ivec2(gl_FragCoord.xy), 0); })";

struct HostGbuffer : host::Gbuffer {
    std::uint64_t drawings = 1;
};

HostGbuffer draw_gbuffer(const glm::mat4& clip_from_world) {
    return {host::draw_ground(clip_from_world, picture_size)};
}

void run_recipes(candela::Renderer& renderer, const candela::gl::GetProc& get_proc, host::Scene& scene,
                 host::Checks& checks) {
    candela::World& world = scene.world;
    const glm::uvec2 size = picture_size;
    const candela::Entity camera = scene.camera;
    const candela::Entity lamp = scene.lamp;
    const candela::Entity player = world.create();
    candela::AnimationPlayer still;
    still.animations = std::make_shared<const candela::Animations>(
        candela::Animations{.clips = {std::make_shared<const candela::AnimationClip>()}, .targets = {}});
    world.set(player, still);
    const std::shared_ptr<const candela::Mesh> mesh = host::ground(0.2F, 0.5F);
    const host::Picture picture = host::make_picture(size);
    const GLuint framebuffer = picture.framebuffer;
    const candela::Target target{framebuffer, size};
    const std::vector<glm::vec3> particles{{0, 0.5F, 0}, {1, 0.5F, 0}};
    const auto host_objects = [] { return std::map<int, glm::vec3>{{7, {3, 0, 0}}, {9, {4, 0, 0}}}; };
    using host::draw_particles;
    using host::particle_program;
    using host::Sparks;

    const glm::mat4 projection =
        glm::perspective(world.get<candela::Camera>(camera).vertical_fov,
                         static_cast<float>(size.x) / static_cast<float>(size.y), 0.1F, 10.0F);
    const HostGbuffer gbuffer =
        draw_gbuffer(projection * glm::lookAt(glm::vec3(0, 3, 0), glm::vec3(0), glm::vec3(0, 0, -1)));

    GLuint no_vertices = 0;
    glCreateVertexArrays(1, &no_vertices);
    const GLuint program = host::make_program(host::whole_viewport, copy_fragment);
    const auto draw_faded = [=](const candela::WorldReader& of) {
        float factor = 1.0F;
        for (const auto& [entity, fade] : of.view<Fade>()) factor = fade.share;
        glProgramUniform1f(program, 0, factor);
        glUseProgram(program);
        glBindVertexArray(no_vertices);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    };
    glProgramUniform1f(program, 0, 1.0F);

    const auto input_has_arrived = [] { return false; };
    int shown = 0;
    const auto show = [&](const candela::Target&) { ++shown; };
    const glm::vec2 pointer = 0.5F * glm::vec2(size);
    int selected = 0;
    const auto select = [&](candela::Entity, glm::vec3) { ++selected; };

    std::size_t compiled = 0;
    const auto draw_progress = [&](std::size_t done, std::size_t) { compiled = done; };

    // Whatever a piece does, frames of the usual view go on, and are lit.
    const auto end_of = [&](const std::string& piece) {
        checks.check(glGetError() == GL_NO_ERROR, piece + ": GL reported an error");
        renderer.render(world, camera, target);
        float brightest = 0.0F;
        for (const glm::vec4& pixel : host::read(picture)) brightest = std::max(brightest, pixel.r);
        checks.check(brightest > 0.1F, piece + ": the picture is dark");
    };
#include "recipes.inc"
    checks.check(compiled > 0, "shaders are compiled ahead");
    checks.check(shown == 1, "a frame that is wanted is complete");
    checks.check(selected == 1, "the ground is under the pointer");
}

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(
            context->get_proc(),
            {.log = [](std::string_view line) { warn(std::string(line)); }, .checked = true});
        run_recipes(renderer, context->get_proc(), scene, checks);
    }
    return checks.status();
}
