#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "renderer/gl/device.hpp"

namespace candela::gl {

/// Owner of one GL name: moves, never copies, deletes the object with itself. Empty when default-constructed
/// or moved from; an empty object has name 0. The device outlives it.
class Object {
 public:
    Object() = default;
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    Object(Object&& other) noexcept;
    Object& operator=(Object&& other) noexcept;
    ~Object();

    [[nodiscard]] GLuint name() const { return name_; }
    [[nodiscard]] explicit operator bool() const { return name_ != 0; }
    /// Storage as asked for, in bytes; 0 for objects without any of their own.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 protected:
    /// Takes over `name` and gives it `label` in debuggers. `name` 0 throws GlError.
    Object(Device& device, ObjectKind kind, GLuint name, std::string_view label);
    [[nodiscard]] const Functions& gl() const { return device_->gl(); }
    [[nodiscard]] const Device& device() const { return *device_; }
    /// Enters the storage into the device's account.
    void set_bytes(std::uint64_t bytes);

 private:
    void release() noexcept;

    Device* device_ = nullptr;
    ObjectKind kind_ = ObjectKind::buffer;
    GLuint name_ = 0;
    std::uint64_t bytes_ = 0;
};

/// Types whose bytes may be copied to and from GL storage.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Arrays, vectors and spans of them.
template <class R>
concept PlainRange = std::ranges::contiguous_range<R> && Plain<std::ranges::range_value_t<R>>;

/// A buffer of fixed size that the CPU may upload to. For vertices, indices, uniforms, storage and arguments
/// alike.
class Buffer : public Object {
 public:
    Buffer() = default;
    /// `size` bytes of undefined content. Of size 0 it still is a buffer that can be bound. Throws GlError if
    /// the driver has no memory left.
    Buffer(Device& device, std::string_view label, std::uint64_t size);
    /// A copy of `data`.
    template <PlainRange R>
    Buffer(Device& device, std::string_view label, const R& data)
        : Buffer(device, label, std::span(data).size_bytes()) {
        upload(data);
    }

    /// Replaces the bytes from `offset` (in bytes). Throws GlError if they do not fit.
    template <PlainRange R>
    void upload(const R& data, std::uint64_t offset = 0) {
        write(std::as_bytes(std::span(data)), offset);
    }
    template <Plain T>
    requires(!std::ranges::range<T>) void upload(const T& value, std::uint64_t offset = 0) {
        write(std::as_bytes(std::span<const T>(&value, 1)), offset);
    }

    /// The whole content, after all that the GPU was told so far; waits for it. A remainder smaller than a T
    /// is left out. For tests and reports.
    template <Plain T>
    [[nodiscard]] std::vector<T> download() const {
        std::vector<T> content(static_cast<std::size_t>(bytes() / sizeof(T)));
        read(std::as_writable_bytes(std::span<T>(content)));
        return content;
    }

    /// Binds the whole buffer to an indexed target: GL_SHADER_STORAGE_BUFFER or GL_UNIFORM_BUFFER.
    void bind_base(GLenum target, GLuint index) const;

 private:
    void write(std::span<const std::byte> data, std::uint64_t offset);
    void read(std::span<std::byte> data) const;
};

/// How shaders filter a texture.
struct SamplerDesc {
    GLint min_filter = GL_LINEAR;
    GLint mag_filter = GL_LINEAR;
    GLint wrap_u = GL_CLAMP_TO_EDGE;
    GLint wrap_v = GL_CLAMP_TO_EDGE;
    GLint compare =
        GL_NONE;  ///< comparison of a depth texture against the reference, GL_LEQUAL, ...; GL_NONE: none
    float anisotropy = 1.0F;  ///< capped by what the driver offers
    bool operator==(const SamplerDesc&) const = default;
};

class Sampler : public Object {
 public:
    Sampler() = default;
    Sampler(Device& device, std::string_view label, const SamplerDesc& desc);
    void bind(GLuint unit) const;
};

/// Attachments to draw into. Holds no textures: they outlive its use.
class Framebuffer : public Object {
 public:
    Framebuffer() = default;
    Framebuffer(Device& device, std::string_view label);

    /// Whole textures (all layers of arrays, for layered drawing). Texture 0 detaches.
    void attach_colour(std::uint32_t index, GLuint texture, std::uint32_t level = 0);
    void attach_depth(GLuint texture, std::uint32_t level = 0);
    /// Single layers; for cube arrays, faces.
    void attach_colour_layer(std::uint32_t index, GLuint texture, std::uint32_t layer,
                             std::uint32_t level = 0);
    void attach_depth_layer(GLuint texture, std::uint32_t layer, std::uint32_t level = 0);
    /// Draws into attachments 0 .. count - 1. 0: depth only.
    void draw_buffers(std::uint32_t count);

    /// Throws GlError that states why, unless the attachments can be drawn into.
    void check() const;
    /// Binds for drawing; the viewport is the caller's.
    void bind() const;
};

/// Where vertices come from. Holds no buffers: they outlive its use.
class VertexArray : public Object {
 public:
    VertexArray() = default;
    VertexArray(Device& device, std::string_view label);

    /// Buffer behind attributes of `binding`; `offset` and `stride` in bytes.
    void vertex_buffer(GLuint buffer, std::uint32_t stride, std::uint64_t offset = 0, GLuint binding = 0);
    void index_buffer(GLuint buffer);
    /// Enables an attribute of `components` values at `offset` bytes within a vertex, read as floats.
    void attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset, GLuint binding = 0);
    /// The same, read as integers.
    void integer_attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                           GLuint binding = 0);
    void bind() const;
};

/// A query object, of GL_TIMESTAMP, GL_SAMPLES_PASSED, ...
class Query : public Object {
 public:
    Query() = default;
    Query(Device& device, std::string_view label, GLenum target);
};

}  // namespace candela::gl
