#include <doctest/doctest.h>

#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/loop_parts.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gpu") {

using namespace candela;

namespace {

/// Each of 64 invocations adds, to the sum of what all had before, as many numbers of a loop as its part has.
constexpr std::string_view sum_of_all = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) restrict buffer Sums { uint sums[]; };
#include "loop_part.glsl"
uniform uint count;
uniform uint written;
void main() {
    uint sum = 0u;
    if (part_first > 0u) {
        for (uint i = 0u; i < 64u; ++i) sum += sums[64u * (1u - written) + i] / 64u;
    }
    for (uint i = part_first; i < min(count, part_first + part_size); ++i) sum += 64u * i;
    sums[64u * written + gl_GlobalInvocationID.x] = sum;
}
)";

constexpr std::array<gl::EmbeddedShader, 2> files{
    {{"loop_part.glsl", "uniform uint part_first;\nuniform uint part_size;\n"}, {"sum.comp", sum_of_all}}};

}  // namespace

TEST_CASE("a loop is cut into parts that a driver runs through, at least one") {
    const gl::Limits of_80{.loop_iterations = 80};
    CHECK(loop_parts(of_80, 0, 10).size() == 1);
    CHECK(loop_parts(of_80, 8, 10).size() == 1);
    CHECK(loop_parts(of_80, 9, 10).size() == 2);
    CHECK(loop_parts(of_80, 9, 100).size() == 9);  // an iteration cannot be cut
    CHECK(loop_parts({}, 1'000'000, 1'000'000).size() == 1);
    std::vector<std::uint32_t> starts;
    for (const gl::Uniforms& part : loop_parts(of_80, 20, 10)) {
        starts.push_back(std::get<std::uint32_t>(part.begin()->value));
    }
    CHECK(starts == std::vector<std::uint32_t>{0, 8, 16});
}

TEST_CASE_FIXTURE(GlFixture, "each step of a computation sees what those before it have written") {
    Gpu gpu(context->get_proc(), gl::ShaderLibrary(files), {});
    const gl::Buffer sums(gpu.device(), "sums", 128 * sizeof(std::uint32_t));
    sums.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    constexpr std::uint32_t count = 1000;
    ComputeSteps steps(gpu);
    std::uint32_t written = 0;
    for (const gl::Uniforms& part : loop_parts({.loop_iterations = 300}, count, 1)) {
        steps.run(gpu.programs().compiled({"sum.comp"}, {}), {},
                  part + gl::Uniforms{{"count", count}, {"written", written}});
        written = 1 - written;
    }
    const std::vector<std::uint32_t> result = sums.download<std::uint32_t>();
    for (std::size_t i = 0; i < 64; ++i) {
        CHECK(result[64 * (1 - written) + i] == 64 * (count * (count - 1) / 2));
    }
}
}  // TEST_SUITE("gpu")
