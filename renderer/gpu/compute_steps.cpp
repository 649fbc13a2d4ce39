#include "renderer/gpu/compute_steps.hpp"

#include <algorithm>

namespace candela {

void ComputeSteps::run(const gl::Program& program, const Groups& groups, const gl::Uniforms& uniforms) {
    begin(program, uniforms);
    gpu_.gl().DispatchCompute(groups.x, groups.y, groups.z);
}

void ComputeSteps::run_rows(const Execution& run, const gl::Program& program, const Groups& groups,
                            const gl::Uniforms& uniforms) {
    constexpr std::uint32_t most_parts = 8;
    const std::uint32_t at_once = (groups.y + most_parts - 1) / most_parts;
    const std::uint32_t step = run.may_end() ? at_once : groups.y;
    for (std::uint32_t first = 0; first < groups.y; first += step) {
        run.end_if_unwanted();
        const std::uint32_t rows = std::min(step, groups.y - first);
        this->run(program, {groups.x, rows, groups.z}, uniforms + gl::Uniforms{{"first_row", first}});
    }
}

void ComputeSteps::run_indirect(const gl::Program& program, const gl::Uniforms& uniforms, GLintptr offset) {
    begin(program, uniforms);
    gpu_.gl().DispatchComputeIndirect(offset);
}

void ComputeSteps::begin(const gl::Program& program, const gl::Uniforms& uniforms) {
    if (!is_first_) {
        gpu_.gl().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                GL_COMMAND_BARRIER_BIT);
    }
    is_first_ = false;
    program.use(uniforms);
}

}  // namespace candela
