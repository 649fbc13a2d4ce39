// A host that has drawn the scene's surfaces already, and takes their light from Candela.

#include <epoxy/gl.h>

#include "host.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace {

constexpr glm::uvec2 size{64, 48};
constexpr float pi = 3.14159265F;

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    host::Scene scene = host::make_scene();
    {
        candela::Renderer renderer(context->get_proc());
        host::show_radiance(renderer, checks);

        const candela::Camera camera = scene.world.get<candela::Camera>(scene.camera);
        const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        const glm::mat4 projection = glm::perspective(camera.vertical_fov, aspect, 0.1F, 10.0F);
        const glm::mat4 view = glm::lookAt(glm::vec3(0, 3, 0), glm::vec3(0), glm::vec3(0, 0, -1));
        const host::Gbuffer ground = host::draw_ground(projection * view, size);

        const host::Picture picture = host::make_picture(size);
        const candela::RenderView seen{
            .camera = scene.camera,
            .target = {picture.framebuffer, size},
            .surfaces = candela::HostSurfaces{.depth = ground.depth,
                                              .normal = ground.normal,
                                              .albedo = ground.albedo,
                                              .clip_from_view = projection,
                                              .normal_encoding = candela::NormalEncoding::unsigned_xyz}};
        renderer.render(scene.world, {&seen, 1});

        // A lamp of 3 cd at a height of 1 m over a diffuse plane: albedo / pi · I · cos / r², with cos = 1 /
        // r.
        const std::vector<glm::vec4> light = host::read(picture);
        float worst = 0.0F;
        for (unsigned y = 0; y < size.y; ++y) {
            for (unsigned x = 0; x < size.x; ++x) {
                const glm::vec2 ndc = (glm::vec2(x, y) + 0.5F) / glm::vec2(size) * 2.0F - 1.0F;
                const glm::vec2 on_ground =
                    ndc * 3.0F * std::tan(camera.vertical_fov / 2.0F) * glm::vec2(aspect, 1.0F);
                const float r2 = 1.0F + on_ground.x * on_ground.x + on_ground.y * on_ground.y;
                const float albedo = 128.0F / 255.0F;  // 0.5 in 8 bits
                const float expected = albedo / pi * 3.0F / (r2 * std::sqrt(r2));
                worst = std::max(worst, std::abs(light[y * size.x + x].r / expected - 1.0F));
            }
        }
        // 8 bits store the normal's zeros as 1/255, which tilts it by 0.3 degrees.
        checks.check(worst < 0.02F, "the light of the plane differs by " + std::to_string(worst));
        for (const candela::PassRecord& pass : renderer.last_passes()) {
            checks.check(pass.name != "gbuffer", "Candela drew surfaces");
        }
    }
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
