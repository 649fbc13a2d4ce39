#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <candela/graph/backend.hpp>

namespace candela {

/// A backend without a GPU. Records calls, tracks live objects, and gives every object a content: a number
/// that tests write and read instead of texels.
class RecordingBackend final : public Backend {
 public:
    struct Object {
        std::string name;
        bool texture = false;
        TextureDesc texture_desc;
        BufferDesc buffer_desc;
        std::uint64_t content = 0;
    };

    struct Targets {
        std::vector<ObjectId> colour;
        ObjectId depth = 0;
        glm::uvec2 size{0};
        bool writes_depth = false;
    };

    ObjectId create_texture(std::string_view name, const TextureDesc& desc) override {
        return create({std::string(name), true, desc, {}});
    }
    ObjectId create_buffer(std::string_view name, const BufferDesc& desc) override {
        return create({std::string(name), false, {}, desc});
    }
    void destroy_texture(ObjectId texture) override { destroy(texture, true); }
    void destroy_buffer(ObjectId buffer) override { destroy(buffer, false); }
    void barrier(Barrier bits) override { log.push_back("barrier " + to_string(bits)); }

    void begin_pass(std::string_view name, std::uint32_t, const PassTargets* given) override {
        log.push_back("begin " + std::string(name));
        targets = {};
        bound.clear();
        if (given) {
            targets = {
                {given->colour.begin(), given->colour.end()}, given->depth, given->size, given->writes_depth};
        }
        ++open_passes;
    }
    void end_pass() override {
        log.push_back("end");
        --open_passes;
    }
    void bind_texture(ObjectId texture, const TextureDesc&, Binding binding) override {
        bind(texture, true, binding);
    }
    void bind_buffer(ObjectId buffer, Binding binding) override { bind(buffer, false, binding); }
    std::uint64_t texture_digest(ObjectId texture) override { return digest(texture, true); }
    std::uint64_t buffer_digest(ObjectId buffer) override { return digest(buffer, false); }

    std::map<ObjectId, Object> objects;
    std::vector<std::string> log;                     // barriers and passes
    Targets targets;                                  // of the last pass
    std::vector<std::pair<ObjectId, Binding>> bound;  // of the last pass
    std::size_t created = 0;
    std::size_t creations_left = static_cast<std::size_t>(-1);  // until a creation fails
    int open_passes = 0;
    std::size_t digests = 0;  // how many were requested
    std::string misuse;       // what the graph did wrong, if anything

 private:
    ObjectId create(Object object) {
        if (creations_left == 0) throw std::runtime_error("out of memory");
        --creations_left;
        ++created;
        objects.emplace(next_, std::move(object));
        return next_++;
    }

    std::uint64_t digest(ObjectId id, bool texture) {
        ++digests;
        const auto found = objects.find(id);
        if (found == objects.end() || found->second.texture != texture) {
            misuse = fmt::format("object {} is read back, but is none", id);
            return 0;
        }
        return found->second.content;
    }

    void bind(ObjectId id, bool texture, Binding binding) {
        const auto found = objects.find(id);
        if (found != objects.end() && found->second.texture != texture) {
            misuse = fmt::format("object {} is bound as what it is not", id);
        }
        if (open_passes == 0) misuse = fmt::format("object {} is bound outside of a pass", id);
        bound.emplace_back(id, binding);
    }

    void destroy(ObjectId id, bool texture) {
        const auto found = objects.find(id);
        if (found == objects.end() || found->second.texture != texture) {
            misuse = fmt::format("object {} is destroyed, but is none", id);
            return;
        }
        objects.erase(found);
    }

    ObjectId next_ = 1;
};

}  // namespace candela
