#include "renderer/gpu/programs.hpp"

#include <deque>

namespace candela {
namespace {

std::vector<gl::Define> defines_of(const std::vector<std::string>& defined) {
    std::vector<gl::Define> defines;
    defines.reserve(defined.size());
    for (const std::string& word : defined) {
        const std::size_t equals = word.find('=');
        defines.push_back({.name = word.substr(0, equals),
                           .value = equals == std::string::npos ? "1" : word.substr(equals + 1)});
    }
    return defines;
}

/// A program that is being compiled, and where it goes.
struct Started {
    gl::Program* program;
    gl::CompilingProgram compiling;
};

}  // namespace

Programs::Programs(gl::Device& device, gl::ShaderLibrary shaders, const std::filesystem::path& cache,
                   Log& log)
    : device_(&device), shaders_(std::move(shaders)) {
    if (!cache.empty()) {
        cache_.emplace(device, cache, [&log](std::string line) { log.warn(std::move(line)); });
    }
}

const gl::Program& Programs::request(const std::vector<std::string>& stages,
                                     const std::vector<std::string>& defined) {
    gl::Program& program = programs_[Key(stages, defined)];
    if (requested_.insert(&program).second && !program) {
        missing_.push_back({&program, gl::assemble_program(shaders_, stages, defines_of(defined))});
    }
    return program;
}

const gl::Program& Programs::compiled(const std::vector<std::string>& stages,
                                      const std::vector<std::string>& defined) {
    gl::Program& program = programs_[Key(stages, defined)];
    if (!program) {
        gl::ProgramSource source = gl::assemble_program(shaders_, stages, defines_of(defined));
        program = gl::CompilingProgram(*device_, std::move(source), cache()).finish();
    }
    return program;
}

std::string Programs::source_part(std::string_view file, const std::vector<std::string>& defined) const {
    return gl::assemble_part(shaders_, file, defines_of(defined));
}

void Programs::forget_requests() {
    requested_.clear();
    missing_.clear();
}

bool Programs::compile(const Progress& progress) {
    std::vector<Request> missing = std::exchange(missing_, {});
    const std::size_t total = std::exchange(requested_, {}).size();
    std::size_t done = total - missing.size();
    const auto goes_on = [&] { return !progress || progress(done, total); };
    if (!goes_on()) return false;
    if (missing.empty()) return true;

    const gl::AllCompilerThreads threads(device_->gl());
    std::deque<Started> started;
    const auto finish_first = [&] {
        *started.front().program = started.front().compiling.finish();
        started.pop_front();
        ++done;
        return goes_on() || done == total;
    };
    for (Request& request : missing) {
        started.push_back({request.program, {*device_, std::move(request.source), cache()}});
        while (!started.empty() && started.front().compiling.is_done()) {
            if (!finish_first()) return false;
        }
    }
    while (!started.empty()) {
        if (!finish_first()) return false;
    }
    return true;
}

}  // namespace candela
