#pragma once

#include <vulkan/vulkan.h>

#include <map>
#include <memory>
#include <span>
#include <string>

#include "tests/budgets/shader_cost.hpp"
#include "tests/budgets/spirv.hpp"

namespace candela::budgets {

/// An AMD GPU that need not be there: RADV, Mesa's Vulkan driver, compiles for it, and executes nothing.
/// Several threads may use it.
class NullGpu {
 public:
    [[nodiscard]] static bool has_driver();
    /// One of `gpus`. Throws std::runtime_error if the driver does not know it.
    explicit NullGpu(const char* name);
    NullGpu(const NullGpu&) = delete;
    NullGpu& operator=(const NullGpu&) = delete;
    ~NullGpu();

    /// "Mesa 22.3.6"
    [[nodiscard]] const std::string& driver() const { return driver_; }

    /// What each stage of a program costs. A stage that the GPU runs as one with the next is part of that.
    /// Throws std::runtime_error if the driver refuses the program.
    [[nodiscard]] std::map<GLenum, ShaderCost> costs(std::span<const SpirvStage> program) const;

 private:
    void make_device(VkPhysicalDevice physical);
    void make_layout();
    [[nodiscard]] VkPipeline make_pipeline(std::span<const SpirvStage> program,
                                           std::span<const VkPipelineShaderStageCreateInfo> stages) const;
    [[nodiscard]] std::map<GLenum, ShaderCost> costs_of(VkPipeline pipeline) const;

    std::string driver_;
    std::uint32_t smallest_wave_ = 0;  // lanes
    VkInstance instance_ = nullptr;
    VkDevice device_ = nullptr;
    std::array<VkDescriptorSetLayout, 2> sets_{};
    VkPipelineLayout layout_ = nullptr;
};

}  // namespace candela::budgets
