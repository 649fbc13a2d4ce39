// A host that draws particles of its own into the frame, lit by Candela's functions in its own shader.

#include <epoxy/gl.h>

#include "particles.hpp"

#include <candela/extension.hpp>
#include <candela/graph/execute.hpp>
#include <candela/scene/hierarchy.hpp>
#include <numbers>

namespace {

constexpr glm::uvec2 size{65, 49};

candela::Extension make_sparks() {
    candela::Extension extension{.name = "sparks", .place = candela::ExtensionPlace::after_shading};
    extension.declare = [](candela::FrameGraph& graph, candela::ViewFrame& frame) {
        if (!frame.lighting) return;
        const GLuint program = host::particle_program(frame.lighting->glsl());
        graph.add("sparks", [&](candela::Pass& pass) {
            frame.lighting->read(pass);
            pass.read<host::Sparks>();
            pass.read(frame.view);
            pass.read(*frame.depth, candela::Usage::depth_target);
            frame.radiance = pass.write(*frame.radiance, candela::Usage::colour_target);
            pass.run([program, view = frame.view](candela::Execution& run) {
                host::draw_particles(program, run.value(view), run.world());
            });
        });
    };
    return extension;
}

/// The pixel that shows a place, in the picture of host::from_above.
std::size_t pixel_of(const host::Scene& scene, glm::vec3 place) {
    const glm::mat4 clip_from_world =
        candela::make_view(scene.world.get<candela::Camera>(scene.camera),
                           candela::world_matrix(scene.world, scene.camera), size)
            .clip_from_world;
    const glm::vec4 clip = clip_from_world * glm::vec4(place, 1.0F);
    const glm::uvec2 pixel((glm::vec2(clip) / clip.w * 0.5F + 0.5F) * glm::vec2(size));
    return pixel.y * size.x + pixel.x;
}

bool near(glm::vec4 found, float expected) {
    return std::abs(found.r - expected) < 1e-4F * expected;  // roundings of a dozen operations
}

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(context->get_proc());
        candela::Configuration configuration = host::show_radiance(renderer, checks);
        checks.check(renderer.extend(make_sparks()).empty(), "the extension");
        const host::Picture picture = host::make_picture(size);
        const auto frame = [&] {
            renderer.render(scene.world, scene.camera, {picture.framebuffer, size});
            return host::read(picture);
        };
        const std::vector<glm::vec4> usual = frame();
        constexpr glm::vec3 spark{0.5F, 0.5F, 0.0F};
        constexpr glm::vec3 below{-0.5F, -0.5F, 0.0F};
        const candela::Entity sparks = scene.world.create();
        scene.world.set(sparks, host::Sparks{{spark, below}});

        // The lamp of 3 cd is 0.5 m above and beside it: I cos θ / r² / π.
        const float lit = 3.0F * std::sqrt(0.5F) / 0.5F / std::numbers::pi_v<float>;
        const std::size_t place = pixel_of(scene, spark);
        const std::vector<glm::vec4> shown = frame();
        checks.check(near(shown[place], lit), "a particle is lit like a surface");
        const std::size_t under_ground = pixel_of(scene, below);
        checks.check(shown[under_ground] == usual[under_ground], "the ground hides what is below it");

        // A lid over the particle, narrow enough for the camera to see past it from the side, keeps its light
        // away.
        const candela::Entity lid = scene.world.create();
        scene.world.set(lid, candela::Transform{.translation = {0.25F, 0.75F, 0.0F}});
        scene.world.set(lid, candela::MeshInstance{host::ground(0.1F, 0.5F)});
        checks.check(frame()[place].r < 0.1F * lit, "a particle is in the shadow of what is drawn");
        scene.world.destroy(lid);
        checks.check(near(frame()[place], lit), "and out of it again");

        scene.world.destroy(sparks);
        checks.check(frame() == usual, "without particles, the picture is as before");
        configuration.show = candela::Show::albedo;
        checks.check(renderer.configure(configuration).empty(), "a configuration without light");
        (void)frame();
    }
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
