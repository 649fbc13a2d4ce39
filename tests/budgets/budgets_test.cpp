// What the programs of the shipped scenes cost on GPUs, by a compiler for them: no GPU is needed. The table
// beside this file holds what they may cost.

#include <doctest/doctest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <candela/configuration.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/budgets/budget_table.hpp"
#include "tests/budgets/null_gpu.hpp"
#include "tests/budgets/spirv.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/recorded_programs.hpp"

TEST_SUITE("budgets") {

using namespace candela;
using namespace candela::budgets;

namespace {

namespace fs = std::filesystem;

const fs::path table_file = CANDELA_BUDGETS;

std::vector<std::string> shipped_scenes() {
    std::vector<std::string> names;
    for (const fs::directory_entry& file : fs::directory_iterator(CANDELA_SCENES)) {
        if (file.path().extension() == ".gltf") names.push_back(file.path().stem());
    }
    return names;
}

/// All that the app offers by name, as in a window; and rays to VPLs, which GPUs can afford.
std::vector<Configuration> configurations() {
    std::vector<Configuration> all;
    for (const NamedConfiguration& named : named_configurations()) {
        for (const VplVisibility method : {named.configuration.visibility.method, VplVisibility::rays}) {
            Configuration& configuration = all.emplace_back(named.configuration);
            configuration.visibility.method = method;
            configuration.refinement.enabled = true;
            configuration.frame_budget_ms.reset();
            configuration.tone_map.automatic_exposure = true;
        }
    }
    return all;
}

/// The programs of frames of the shipped scenes on a GPU, each once.
std::vector<RecordedProgram> programs_of_scenes(const gl::GetProc& get_proc) {
    Renderer renderer(RecordedPrograms::recording(get_proc));
    pretend(renderer, false, endless_loops);
    for (const std::string& name : shipped_scenes()) {
        const Scene scene = shipped_scene(name);
        const std::vector<RenderView> views{{.camera = scene.camera, .target = {0, {512, 512}}}};
        for (const Configuration& configuration : configurations()) {
            REQUIRE(renderer.prepare(configuration, scene.world, views).empty());
        }
    }
    std::vector<RecordedProgram> programs = RecordedPrograms::take();
    std::set<std::vector<RecordedShader>> seen;
    std::erase_if(programs,
                  [&](const RecordedProgram& program) { return !seen.insert(program.shaders).second; });
    return programs;
}

/// The words that a shader is compiled with, NAME or NAME=VALUE: they stand before the text of its file.
std::vector<std::string> words_of(const RecordedShader& shader) {
    std::vector<std::string> words;
    std::istringstream lines(shader.text);
    for (std::string line; std::getline(lines, line) && !line.starts_with("#line");) {
        std::istringstream parts(line);
        std::string define;
        std::string name;
        std::string value;
        if (parts >> define >> name >> value && define == "#define") {
            words.push_back(value == "1" ? name : name + "=" + value);
        }
    }
    return words;
}

/// The row of a shader in the table: "shading/deferred.comp+shadow" for one with SHADOW_RAYS. Such words are
/// meant for the stage that shades, though all have them.
std::string row_of(std::string file, const std::vector<std::string>& words) {
    constexpr std::string_view ending = "_RAYS";
    if (file.ends_with(".vert")) return file;
    for (const std::string& word : words) {
        if (!word.ends_with(ending)) continue;
        file += '+';
        for (const char letter : word.substr(0, word.size() - ending.size())) {
            file += static_cast<char>(std::tolower(letter));
        }
    }
    return file;
}

/// The files of a program's stages, by its label.
std::vector<std::string> files_of(const RecordedProgram& program) {
    std::vector<std::string> files;
    std::istringstream words(program.label);
    for (std::string word; words >> word;) {
        if (word != "and") files.push_back(word);
    }
    return files;
}

std::vector<MeasuredShader> measure(const RecordedProgram& program,
                                    const std::vector<std::unique_ptr<NullGpu>>& nulls) {
    const std::vector<std::string> files = files_of(program);
    std::map<GLenum, Costs> costs;  // by stage
    try {
        const std::vector<SpirvStage> stages = to_spirv(program);
        for (std::size_t gpu = 0; gpu < nulls.size(); ++gpu) {
            for (const auto& [stage, cost] : nulls[gpu]->costs(stages)) costs[stage].at(gpu) = cost;
        }
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{}: {}", program.label, error.what()));
    }
    std::vector<MeasuredShader> measured;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const RecordedShader& shader = program.shaders.at(i);
        const auto found = costs.find(shader.stage);
        if (found == costs.end()) continue;  // is part of the next
        const std::vector<std::string> words = words_of(shader);
        measured.push_back({.row = row_of(files[i], words),
                            .variant = fmt::format("{}", fmt::join(words, " ")),
                            .costs = found->second});
    }
    return measured;
}

/// All, by all processors.
std::vector<MeasuredShader> measure_all(const std::vector<RecordedProgram>& programs,
                                        const std::vector<std::unique_ptr<NullGpu>>& nulls) {
    std::vector<std::vector<MeasuredShader>> measured(programs.size());
    std::atomic<std::size_t> next = 0;
    std::vector<std::future<void>> workers;
    for (unsigned i = 0; i < std::max(std::thread::hardware_concurrency(), 1U); ++i) {
        workers.push_back(std::async(std::launch::async, [&] {
            for (std::size_t at = next++; at < programs.size(); at = next++)
                measured[at] = measure(programs[at], nulls);
        }));
    }
    for (std::future<void>& worker : workers) worker.get();
    std::vector<MeasuredShader> all;
    for (std::vector<MeasuredShader>& each : measured) all.insert(all.end(), each.begin(), each.end());
    return all;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "no shader costs a GPU more than the table says") {
    if (!NullGpu::has_driver()) {
        MESSAGE("skipped: no RADV, see mesa-vulkan-drivers in .ci/packages");
        return;
    }
    const std::string driver = NullGpu(gpus.front()).driver();
    const bool writes = std::getenv("CANDELA_NEW_BUDGETS") != nullptr;
    const BudgetTable table = writes ? BudgetTable{.driver = driver, .rows = {}} : read_budgets(table_file);
    if (driver != table.driver) {
        MESSAGE("skipped: the table is of " << table.driver << ", this is " << driver);
        return;
    }
    std::vector<std::unique_ptr<NullGpu>> nulls;
    for (const char* const gpu : gpus) nulls.push_back(std::make_unique<NullGpu>(gpu));
    const std::vector<RecordedProgram> programs = programs_of_scenes(context->get_proc());
    const std::vector<MeasuredShader> measured = measure_all(programs, nulls);
    CHECK(programs.size() > 100);
    if (writes) {
        write_budgets(table_of(measured, driver), table_file);
        return;
    }
    const Differences differences = compare(measured, table);
    for (const std::string& better : differences.better) MESSAGE(better);
    for (const std::string& fault : differences.faults) FAIL_CHECK(fault);
}

}  // TEST_SUITE("budgets")
