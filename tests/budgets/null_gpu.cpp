#include "tests/budgets/null_gpu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "shaders/bindings.glsl"

namespace candela::budgets {

namespace fs = std::filesystem;

namespace {

void require(VkResult result, std::string_view what) {
    if (result != VK_SUCCESS)
        throw std::runtime_error(fmt::format("{} fails: {}", what, static_cast<int>(result)));
}

/// The file by which the Vulkan loader finds RADV; empty without RADV.
fs::path driver_file() {
    const fs::path folder = "/usr/share/vulkan/icd.d";
    if (!fs::exists(folder)) return {};
    for (const fs::directory_entry& file : fs::directory_iterator(folder)) {
        const std::string name = file.path().filename().string();
        if (name == "radeon_icd.json" || name == "radeon_icd.x86_64.json") return file.path();
    }
    return {};
}

VkShaderStageFlagBits flag_of(GLenum stage) {
    switch (stage) {
        case GL_VERTEX_SHADER:
            return VK_SHADER_STAGE_VERTEX_BIT;
        case GL_GEOMETRY_SHADER:
            return VK_SHADER_STAGE_GEOMETRY_BIT;
        case GL_FRAGMENT_SHADER:
            return VK_SHADER_STAGE_FRAGMENT_BIT;
        default:
            return VK_SHADER_STAGE_COMPUTE_BIT;
    }
}

/// The last of these stages.
GLenum last_stage(VkShaderStageFlags flags) {
    for (const GLenum stage :
         std::array<GLenum, 3>{GL_FRAGMENT_SHADER, GL_GEOMETRY_SHADER, GL_VERTEX_SHADER}) {
        if ((flags & static_cast<VkShaderStageFlags>(flag_of(stage))) != 0) return stage;
    }
    return GL_COMPUTE_SHADER;
}

bool blends_two_colours(const SpirvStage& stage) {
    constexpr std::uint32_t op_decorate = 71;
    constexpr std::uint32_t index = 32;
    return has_instruction(stage, op_decorate, {index, 1});
}

bool takes_points(const SpirvStage& stage) {
    constexpr std::uint32_t op_execution_mode = 16;
    constexpr std::uint32_t input_points = 19;
    return has_instruction(stage, op_execution_mode, {input_points});
}

constexpr std::uint32_t last_attribute = ATTRIBUTE_SECOND_UV;
constexpr std::uint32_t attribute_bytes = 16;  // of the largest type

/// Of the vertices of meshes.
std::vector<VkVertexInputAttributeDescription> vertex_attributes() {
    std::vector<VkVertexInputAttributeDescription> attributes;
    for (std::uint32_t i = 0; i <= last_attribute; ++i) {
        const VkFormat format = i == ATTRIBUTE_INSTANCE ? VK_FORMAT_R32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT;
        attributes.push_back({.location = i, .binding = 0, .format = format, .offset = attribute_bytes * i});
    }
    return attributes;
}

}  // namespace

bool NullGpu::has_driver() {
    return !driver_file().empty();
}

NullGpu::NullGpu(const char* name) {
    setenv("VK_ICD_FILENAMES", driver_file().c_str(), 1);
    setenv("RADV_FORCE_FAMILY", name, 1);
    setenv("RADV_DEBUG", "nocache", 1);
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pApplicationInfo = &application};
    require(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance");
    std::uint32_t one = 1;
    VkPhysicalDevice physical = nullptr;
    require(vkEnumeratePhysicalDevices(instance_, &one, &physical), "vkEnumeratePhysicalDevices");
    if (one == 0) throw std::runtime_error(fmt::format("RADV does not know {}", name));

    VkPhysicalDeviceVulkan13Properties of_13{.sType =
                                                 VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    VkPhysicalDeviceVulkan12Properties of_12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES,
                                             .pNext = &of_13};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &of_12};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    driver_ = of_12.driverInfo;
    smallest_wave_ = of_13.minSubgroupSize;
    make_device(physical);
    make_layout();
}

