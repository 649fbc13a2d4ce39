#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/gl/compiling_program.hpp"
#include "renderer/gl/program_cache.hpp"
#include "renderer/gl/shader_source.hpp"
#include "renderer/gpu/log.hpp"

namespace candela {

/// The programs of one renderer. Passes request theirs while a frame is declared; then all that have been
/// requested are compiled together.
class Programs {
 public:
    /// How many of the requested programs are ready. Returns whether to go on.
    using Progress = std::function<bool(std::size_t done, std::size_t total)>;

    /// `cache`: see RendererOptions::program_cache. The device and `log` must outlive the object.
    Programs(gl::Device& device, gl::ShaderLibrary shaders, const std::filesystem::path& cache, Log& log);

    /// The program of these stage files with these names defined: NAME as 1, or NAME=VALUE. Of use after the
    /// next `compile`. The reference stays valid. Throws gl::ProgramError if a file is missing or includes
    /// itself.
    [[nodiscard]] const gl::Program& request(const std::vector<std::string>& stages,
                                             const std::vector<std::string>& defined);
    /// The same for use at once. Throws gl::ProgramError.
    [[nodiscard]] const gl::Program& compiled(const std::vector<std::string>& stages,
                                              const std::vector<std::string>& defined);

    /// Source of a shader file with its includes and the same kind of names, as a part of a host's shader.
    [[nodiscard]] std::string source_part(std::string_view file,
                                          const std::vector<std::string>& defined) const;

    /// Compiles what has been requested since the last call, and is not ready yet: starts all before it waits
    /// for any. Throws gl::ProgramError for the first that does not compile. `progress` is told how many are
    /// ready, first those that were before. Returns false if it has stopped the compilation. In both cases
    /// those that are ready stay, and the others have to be requested again.
    bool compile(const Progress& progress = {});
    /// Forgets what has been requested.
    void forget_requests();

 private:
    /// A program that is missing.
    struct Request {
        gl::Program* program;
        gl::ProgramSource source;
    };
    using Key = std::pair<std::vector<std::string>, std::vector<std::string>>;

    [[nodiscard]] gl::ProgramCache* cache() { return cache_ ? &*cache_ : nullptr; }

    gl::Device* device_;
    gl::ShaderLibrary shaders_;
    std::optional<gl::ProgramCache> cache_;
    std::map<Key, gl::Program> programs_;  // without a name if not ready
    std::set<const gl::Program*> requested_;
    std::vector<Request> missing_;  // of those requested, in their order
};

}  // namespace candela
