#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include <candela/gl_loader.hpp>
#include "renderer/gl/functions.hpp"

namespace candela {

struct ProgramCounts {
    std::uint32_t linked = 0;  ///< from sources
    std::uint32_t loaded = 0;  ///< from binaries, also such that the driver refuses
    bool operator==(const ProgramCounts&) const = default;
};

/// Counts the programs that all renderers compile which are made with `counting`.
class Compilations {
 public:
    /// The same functions, with counting ones in the places of those that make programs.
    [[nodiscard]] static gl::GetProc counting(gl::GetProc get_proc) {
        return [get_proc = std::move(get_proc)](const char* name) -> void (*)() {
            const auto found = get_proc(name);
            if (std::string_view(name) == "glLinkProgram") {
                link_ = reinterpret_cast<PFNGLLINKPROGRAMPROC>(found);
                return reinterpret_cast<void (*)()>(&count_link);
            }
            if (std::string_view(name) == "glProgramBinary") {
                load_ = reinterpret_cast<PFNGLPROGRAMBINARYPROC>(found);
                return reinterpret_cast<void (*)()>(&count_load);
            }
            return found;
        };
    }

    /// Since the last call.
    static ProgramCounts take() { return std::exchange(counts_, {}); }

 private:
    static void count_link(GLuint program) {
        ++counts_.linked;
        link_(program);
    }
    static void count_load(GLuint program, GLenum format, const void* binary, GLsizei size) {
        ++counts_.loaded;
        load_(program, format, binary, size);
    }

    static inline ProgramCounts counts_;
    static inline PFNGLLINKPROGRAMPROC link_ = nullptr;
    static inline PFNGLPROGRAMBINARYPROC load_ = nullptr;
};

}  // namespace candela
