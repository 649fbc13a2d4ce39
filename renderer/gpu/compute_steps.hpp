#pragma once

#include <cstdint>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// Number of work groups of a dispatch.
struct Groups {
    std::uint32_t x = 1;
    std::uint32_t y = 1;
    std::uint32_t z = 1;
};

/// The dispatches of a pass. Each sees what those before it have written to buffers and images.
class ComputeSteps {
 public:
    explicit ComputeSteps(const Gpu& gpu) : gpu_(gpu) {}

    void run(const gl::Program& program, const Groups& groups, const gl::Uniforms& uniforms = {});
    /// The same in one dispatch, or if the frame may be given up, in several, of some rows of work groups (y)
    /// each, between which the pass may end. The shader adds `first_row` to gl_WorkGroupID.y. No row depends
    /// on another.
    void run_rows(const Execution& run, const gl::Program& program, const Groups& groups,
                  const gl::Uniforms& uniforms);
    /// The numbers of groups are at `offset`, in bytes, in the buffer that the pass reads with
    /// Usage::indirect, or has bound for that.
    void run_indirect(const gl::Program& program, const gl::Uniforms& uniforms = {}, GLintptr offset = 0);

 private:
    void begin(const gl::Program& program, const gl::Uniforms& uniforms);

    const Gpu& gpu_;
    bool is_first_ = true;
};

}  // namespace candela
