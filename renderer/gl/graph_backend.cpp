#include "renderer/gl/graph_backend.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "renderer/gl/host_state.hpp"

namespace candela::gl {
namespace {

constexpr std::uint64_t golden = 0x9e37'79b9'7f4a'7c15U;  // 2^64 divided by the golden ratio

std::uint64_t mix(std::uint64_t digest, std::uint64_t word) {
    digest = (digest ^ word) * golden;
    return digest ^ (digest >> 29U);
}

std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t digest) {
    std::uint64_t word = 0;
    while (bytes.size() >= sizeof(word)) {
        std::memcpy(&word, bytes.data(), sizeof(word));
        digest = mix(digest, word);
        bytes = bytes.subspan(sizeof(word));
    }
    for (const std::byte byte : bytes) {
        digest = mix(digest, std::to_integer<std::uint64_t>(byte));
    }
    return digest;
}

}  // namespace

GraphBackend::GraphBackend(Device& device) : device_(&device), timer_(device) {}

ObjectId GraphBackend::create_texture(std::string_view name, const TextureDesc& desc) {
    Texture texture(*device_, name, desc);
    const ObjectId id = texture.name();
    const FormatInfo info = format_info(desc.format);
    for (std::uint32_t level = 0; clears_new_ && level < desc.mips; ++level) {
        device_->gl().ClearTexImage(id, static_cast<GLint>(level), info.layout, info.type, nullptr);
    }
    textures_.emplace(id, std::move(texture));
    return id;
}

ObjectId GraphBackend::create_buffer(std::string_view name, const BufferDesc& desc) {
    Buffer buffer(*device_, name, desc.count * desc.stride);
    const ObjectId id = buffer.name();
    if (clears_new_) {
        device_->gl().ClearNamedBufferData(id, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    }
    buffers_.emplace(id, GraphBuffer{std::string(name), std::move(buffer)});
    return id;
}

void GraphBackend::destroy_texture(ObjectId texture) {
    // A framebuffer would keep the storage alive, and a later texture may get the same name.
    std::erase_if(framebuffers_,
                  [&](const auto& entry) { return std::ranges::count(entry.first, texture) > 0; });
    textures_.erase(texture);
}

void GraphBackend::destroy_buffer(ObjectId buffer) {
    buffers_.erase(buffer);
}

void GraphBackend::barrier(Barrier bits) {
    device_->gl().MemoryBarrier(barrier_bits(bits));
}

void GraphBackend::begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) {
    const Functions& gl = device_->gl();
    if (!host_passes_) set_assumed_state(gl);
    targets_ = nullptr;
    if (targets != nullptr) bind_targets(*targets);
    // The host may have used up the stack.
    GLint depth = 0;
    gl.GetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
    in_debug_group_ = depth < device_->limits().debug_groups;
    if (in_debug_group_) {
        gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, index, static_cast<GLsizei>(name.size()), name.data());
    }
    in_host_pass_ = !host_passes_ || host_passes_->contains(name);
    timer_.begin_pass(index);
    device_->reset_raster_state();
    if (targets != nullptr) device_->set_raster_state({.writes_depth = targets->writes_depth});
}

void GraphBackend::end_pass() {
    timer_.end_pass();
    if (in_debug_group_) device_->gl().PopDebugGroup();
    if (!in_host_pass_) return;
    set_assumed_state(device_->gl());
    if (targets_ != nullptr) targets_->draw_buffers(drawn_colours_);
}

void GraphBackend::bind_texture(ObjectId texture, const TextureDesc& desc, Binding binding) {
    const Functions& gl = device_->gl();
    if (binding.usage == Usage::storage) {
        const GLboolean layers = desc.shape == TextureShape::flat ? GL_FALSE : GL_TRUE;
        gl.BindImageTexture(binding.point, texture, 0, layers, 0, GL_READ_WRITE,
                            format_info(desc.format).internal);
        return;
    }
    gl.BindTextureUnit(binding.point, texture);
    gl.BindSampler(binding.point, 0);
}

void GraphBackend::bind_buffer(ObjectId buffer, Binding binding) {
    const Functions& gl = device_->gl();
    if (binding.usage == Usage::indirect) {
        gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer);
        gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
        return;
    }
    if (binding.usage == Usage::sampled) {
        GraphBuffer& read = buffers_.at(buffer);
        if (!read.texels) read.texels = BufferTexels(*device_, read.name, read.buffer);
        gl.BindTextureUnit(binding.point, read.texels.name());
        return;
    }
    const GLenum target = binding.usage == Usage::uniform ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER;
    gl.BindBufferBase(target, binding.point, buffer);
}

std::uint64_t GraphBackend::texture_digest(ObjectId texture) {
    const Texture& read = textures_.at(texture);
    std::uint64_t digest = golden;
    for (std::uint32_t level = 0; level < read.desc().mips; ++level) {
        for (std::uint32_t layer = 0; layer < read.desc().layers; ++layer) {
            digest = digest_of(read.read(level, layer), digest);
        }
    }
    return digest;
}

std::uint64_t GraphBackend::buffer_digest(ObjectId buffer) {
    return digest_of(buffers_.at(buffer).buffer.download<std::byte>(), golden);
}

void GraphBackend::bind_targets(const PassTargets& targets) {
    Attachments key(targets.colour.begin(), targets.colour.end());
    key.push_back(targets.depth);
    auto found = framebuffers_.find(key);
    if (found == framebuffers_.end()) {
        Framebuffer framebuffer(*device_, "pass targets");
        std::uint32_t index = 0;
        for (const ObjectId colour : targets.colour) {
            framebuffer.attach_colour(index++, colour);
        }
        if (targets.depth != 0) framebuffer.attach_depth(targets.depth);
        framebuffer.draw_buffers(index);
        framebuffer.check();
        found = framebuffers_.emplace(std::move(key), std::move(framebuffer)).first;
    }
    targets_ = &found->second;
    drawn_colours_ = static_cast<std::uint32_t>(targets.colour.size());
    targets_->bind();
    device_->gl().Viewport(0, 0, static_cast<GLsizei>(targets.size.x), static_cast<GLsizei>(targets.size.y));
}

GLbitfield barrier_bits(Barrier barrier) {
    static constexpr std::array<std::pair<Barrier, GLbitfield>, 10> table{
        {{Barrier::vertex_attrib, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT},
         {Barrier::element, GL_ELEMENT_ARRAY_BARRIER_BIT},
         {Barrier::uniform, GL_UNIFORM_BARRIER_BIT},
         {Barrier::texture_fetch, GL_TEXTURE_FETCH_BARRIER_BIT},
         {Barrier::image_access, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
         {Barrier::command, GL_COMMAND_BARRIER_BIT},
         {Barrier::texture_update, GL_TEXTURE_UPDATE_BARRIER_BIT},
         {Barrier::buffer_update, GL_BUFFER_UPDATE_BARRIER_BIT},
         {Barrier::framebuffer, GL_FRAMEBUFFER_BARRIER_BIT},
         {Barrier::storage, GL_SHADER_STORAGE_BARRIER_BIT}}};
    GLbitfield bits = 0;
    for (const auto& [planned, bit] : table) {
        if ((barrier & planned) != Barrier::none) bits |= bit;
    }
    return bits;
}

}  // namespace candela::gl
