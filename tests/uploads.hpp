#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include <candela/gl_loader.hpp>
#include "renderer/gl/functions.hpp"

namespace candela {

/// Counts the bytes that are uploaded to buffers and, of 4 bytes per texel, to 2D textures, by all renderers
/// that are made with `counting`.
class Uploads {
 public:
    /// The same functions, with counting ones in the places of those that upload.
    [[nodiscard]] static gl::GetProc counting(gl::GetProc get_proc) {
        return [get_proc = std::move(get_proc)](const char* name) -> void (*)() {
            const auto found = get_proc(name);
            if (std::string_view(name) == "glNamedBufferSubData") {
                to_buffer_ = reinterpret_cast<PFNGLNAMEDBUFFERSUBDATAPROC>(found);
                return reinterpret_cast<void (*)()>(&count_buffer);
            }
            if (std::string_view(name) == "glTextureSubImage2D") {
                to_texture_ = reinterpret_cast<PFNGLTEXTURESUBIMAGE2DPROC>(found);
                return reinterpret_cast<void (*)()>(&count_texture);
            }
            return found;
        };
    }

    /// The bytes since the last call.
    [[nodiscard]] static std::uint64_t take() { return std::exchange(bytes_, 0); }

 private:
    static void count_buffer(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
        bytes_ += static_cast<std::uint64_t>(size);
        to_buffer_(buffer, offset, size, data);
    }

    static void count_texture(GLuint texture, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                              GLenum layout, GLenum type, const void* data) {
        bytes_ += 4 * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        to_texture_(texture, level, x, y, width, height, layout, type, data);
    }

    static inline std::uint64_t bytes_ = 0;
    static inline PFNGLNAMEDBUFFERSUBDATAPROC to_buffer_ = nullptr;
    static inline PFNGLTEXTURESUBIMAGE2DPROC to_texture_ = nullptr;
};

}  // namespace candela
