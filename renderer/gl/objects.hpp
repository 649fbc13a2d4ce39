#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <glm/vec2.hpp>

#include "renderer/gl/device.hpp"

namespace candela::gl {

/// Owns one GL object: can be moved, not copied, and deletes the object in its destructor. A
/// default-constructed or moved-from instance is empty and has name 0. The device must outlive it.
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
    /// Size of the requested storage in bytes; 0 for kinds of objects without storage.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 protected:
    /// Takes ownership of `name` and sets `label` as its debug label. Throws GlError if `name` is 0.
    Object(Device& device, ObjectKind kind, GLuint name, std::string_view label);
    [[nodiscard]] const Functions& gl() const { return device_->gl(); }
    [[nodiscard]] const Device& device() const { return *device_; }
    /// Records the size of the storage in the device's counts.
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

/// Arrays, vectors and spans of such types.
template <class R>
concept PlainRange = std::ranges::contiguous_range<R> && Plain<std::ranges::range_value_t<R>>;

/// Reads bytes of the buffer named `buffer` back, from `offset` on, after all GPU commands issued so far;
/// waits for the GPU.
void read_buffer(const Functions& gl, GLuint buffer, std::span<std::byte> data, std::uint64_t offset = 0);

/// A buffer of fixed size that the CPU can upload to, for vertices, indices, uniforms, storage or indirect
/// arguments.
class Buffer : public Object {
 public:
    Buffer() = default;
    /// `size` bytes with undefined content. A buffer of size 0 can still be bound. Throws GlError if there is
    /// not enough memory.
    Buffer(Device& device, std::string_view label, std::uint64_t size);
    /// A buffer filled with a copy of `data`.
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

    /// Reads back the first `count` elements, which the buffer must have, after all GPU commands issued so
    /// far; waits for the GPU. For tests and reports.
    template <Plain T>
    [[nodiscard]] std::vector<T> download(std::size_t count) const {
        std::vector<T> content(count);
        if (count > 0) read_buffer(gl(), name(), std::as_writable_bytes(std::span<T>(content)));
        return content;
    }
    /// The whole content. A remainder smaller than one T is left out.
    template <Plain T>
    [[nodiscard]] std::vector<T> download() const {
        return download<T>(static_cast<std::size_t>(bytes() / sizeof(T)));
    }

    /// Binds the whole buffer to an indexed target: GL_SHADER_STORAGE_BUFFER or GL_UNIFORM_BUFFER.
    void bind_base(GLenum target, GLuint index) const;

 private:
    void write(std::span<const std::byte> data, std::uint64_t offset);
};

/// A buffer as shaders fetch it from a texture unit (usamplerBuffer): texels of four 32-bit words each.
/// Drivers without branches, such as llvmpipe, fetch texels faster than the elements of storage blocks where
/// the invocations of a group read different ones.
class BufferTexels : public Object {
 public:
    BufferTexels() = default;
    /// The buffer must outlive it. Throws MemoryError if it has more texels than shaders can fetch.
    BufferTexels(Device& device, std::string_view label, const Buffer& buffer);
};

/// How shaders filter a texture.
struct SamplerDesc {
    GLint min_filter = GL_LINEAR;
    GLint mag_filter = GL_LINEAR;
    GLint wrap_u = GL_CLAMP_TO_EDGE;
    GLint wrap_v = GL_CLAMP_TO_EDGE;
    float anisotropy = 1.0F;           ///< clamped to the driver's limit
    std::uint32_t last_level = 1000U;  ///< mip levels beyond it are not used
    bool operator==(const SamplerDesc&) const = default;
};

class Sampler : public Object {
 public:
    Sampler() = default;
    Sampler(Device& device, std::string_view label, const SamplerDesc& desc);
    void bind(GLuint unit) const;
};

/// A framebuffer. It does not own its textures: they must stay alive while it is used.
class Framebuffer : public Object {
 public:
    Framebuffer() = default;
    Framebuffer(Device& device, std::string_view label);

    /// Attaches a whole texture level, with all layers of arrays for layered rendering. Texture 0 detaches.
    void attach_colour(std::uint32_t index, GLuint texture, std::uint32_t level = 0);
    void attach_depth(GLuint texture, std::uint32_t level = 0);
    /// Attaches a single layer; for cube arrays a face.
    void attach_colour_layer(std::uint32_t index, GLuint texture, std::uint32_t layer,
                             std::uint32_t level = 0);
    void attach_depth_layer(GLuint texture, std::uint32_t layer, std::uint32_t level = 0);
    /// Sets attachments 0 .. count - 1 as draw buffers. 0: depth only.
    void draw_buffers(std::uint32_t count);

    /// Throws GlError with the reason if the framebuffer is incomplete.
    void check() const;
    /// Binds it for drawing. Does not change the viewport.
    void bind() const;
};

/// Throws GlError if there is no such framebuffer or if it is incomplete, with the reason. `called` names it
/// in the message. 0 is the default framebuffer.
void require_complete(const Functions& gl, GLuint framebuffer, std::string_view called);

/// What a framebuffer of the host's draws its first colour into.
struct DrawnAttachment {
    bool holds_integers = false;
    glm::uvec2 size{0};  ///< pixels
};
/// None if colour goes nowhere. Not for the default framebuffer, of which GL does not tell the size.
[[nodiscard]] std::optional<DrawnAttachment> drawn_attachment(const Functions& gl, GLuint framebuffer);

/// A vertex array. It does not own its buffers: they must stay alive while it is used.
class VertexArray : public Object {
 public:
    VertexArray() = default;
    VertexArray(Device& device, std::string_view label);

    /// Sets the buffer of vertex binding `binding`; `offset` and `stride` in bytes.
    void vertex_buffer(GLuint buffer, std::uint32_t stride, std::uint64_t offset = 0, GLuint binding = 0);
    void index_buffer(GLuint buffer);
    /// Enables an attribute of `components` values at `offset` bytes within a vertex, converted to float
    /// without normalisation.
    void attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset, GLuint binding = 0);
    /// The same, normalised: the largest value of the type becomes 1.
    void normalized_attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                              GLuint binding = 0);
    /// The same for integer attributes, without conversion.
    void integer_attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                           GLuint binding = 0);
    void bind() const;
};

/// A query object; `target` is GL_TIMESTAMP, GL_SAMPLES_PASSED, ...
class Query : public Object {
 public:
    Query() = default;
    Query(Device& device, std::string_view label, GLenum target);
};

}  // namespace candela::gl
