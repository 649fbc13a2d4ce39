// A tool that looks at what Candela computes: a resource of the frame graph, the difference of two pictures,
// and where a point of the scene is in the picture.

#include <epoxy/gl.h>

#include <candela/inspection.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include "host.hpp"

namespace {

constexpr glm::uvec2 size{64, 48};

/// The largest red, green or blue.
float brightest(const host::Picture& picture) {
    float most = 0.0F;
    for (const glm::vec4& pixel : host::read(picture)) most = std::max({most, pixel.r, pixel.g, pixel.b});
    return most;
}

/// Where a point is in a picture, in pixels from its lower left corner.
glm::vec2 pixel_of(const candela::CameraView& view, const glm::vec3& point) {
    const glm::vec4 clip = view.clip_from_world * glm::vec4(point, 1.0F);
    return (glm::vec2(clip) / clip.w * 0.5F + 0.5F) * glm::vec2(size);
}

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(context->get_proc());
        candela::ResourceInspector inspector(renderer);
        checks.check(inspector.show(candela::Inspection{.resource = "depth"}).empty(), "the inspection");
        const host::Picture before = host::make_picture(size, GL_RGBA8);
        const host::Picture after = host::make_picture(size, GL_RGBA8);
        const host::Picture difference = host::make_picture(size, GL_RGBA8);
        renderer.render(scene.world, scene.camera, {before.framebuffer, size});
        const candela::InspectionResult depth = inspector.result();
        checks.check(depth.texture != 0 && depth.size == size, "there is no picture of the depth");
        checks.check(depth.unit == "m" && std::abs(depth.low - 3.0F) < 0.01F, "the ground is 3 m away");
        scene.world.set(scene.lamp, candela::Transform{.translation = {1, 1, 0}});
        renderer.render(scene.world, scene.camera, {after.framebuffer, size});

        candela::draw_difference(renderer, before.texture, before.texture, 8.0F,
                                 {difference.framebuffer, size});
        checks.check(brightest(difference) == 0.0F, "a picture differs from itself");
        candela::draw_difference(renderer, before.texture, after.texture, 8.0F,
                                 {difference.framebuffer, size});
        checks.check(brightest(difference) > 0.1F, "the lamp has moved without a difference");

        const glm::mat4 world_from_camera = glm::translate(glm::mat4(1.0F), host::from_above().translation) *
                                            glm::mat4_cast(host::from_above().rotation);
        const candela::CameraView view = candela::make_view({}, world_from_camera, size);
        const glm::vec2 centre = 0.5F * glm::vec2(size);
        checks.check(glm::distance(pixel_of(view, {0, 0, 0}), centre) < 1e-3F, "the middle of the ground");
        const candela::CameraView shifted =
            candela::make_view({}, world_from_camera, size, candela::pixel_sample(1));
        checks.check(glm::distance(pixel_of(shifted, {0, 0, 0}), centre - candela::pixel_sample(1)) < 1e-3F,
                     "a sample is where its jitter says");
        const glm::vec3 hot = candela::heat_colour(1.0F);
        checks.check(hot.r > hot.b, "the high end of the heat map");
    }
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
