// A host with a bloom of its own, in the frame before tone mapping, driven by a component of its own.

#include <epoxy/gl.h>

#include "host.hpp"

#include <candela/extension.hpp>
#include <candela/graph/execute.hpp>

namespace {

constexpr glm::uvec2 size{64, 48};

/// Light above the threshold is spread over its surroundings.
struct Bloom {
    float threshold = 1.0F;
    float strength = 0.5F;
    bool operator==(const Bloom&) const = default;
};

constexpr const char* blur = R"(
layout(binding = 0) uniform sampler2D radiance;
layout(location = 0) uniform vec2 bloom;  // threshold, strength
layout(location = 0) out vec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(radiance, 0) - 1;
    vec3 sum = vec3(0.0);
    for (int y = -3; y <= 3; ++y) {
        for (int x = -3; x <= 3; ++x) {
            vec3 light = texelFetch(radiance, clamp(at + ivec2(x, y), ivec2(0), last), 0).rgb;
            sum += max(light - bloom.x, vec3(0.0));
        }
    }
    result = texelFetch(radiance, at, 0) + vec4(bloom.y * sum / 49.0, 0.0);
})";

/// The pass: reads radiance and the component Bloom, and gives back radiance with a bloom.
candela::Extension make_bloom(GLuint program, GLuint no_vertices) {
    candela::Extension extension{.name = "bloom", .place = candela::ExtensionPlace::before_tone_map};
    extension.declare = [=](candela::FrameGraph& graph, candela::ViewFrame& frame) {
        frame.radiance = graph.add("bloom", [&](candela::Pass& pass) {
            pass.read<Bloom>();
            pass.read(*frame.radiance, {candela::Usage::sampled, 0});
            const auto result =
                pass.write(graph.texture("radiance with bloom", {frame.size, candela::Format::rgba32f}),
                           candela::Usage::colour_target);
            pass.run([=](candela::Execution& run) {
                Bloom bloom{.threshold = 0.0F, .strength = 0.0F};
                for (const auto& [entity, setting] : run.world().view<Bloom>()) bloom = setting;
                glProgramUniform2f(program, 0, bloom.threshold, bloom.strength);
                glUseProgram(program);
                glBindVertexArray(no_vertices);
                glDrawArrays(GL_TRIANGLES, 0, 3);
            });
            return result;
        });
    };
    return extension;
}

bool ran(const candela::Renderer& renderer, std::string_view name) {
    const auto& passes = renderer.last_passes();
    return std::any_of(passes.begin(), passes.end(),
                       [&](const auto& pass) { return pass.name == name && pass.ran; });
}

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(context->get_proc());
        host::show_radiance(renderer, checks);
        const host::Picture picture = host::make_picture(size);
        const auto frame = [&] {
            renderer.render(scene.world, scene.camera, {picture.framebuffer, size});
            return host::read(picture);
        };
        const std::vector<glm::vec4> usual = frame();

        GLuint no_vertices = 0;
        glCreateVertexArrays(1, &no_vertices);
        const GLuint program = host::make_program(host::whole_viewport, blur);
        checks.check(renderer.extend(make_bloom(program, no_vertices)).empty(), "the extension");
        checks.check(frame() == usual, "without the component, nothing changes");

        const candela::Entity settings = scene.world.create();
        scene.world.set(settings, Bloom{.threshold = 0.1F, .strength = 1.0F});
        const std::vector<glm::vec4> bloomed = frame();
        const std::size_t centre = size.y / 2 * size.x + size.x / 2;
        checks.check(bloomed[centre].r > usual[centre].r + 0.05F, "the bright centre blooms");
        checks.check(bloomed[0] == usual[0], "a dark corner does not");
        checks.check(ran(renderer, "bloom") && !ran(renderer, "deferred"), "only the bloom ran");
        checks.check(frame() == bloomed && !ran(renderer, "bloom"), "a still frame runs nothing");

        checks.check(!renderer
                          .extend({.name = "broken",
                                   .declare = [](auto& graph,
                                                 auto&) { graph.add("deferred", [](candela::Pass&) {}); }})
                          .empty(),
                     "a faulty extension is refused");
        checks.check(frame() == bloomed, "and the frame goes on");
    }
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
