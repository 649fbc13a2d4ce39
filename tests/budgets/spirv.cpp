#include "tests/budgets/spirv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::budgets {
namespace {

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::vector<SpirvStage> to_spirv(const RecordedProgram& program) {
    const sandbox::TemporaryFolder folder;
    std::string files;
    for (const RecordedShader& shader : program.shaders) {
        const std::string file = "source." + file_ending(shader.stage);
        std::ofstream(folder / file.c_str()) << shader.text;
        files += " " + file;
    }
    // All stages at once, so that what one passes to the next gets one location.
    const std::string command = fmt::format(
        "cd '{}' && glslangValidator -V -R --target-env vulkan1.1 --auto-map-locations --auto-map-bindings "
        "--shift-ssbo-binding {} --shift-texture-binding {} --shift-sampler-binding {} "
        "--shift-image-binding {} --set-default-uniform-block loose 1 0 {} > said",
        (folder / "").string(), +first_storage_block, +first_texture, +first_texture, +first_image, files);
    if (std::system(command.c_str()) != 0) throw std::runtime_error(contents(folder / "said"));

    std::vector<SpirvStage> stages;
    for (const RecordedShader& shader : program.shaders) {
        const std::string bytes = contents(folder / (file_ending(shader.stage) + ".spv").c_str());
        SpirvStage& stage = stages.emplace_back();
        stage.stage = shader.stage;
        stage.words.resize(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(stage.words.data(), bytes.data(), bytes.size());
    }
    return stages;
}

bool has_instruction(const SpirvStage& stage, std::uint32_t code,
                     std::initializer_list<std::uint32_t> operands) {
    constexpr std::size_t header = 5;
    const std::vector<std::uint32_t>& words = stage.words;
    for (std::size_t at = header; at < words.size(); at += words[at] >> 16U) {
        if ((words[at] & 0xFFFFU) != code || words[at] >> 16U < operands.size() + 2) continue;
        if (std::equal(operands.begin(), operands.end(), words.begin() + static_cast<std::ptrdiff_t>(at) + 2))
            return true;
    }
    return false;
}

}  // namespace candela::budgets
