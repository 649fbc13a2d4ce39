#include "renderer/gl/objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace candela::gl {
namespace {

using Create = void(APIENTRY*)(GLsizei, GLuint*);

GLuint create(Create create_names) {
    GLuint name = 0;
    create_names(1, &name);
    return name;
}

template <class CreateTyped>
GLuint create(CreateTyped create_names, GLenum target) {
    GLuint name = 0;
    create_names(target, 1, &name);
    return name;
}

GLenum label_namespace(ObjectKind kind) {
    switch (kind) {
        case ObjectKind::buffer:
            return GL_BUFFER;
        case ObjectKind::texture:
            return GL_TEXTURE;
        case ObjectKind::framebuffer:
            return GL_FRAMEBUFFER;
        case ObjectKind::vertex_array:
            return GL_VERTEX_ARRAY;
        case ObjectKind::sampler:
            return GL_SAMPLER;
        case ObjectKind::query:
            return GL_QUERY;
        case ObjectKind::program:
            return GL_PROGRAM;
    }
    return GL_NONE;
}

void delete_object(const Functions& gl, ObjectKind kind, GLuint name) {
    switch (kind) {
        case ObjectKind::buffer:
            return gl.DeleteBuffers(1, &name);
        case ObjectKind::texture:
            return gl.DeleteTextures(1, &name);
        case ObjectKind::framebuffer:
            return gl.DeleteFramebuffers(1, &name);
        case ObjectKind::vertex_array:
            return gl.DeleteVertexArrays(1, &name);
        case ObjectKind::sampler:
            return gl.DeleteSamplers(1, &name);
        case ObjectKind::query:
            return gl.DeleteQueries(1, &name);
        case ObjectKind::program:
            return gl.DeleteProgram(name);
    }
}

std::string_view framebuffer_status(GLenum status) {
    switch (status) {
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            return "an attachment cannot be drawn into";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "there is no attachment";
        case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
            return "a draw buffer has no attachment";
        case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
            return "layered and flat attachments are mixed";
        case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
            return "attachments differ in samples";
        case GL_FRAMEBUFFER_UNDEFINED:
            return "the context has no default framebuffer";
        case GL_FRAMEBUFFER_UNSUPPORTED:
            return "the driver does not support this combination of formats";
        default:
            return "its state cannot be had";
    }
}

}  // namespace

Object::Object(Device& device, ObjectKind kind, GLuint name, std::string_view label)
    : device_(&device), kind_(kind), name_(name) {
    if (name == 0) throw GlError(fmt::format("the driver gives no object for \"{}\"", label));
    ++device.live_.objects[static_cast<std::size_t>(kind)];
    const std::string_view shown = label.substr(0, 255);  // the longest label that every driver accepts
    gl().ObjectLabel(label_namespace(kind), name, static_cast<GLsizei>(shown.size()), shown.data());
}

Object::Object(Object&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      kind_(other.kind_),
      name_(std::exchange(other.name_, 0)),
      bytes_(std::exchange(other.bytes_, 0)) {}

Object& Object::operator=(Object&& other) noexcept {
    if (this == &other) return *this;
    release();
    device_ = std::exchange(other.device_, nullptr);
    kind_ = other.kind_;
    name_ = std::exchange(other.name_, 0);
    bytes_ = std::exchange(other.bytes_, 0);
    return *this;
}

Object::~Object() {
    release();
}

void Object::set_bytes(std::uint64_t bytes) {
    ObjectCounts& live = device_->live_;
    std::uint64_t& total = kind_ == ObjectKind::texture ? live.texture_bytes : live.buffer_bytes;
    total += bytes - bytes_;
    bytes_ = bytes;
}

void Object::release() noexcept {
    if (!device_) return;
    set_bytes(0);
    --device_->live_.objects[static_cast<std::size_t>(kind_)];
    delete_object(gl(), kind_, name_);
    device_ = nullptr;
    name_ = 0;
}

Buffer::Buffer(Device& device, std::string_view label, std::uint64_t size)
    : Object(device, ObjectKind::buffer, create(device.gl().CreateBuffers), label) {
    const auto fail = [&] {
        throw MemoryError(fmt::format("buffer \"{}\": no memory for {} bytes", label, size));
    };
    if (size > static_cast<std::uint64_t>(PTRDIFF_MAX)) fail();
    // OpenGL does not allow storage of size 0.
    const auto stored = static_cast<GLsizeiptr>(std::max<std::uint64_t>(size, 4));
    gl().NamedBufferStorage(name(), stored, nullptr, GL_DYNAMIC_STORAGE_BIT);
    // Not glGetError: it would also return, and clear, an error of the host.
    GLint64 offered = 0;
    gl().GetNamedBufferParameteri64v(name(), GL_BUFFER_SIZE, &offered);
    if (offered != stored) fail();
    set_bytes(size);
}

BufferTexels::BufferTexels(Device& device, std::string_view label, const Buffer& buffer)
    : Object(device, ObjectKind::texture, create(device.gl().CreateTextures, GL_TEXTURE_BUFFER), label) {
    constexpr std::uint64_t bytes_a_texel = 16;
    const std::uint64_t texels = buffer.bytes() / bytes_a_texel;
    if (texels > device.limits().buffer_texels) {
        throw MemoryError(fmt::format("buffer \"{}\": {} texels, of which shaders of this driver reach {}",
                                      label, texels, device.limits().buffer_texels));
    }
    gl().TextureBuffer(name(), GL_RGBA32UI, buffer.name());
}

void Buffer::bind_base(GLenum target, GLuint index) const {
    gl().BindBufferBase(target, index, name());
}

void Buffer::write(std::span<const std::byte> data, std::uint64_t offset) {
    if (offset > bytes() || data.size() > bytes() - offset) {
        throw GlError(fmt::format("an upload of {} bytes at {} does not fit a buffer of {} bytes",
                                  data.size(), offset, bytes()));
    }
    gl().NamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()),
                            data.data());
}