void NullGpu::make_device(VkPhysicalDevice physical) {
    VkPhysicalDeviceVulkan13Features of_13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                           .dynamicRendering = VK_TRUE};
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pNext = &of_13,
        .pipelineExecutableInfo = VK_TRUE};
    const VkPhysicalDeviceFeatures features{.imageCubeArray = VK_TRUE,
                                            .geometryShader = VK_TRUE,
                                            .dualSrcBlend = VK_TRUE,
                                            .vertexPipelineStoresAndAtomics = VK_TRUE,
                                            .fragmentStoresAndAtomics = VK_TRUE,
                                            .shaderStorageImageReadWithoutFormat = VK_TRUE,
                                            .shaderStorageImageWriteWithoutFormat = VK_TRUE,
                                            .shaderClipDistance = VK_TRUE};
    constexpr float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue{
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    constexpr const char* extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &statistics,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = 1,
                                  .ppEnabledExtensionNames = &extension,
                                  .pEnabledFeatures = &features};
    require(vkCreateDevice(physical, &info, nullptr, &device_), "vkCreateDevice");
}

/// One layout for all programs: that of to_spirv.
void NullGpu::make_layout() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const auto add = [&](std::uint32_t first, std::uint32_t end, VkDescriptorType type) {
        for (std::uint32_t i = first; i < end; ++i) {
            bindings.push_back({.binding = i,
                                .descriptorType = type,
                                .descriptorCount = 1,
                                .stageFlags = VK_SHADER_STAGE_ALL});
        }
    };
    const auto make_set = [&](VkDescriptorSetLayout& set) {
        const VkDescriptorSetLayoutCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
            .bindingCount = static_cast<std::uint32_t>(bindings.size()),
            .pBindings = bindings.data()};
        require(vkCreateDescriptorSetLayout(device_, &info, nullptr, &set), "vkCreateDescriptorSetLayout");
    };
    add(0, 1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    make_set(sets_[1]);
    bindings.clear();
    add(first_uniform_block, first_storage_block, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    add(first_storage_block, first_texture, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    add(first_texture, first_image, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    add(first_image, last_binding + 1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    make_set(sets_[0]);
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = static_cast<std::uint32_t>(sets_.size()),
                                          .pSetLayouts = sets_.data()};
    require(vkCreatePipelineLayout(device_, &info, nullptr, &layout_), "vkCreatePipelineLayout");
}

NullGpu::~NullGpu() {
    if (device_ != nullptr) {
        vkDestroyPipelineLayout(device_, layout_, nullptr);
        for (const VkDescriptorSetLayout set : sets_) vkDestroyDescriptorSetLayout(device_, set, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

std::map<GLenum, ShaderCost> NullGpu::costs(std::span<const SpirvStage> program) const {
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const SpirvStage& stage : program) {
        const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = stage.words.size() * sizeof(std::uint32_t),
                                            .pCode = stage.words.data()};
        VkShaderModule module = nullptr;
        require(vkCreateShaderModule(device_, &info, nullptr, &module), "vkCreateShaderModule");
        stages.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                          .stage = flag_of(stage.stage),
                          .module = module,
                          .pName = "main"});
    }
    const VkPipeline pipeline = make_pipeline(program, stages);
    std::map<GLenum, ShaderCost> costs = costs_of(pipeline);
    vkDestroyPipeline(device_, pipeline, nullptr);
    for (const auto& stage : stages) vkDestroyShaderModule(device_, stage.module, nullptr);
    return costs;
}

VkPipeline NullGpu::make_pipeline(std::span<const SpirvStage> program,
                                  std::span<const VkPipelineShaderStageCreateInfo> stages) const {
    constexpr VkPipelineCreateFlags flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    VkPipeline pipeline = nullptr;
    if (program.front().stage == GL_COMPUTE_SHADER) {
        const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                               .flags = flags,
                                               .stage = stages.front(),
                                               .layout = layout_};
        require(vkCreateComputePipelines(device_, nullptr, 1, &info, nullptr, &pipeline),
                "vkCreateComputePipelines");
        return pipeline;
    }
    const VkVertexInputBindingDescription vertex{.binding = 0,
                                                 .stride = attribute_bytes * (last_attribute + 1)};
    const std::vector<VkVertexInputAttributeDescription> attributes = vertex_attributes();
    const VkPipelineVertexInputStateCreateInfo vertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = 1,
        .pVertexBindingDescriptions = &vertex,
        .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size()),
        .pVertexAttributeDescriptions = attributes.data()};
    const bool points = std::ranges::any_of(program, &takes_points);
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = points ? VK_PRIMITIVE_TOPOLOGY_POINT_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport viewport{.width = 512, .height = 512, .maxDepth = 1};
    const VkRect2D scissor{.extent = {512, 512}};
    const VkPipelineViewportStateCreateInfo viewports{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER};
    // As many colours as the G-buffer or mirrors have at most; what a shader does not write costs nothing.
    const bool two_colours = blends_two_colours(program.back());
    const std::uint32_t colours = two_colours ? 1 : 8;
    const std::vector<VkPipelineColorBlendAttachmentState> blending(
        colours, {.blendEnable = two_colours ? VK_TRUE : VK_FALSE,
                  .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                  .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR,
                  .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                  .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA,
                  .colorWriteMask = 0xF});
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = colours,
        .pAttachments = blending.data()};
    const std::vector<VkFormat> formats(colours, VK_FORMAT_R32G32B32A32_SFLOAT);
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = colours,
                                                  .pColorAttachmentFormats = formats.data(),
                                                  .depthAttachmentFormat = VK_FORMAT_D32_SFLOAT};
    const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .flags = flags,
                                            .stageCount = static_cast<std::uint32_t>(stages.size()),
                                            .pStages = stages.data(),
                                            .pVertexInputState = &vertices,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewports,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .layout = layout_};
    require(vkCreateGraphicsPipelines(device_, nullptr, 1, &info, nullptr, &pipeline),
            "vkCreateGraphicsPipelines");
    return pipeline;
}

