// A frame graph of a host's own, without the renderer's passes: two systems move boxes, two passes draw and
// show them in a window. It links candela::renderer, for the graph's OpenGL back end, GLFW and libepoxy.

#include <epoxy/gl.h>  // before GLFW, which would include another header of GL

#include <GLFW/glfw3.h>
#include <candela/gl_backend.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include <cmath>
using namespace candela;

struct Phase {
    float radians;
};
struct Height {
    float pixels;
    bool operator==(const Height&) const = default;
};
struct Box {
    float left, bottom;
    bool operator==(const Box&) const = default;
};

void draw(const Box& box) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(static_cast<int>(box.left), static_cast<int>(box.bottom), 8, 8);
    glClearColor(1.0F, 0.8F, 0.2F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
}

void show(GLuint texture) {
    GLuint source = 0;
    glCreateFramebuffers(1, &source);
    glNamedFramebufferTexture(source, GL_COLOR_ATTACHMENT0, texture, 0);
    glBlitNamedFramebuffer(source, 0, 0, 0, 640, 360, 0, 0, 640, 360, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glDeleteFramebuffers(1, &source);
}

int main() {
    glfwInit();
    GLFWwindow* const window = glfwCreateWindow(640, 360, "Particles", nullptr, nullptr);
    glfwMakeContextCurrent(window);
    GlBackend gl(glfwGetProcAddress);
    World world;
    for (float i = 0.0F; i < 40.0F; ++i) world.set(world.create(), Phase{i});

    FrameGraph graph;
    const auto seconds = graph.import_value<float>("seconds");
    graph.add("motion", [&](Pass& pass) {
        pass.read(seconds);
        pass.read<Phase>();
        pass.write<Height>();
        pass.run([=](Execution& run) {
            for (const auto& [entity, phase] : run.world().view<Phase>())
                run.world().set(entity,
                                Height{180.0F + 99.0F * std::sin(phase.radians + run.value(seconds))});
        });
    });
    graph.add("boxes", [](Pass& pass) {
        pass.read<Height>();
        pass.write<Box>();
        pass.run([](Execution& run) {
            for (const auto& [entity, height] : run.world().view<Height>())
                run.world().set(entity, Box{16.0F * static_cast<float>(entity.index), height.pixels});
        });
    });
    const auto picture = graph.add("draw", [&](Pass& pass) {
        pass.read<Box>();
        pass.run([](Execution& run) {
            glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
            glClear(GL_COLOR_BUFFER_BIT);
            for (const auto& [entity, box] : run.world().view<Box>()) draw(box);
        });
        return pass.write(graph.texture("picture", {{640, 360}}), Usage::colour_target);
    });
    graph.add("show", [&](Pass& pass) {
        pass.read(picture, Usage::copy);
        pass.side_effect();
        pass.run([=](Execution& run) { show(run.object(picture)); });
    });

    GraphRuntime runtime(gl.backend());
    runtime.switch_to(compile(std::move(graph)).take());
    while (!glfwWindowShouldClose(window)) {
        runtime.set(seconds, static_cast<float>(glfwGetTime()));
        runtime.run(world);
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
}