void read_buffer(const Functions& gl, GLuint buffer, std::span<std::byte> data, std::uint64_t offset) {
    if (data.empty()) return;
    const auto size = static_cast<GLsizeiptr>(data.size());
    // Drivers of GPUs move a buffer that the host reads to the host's memory, where shaders are slow to read
    // it.
    const GLuint copy = create(gl.CreateBuffers);
    gl.NamedBufferStorage(copy, size, nullptr, GL_CLIENT_STORAGE_BIT);
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl.CopyNamedBufferSubData(buffer, copy, static_cast<GLintptr>(offset), 0, size);
    gl.GetNamedBufferSubData(copy, 0, size, data.data());
    gl.DeleteBuffers(1, &copy);
}

Sampler::Sampler(Device& device, std::string_view label, const SamplerDesc& desc)
    : Object(device, ObjectKind::sampler, create(device.gl().CreateSamplers), label) {
    const std::array parameters = {
        std::pair{GL_TEXTURE_MIN_FILTER, desc.min_filter},
        std::pair{GL_TEXTURE_MAG_FILTER, desc.mag_filter},
        std::pair{GL_TEXTURE_WRAP_S, desc.wrap_u},
        std::pair{GL_TEXTURE_WRAP_T, desc.wrap_v},
        std::pair{GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE},
        std::pair{GL_TEXTURE_MAX_LOD, static_cast<GLint>(desc.last_level)},
    };
    for (const auto& [parameter, value] : parameters) {
        gl().SamplerParameteri(name(), static_cast<GLenum>(parameter), value);
    }
    const float anisotropy = std::min(desc.anisotropy, device.limits().anisotropy);
    if (anisotropy > 1.0F) gl().SamplerParameterf(name(), GL_TEXTURE_MAX_ANISOTROPY, anisotropy);
}

void Sampler::bind(GLuint unit) const {
    gl().BindSampler(unit, name());
}

Framebuffer::Framebuffer(Device& device, std::string_view label)
    : Object(device, ObjectKind::framebuffer, create(device.gl().CreateFramebuffers), label) {}

void Framebuffer::attach_colour(std::uint32_t index, GLuint texture, std::uint32_t level) {
    gl().NamedFramebufferTexture(name(), GL_COLOR_ATTACHMENT0 + index, texture, static_cast<GLint>(level));
}

void Framebuffer::attach_depth(GLuint texture, std::uint32_t level) {
    gl().NamedFramebufferTexture(name(), GL_DEPTH_ATTACHMENT, texture, static_cast<GLint>(level));
}

void Framebuffer::attach_colour_layer(std::uint32_t index, GLuint texture, std::uint32_t layer,
                                      std::uint32_t level) {
    gl().NamedFramebufferTextureLayer(name(), GL_COLOR_ATTACHMENT0 + index, texture,
                                      static_cast<GLint>(level), static_cast<GLint>(layer));
}

void Framebuffer::attach_depth_layer(GLuint texture, std::uint32_t layer, std::uint32_t level) {
    gl().NamedFramebufferTextureLayer(name(), GL_DEPTH_ATTACHMENT, texture, static_cast<GLint>(level),
                                      static_cast<GLint>(layer));
}

