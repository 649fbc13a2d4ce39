#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "tests/renderer/recorded_programs.hpp"

namespace candela::budgets {

/// Where to_spirv puts a program's resources: for each kind of GL's, a range of bindings in set 0.
enum Bindings : std::uint32_t {
    first_uniform_block = 0,
    first_storage_block = 16,
    first_texture = 48,
    first_image = 80,
    last_binding = 95,
};

struct SpirvStage {
    GLenum stage = 0;
    std::vector<std::uint32_t> words;
};

/// The program for Vulkan, by glslang. Uniforms outside of blocks become a block: binding 0 of set 1. Throws
/// std::runtime_error with what glslang says.
[[nodiscard]] std::vector<SpirvStage> to_spirv(const RecordedProgram& program);

/// Whether the stage has this instruction; `operands`: those behind its first.
[[nodiscard]] bool has_instruction(const SpirvStage& stage, std::uint32_t code,
                                   std::initializer_list<std::uint32_t> operands);

}  // namespace candela::budgets