std::map<GLenum, ShaderCost> NullGpu::costs_of(VkPipeline pipeline) const {
    const auto get_executables = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutablePropertiesKHR"));
    const auto get_statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutableStatisticsKHR"));
    const VkPipelineInfoKHR all{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
    std::uint32_t count = 0;
    require(get_executables(device_, &all, &count, nullptr), "vkGetPipelineExecutablePropertiesKHR");
    std::vector<VkPipelineExecutablePropertiesKHR> executables(
        count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR});
    require(get_executables(device_, &all, &count, executables.data()),
            "vkGetPipelineExecutablePropertiesKHR");

    std::map<GLenum, ShaderCost> costs;
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
        const VkPipelineExecutableInfoKHR one{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                              .pipeline = pipeline,
                                              .executableIndex = i};
        require(get_statistics(device_, &one, &count, nullptr), "vkGetPipelineExecutableStatisticsKHR");
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
        require(get_statistics(device_, &one, &count, statistics.data()),
                "vkGetPipelineExecutableStatisticsKHR");
        const auto value = [&](std::string_view name) {
            const auto found =
                std::ranges::find_if(statistics, [&](const auto& each) { return each.name == name; });
            if (found == statistics.end())
                throw std::runtime_error(fmt::format("RADV does not tell {}", name));
            return static_cast<std::uint32_t>(found->value.u64);
        };
        const std::uint32_t lanes = executables[i].subgroupSize;
        // RADV counts waves of the smallest size, and scratch of all lanes together.
        const ShaderCost cost{.waves = value("Subgroups per SIMD") * smallest_wave_ / lanes,
                              .registers = value("VGPRs"),
                              .spilled = value("Spilled SGPRs") + value("Spilled VGPRs"),
                              .scratch = value("Scratch size") / lanes};
        const auto [stage, is_new] = costs.emplace(last_stage(executables[i].stages), cost);
        if (!is_new) stage->second = worst(stage->second, cost);  // such as what copies from a geometry stage
    }
    return costs;
}

}  // namespace candela::budgets