void Framebuffer::draw_buffers(std::uint32_t count) {
    std::vector<GLenum> buffers(count);
    for (std::uint32_t i = 0; i < count; ++i) buffers[i] = GL_COLOR_ATTACHMENT0 + i;
    if (count == 0) buffers.push_back(GL_NONE);
    gl().NamedFramebufferDrawBuffers(name(), static_cast<GLsizei>(buffers.size()), buffers.data());
}

void Framebuffer::check() const {
    std::array<char, 256> label{};
    gl().GetObjectLabel(GL_FRAMEBUFFER, name(), static_cast<GLsizei>(label.size()), nullptr, label.data());
    require_complete(gl(), name(), fmt::format("framebuffer \"{}\"", label.data()));
}

void require_complete(const Functions& gl, GLuint framebuffer, std::string_view called) {
    if (framebuffer != 0 && gl.IsFramebuffer(framebuffer) != GL_TRUE) {
        throw GlError(fmt::format("{} does not exist", called));
    }
    const GLenum status = gl.CheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw GlError(fmt::format("{} is incomplete: {}", called, framebuffer_status(status)));
    }
}

namespace {

/// The first draw buffer of a framebuffer. GL tells that only of the bound one.
GLenum first_draw_buffer(const Functions& gl, GLuint framebuffer) {
    GLint bound = 0;
    GLint buffer = 0;
    gl.GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gl.GetIntegerv(GL_DRAW_BUFFER0, &buffer);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(bound));
    return static_cast<GLenum>(buffer);
}

}  // namespace

std::optional<DrawnAttachment> drawn_attachment(const Functions& gl, GLuint framebuffer) {
    const GLenum buffer = first_draw_buffer(gl, framebuffer);
    if (buffer == GL_NONE) return std::nullopt;
    const auto parameter = [&](GLenum what) {
        GLint value = 0;
        gl.GetNamedFramebufferAttachmentParameteriv(framebuffer, buffer, what, &value);
        return value;
    };
    const GLint kind = parameter(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    if (kind == GL_NONE) return std::nullopt;
    const auto object = static_cast<GLuint>(parameter(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
    glm::ivec2 size(0);
    if (kind == GL_RENDERBUFFER) {
        gl.GetNamedRenderbufferParameteriv(object, GL_RENDERBUFFER_WIDTH, &size.x);
        gl.GetNamedRenderbufferParameteriv(object, GL_RENDERBUFFER_HEIGHT, &size.y);
    } else {
        const GLint level = parameter(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
        gl.GetTextureLevelParameteriv(object, level, GL_TEXTURE_WIDTH, &size.x);
        gl.GetTextureLevelParameteriv(object, level, GL_TEXTURE_HEIGHT, &size.y);
    }
    const GLint type = parameter(GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
    return DrawnAttachment{type == GL_INT || type == GL_UNSIGNED_INT, glm::uvec2(size)};
}

void Framebuffer::bind() const {
    gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, name());
}

VertexArray::VertexArray(Device& device, std::string_view label)
    : Object(device, ObjectKind::vertex_array, create(device.gl().CreateVertexArrays), label) {}

void VertexArray::vertex_buffer(GLuint buffer, std::uint32_t stride, std::uint64_t offset, GLuint binding) {
    gl().VertexArrayVertexBuffer(name(), binding, buffer, static_cast<GLintptr>(offset),
                                 static_cast<GLsizei>(stride));
}

void VertexArray::index_buffer(GLuint buffer) {
    gl().VertexArrayElementBuffer(name(), buffer);
}

void VertexArray::attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                            GLuint binding) {
    gl().EnableVertexArrayAttrib(name(), index);
    gl().VertexArrayAttribFormat(name(), index, components, type, GL_FALSE, offset);
    gl().VertexArrayAttribBinding(name(), index, binding);
}

void VertexArray::normalized_attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                                       GLuint binding) {
    gl().EnableVertexArrayAttrib(name(), index);
    gl().VertexArrayAttribFormat(name(), index, components, type, GL_TRUE, offset);
    gl().VertexArrayAttribBinding(name(), index, binding);
}

void VertexArray::integer_attribute(GLuint index, GLint components, GLenum type, std::uint32_t offset,
                                    GLuint binding) {
    gl().EnableVertexArrayAttrib(name(), index);
    gl().VertexArrayAttribIFormat(name(), index, components, type, offset);
    gl().VertexArrayAttribBinding(name(), index, binding);
}

void VertexArray::bind() const {
    gl().BindVertexArray(name());
}

Query::Query(Device& device, std::string_view label, GLenum target)
    : Object(device, ObjectKind::query, create(device.gl().CreateQueries, target), label) {}

}  // namespace candela::gl
