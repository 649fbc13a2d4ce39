#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "renderer/gl/program.hpp"
#include "renderer/gpu_types.hpp"
#include "tests/renderer/context_fixture.hpp"

using namespace candela;

namespace {

struct Start {
    glm::vec2 start;
    std::uint32_t light;
    std::uint32_t pad0 = 0;
};

gpu::Light spot(float cos_inner, float cos_outer) {
    return {.position = {1, 2, 3},
            .kind = gpu::LightKind::spot,
            .direction = glm::normalize(glm::vec3(0.3F, -0.9F, 0.2F)),
            .cos_inner = cos_inner,
            .cos_outer = cos_outer};
}

std::vector<gpu::Light> lights() {
    return {{.position = {1, 2, 3}, .kind = gpu::LightKind::point},
            spot(0.9F, 0.7F),
            spot(0.7F + 1e-3F * 0.3F, 0.7F),  // a hard edge
            spot(1.0F, 0.5F),                 // no inner cone
            {.position = {-3, 5, 2},
             .kind = gpu::LightKind::directional,
             .direction = glm::normalize(glm::vec3(-0.1F, -0.8F, 0.5F)),
             .shape = {4.0F, 0.25F}}};
}

std::string source() {
    std::ifstream file(std::filesystem::path(__FILE__).parent_path() / "emission.comp");
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_SUITE("emission") {
    TEST_CASE_FIXTURE(GlFixture,
                      "from where a ray starts on its light, its start in the square is found again") {
        const std::string text = source();
        const auto shipped = gl::embedded_shaders();
        std::vector<gl::EmbeddedShader> files(shipped.begin(), shipped.end());
        files.push_back({"emission.comp", text});
        const gl::Program program = gl::compile(device, gl::ShaderLibrary(files), {"emission.comp"});

        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform;
        std::vector<Start> starts;
        for (std::uint32_t i = 0; i < 20'000; ++i) {
            const float x = uniform(random);
            starts.push_back({{x, uniform(random)}, i % static_cast<std::uint32_t>(lights().size())});
        }
        const gl::Buffer light_buffer(device, "lights", lights());
        const gl::Buffer start_buffer(device, "starts", starts);
        const gl::Buffer result_buffer(device, "results", starts.size() * sizeof(glm::vec4));
        light_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        start_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        result_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
        program.set("start_count", static_cast<std::uint32_t>(starts.size()));
        program.use();
        device.gl().DispatchCompute(static_cast<GLuint>(starts.size() + 63) / 64, 1, 1);

        const auto results = result_buffer.download<glm::vec4>();
        for (std::size_t i = 0; i < starts.size(); ++i) {
            CAPTURE(starts[i].light);
            const glm::vec2 start = starts[i].start;
            const glm::vec2 error = glm::abs(glm::vec2(results[i]) - start);
            // A cosine is a float near 1, so that a spot's flux within it has an error of 2⁻²³ over the
            // flux's share of the cosine's range: here 0.1 and more, but for the hard edge's ramp, where the
            // cube root multiplies it.
            CHECK(error.x < 2e-5F);
            // Near a pole the azimuth has the rounding of the distance from it; turns are cyclic.
            const float radius = std::sqrt(start.x * (1.0F - 0.5F * start.x));
            const bool has_azimuth = lights()[starts[i].light].kind != gpu::LightKind::directional;
            const float turned = has_azimuth ? std::min(error.y, 1.0F - error.y) * radius : error.y;
            CHECK(turned < 2e-5F);
            CHECK(results[i].z == 1.0F);
            // A spot sends nothing backwards.
            if (lights()[starts[i].light].kind == gpu::LightKind::spot) CHECK(results[i].w == 0.0F);
        }
    }
}
