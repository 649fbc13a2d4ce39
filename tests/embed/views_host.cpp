// A host that draws by itself before and after two views of Candela, in one framebuffer.

#include <GL/glew.h>

#include "host.hpp"

namespace {

constexpr glm::uvec2 size{64, 48};

constexpr const char* red = R"(
layout(location = 0) out vec4 colour;
void main() { colour = vec4(1.0, 0.0, 0.0, 1.0); })";

}  // namespace

int main() {
    const auto context = host::make_context();
    glewExperimental = GL_TRUE;
    host::Checks checks;
    // GLEW looks for a display of GLX, which EGL does not need, only after it has loaded the functions of GL.
    const GLenum loaded = glewInit();
    checks.check(loaded == GLEW_OK || loaded == GLEW_ERROR_NO_GLX_DISPLAY, "GLEW");
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(context->get_proc());
        host::show_radiance(renderer, checks);

        // The host draws a bar at the bottom with its own state, before and after.
        const glm::uvec2 all(2 * size.x, size.y + 8);
        const host::Picture picture = host::make_picture(all);
        GLuint no_vertices = 0;
        glCreateVertexArrays(1, &no_vertices);
        const GLuint program = host::make_program(host::whole_viewport, red);
        glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer);
        glUseProgram(program);
        glBindVertexArray(no_vertices);
        glEnable(GL_SCISSOR_TEST);
        glScissor(0, 0, static_cast<GLsizei>(all.x / 2), 8);
        glViewport(0, 0, static_cast<GLsizei>(all.x), 8);
        glDrawArrays(GL_TRIANGLES, 0, 3);

        const std::vector<candela::RenderView> views{
            {.camera = scene.camera, .target = {picture.framebuffer, size, {0, 8}}},
            {.camera = scene.camera, .target = {picture.framebuffer, size, {size.x, 8}}}};
        for (int frame = 0; frame < 3; ++frame) {
            scene.world.set(scene.lamp,
                            candela::Transform{.translation = {0.2F * static_cast<float>(frame), 1, 0}});
            renderer.render(scene.world, views);
        }

        glScissor(static_cast<GLint>(all.x / 2), 0, static_cast<GLsizei>(all.x / 2), 8);
        glDrawArrays(GL_TRIANGLES, 0, 3);  // with the program, array, framebuffer and viewport from before

        const std::vector<glm::vec4> pixels = host::read(picture);
        bool bar = true;
        bool equal = true;
        float brightest = 0.0F;
        for (unsigned y = 0; y < all.y; ++y) {
            for (unsigned x = 0; x < size.x; ++x) {
                const glm::vec4 left = pixels[y * all.x + x];
                const glm::vec4 right = pixels[y * all.x + size.x + x];
                equal &= left == right;
                if (y < 8) {
                    bar &= left == glm::vec4(1, 0, 0, 1);
                } else {
                    brightest = std::max(brightest, left.g);
                }
            }
        }
        checks.check(bar, "the host's own drawing");
        checks.check(equal, "equal cameras give equal pictures");
        checks.check(brightest > 0.1F, "the views are dark");
        int vpl_passes = 0;
        for (const candela::PassRecord& pass : renderer.last_passes()) {
            vpl_passes += pass.name.starts_with("surfel-light") ? 1 : 0;
        }
        // One for the VPLs of all views, and one for what guides where they are.
        checks.check(vpl_passes == 2, "the views do not share their VPLs");
    }
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
