#include <candela/graph/recording_backend.hpp>

#include <stdexcept>

#include <fmt/format.h>

namespace candela {

ObjectId RecordingBackend::create_texture(std::string_view name, const TextureDesc& desc) {
    return create({.name = std::string(name), .is_texture = true, .texture = desc});
}

ObjectId RecordingBackend::create_buffer(std::string_view name, const BufferDesc& desc) {
    return create({.name = std::string(name), .buffer = desc});
}

void RecordingBackend::destroy_texture(ObjectId texture) {
    destroy(texture, true);
}

void RecordingBackend::destroy_buffer(ObjectId buffer) {
    destroy(buffer, false);
}

void RecordingBackend::barrier(Barrier bits) {
    log.push_back("barrier " + to_string(bits));
}

void RecordingBackend::begin_pass(std::string_view name, std::uint32_t /*index*/, const PassTargets* given) {
    log.push_back("begin " + std::string(name));
    targets = {};
    bound.clear();
    if (given != nullptr) {
        targets = {
            {given->colour.begin(), given->colour.end()}, given->depth, given->size, given->writes_depth};
    }
    ++open_passes;
}

void RecordingBackend::end_pass() {
    log.emplace_back("end");
    --open_passes;
}

void RecordingBackend::bind_texture(ObjectId texture, const TextureDesc& /*desc*/, Binding binding) {
    bind(texture, true, binding);
}

void RecordingBackend::bind_buffer(ObjectId buffer, Binding binding) {
    bind(buffer, false, binding);
}

std::uint64_t RecordingBackend::texture_digest(ObjectId texture) {
    return digest(texture, true);
}

std::uint64_t RecordingBackend::buffer_digest(ObjectId buffer) {
    return digest(buffer, false);
}

ObjectId RecordingBackend::create(Object object) {
    if (creations_left == 0) throw std::runtime_error("out of memory");
    --creations_left;
    ++created;
    objects.emplace(next_, std::move(object));
    return next_++;
}

void RecordingBackend::destroy(ObjectId id, bool is_texture) {
    const auto found = objects.find(id);
    if (found == objects.end() || found->second.is_texture != is_texture) {
        misuse = fmt::format("object {} is destroyed, but is none", id);
        return;
    }
    objects.erase(found);
}

void RecordingBackend::bind(ObjectId id, bool is_texture, Binding binding) {
    const auto found = objects.find(id);
    if (found != objects.end() && found->second.is_texture != is_texture) {
        misuse = fmt::format("object {} is bound as what it is not", id);
    }
    if (open_passes == 0) misuse = fmt::format("object {} is bound outside of a pass", id);
    bound.emplace_back(id, binding);
}

std::uint64_t RecordingBackend::digest(ObjectId id, bool is_texture) {
    ++digests;
    const auto found = objects.find(id);
    if (found == objects.end() || found->second.is_texture != is_texture) {
        misuse = fmt::format("object {} is read back, but is none", id);
        return 0;
    }
    return found->second.content;
}

}  // namespace candela
