#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/graph/backend.hpp>

namespace candela {

/// A back end without a graphics API, for tests of a host's graphs, and for graphs whose passes only change
/// the world. It records what the graph asks for, and gives each object a number as its content, which passes
/// write and read instead of texels.
class CANDELA_API RecordingBackend final : public Backend {
 public:
    struct Object {
        std::string name{};
        bool is_texture = false;
        TextureDesc texture{};      ///< of a texture
        BufferDesc buffer{};        ///< of a buffer
        std::uint64_t content = 0;  ///< also its digest
    };

    struct Targets {
        std::vector<ObjectId> colour{};
        ObjectId depth = 0;
        glm::uvec2 size{0};
        bool writes_depth = false;
    };

    [[nodiscard]] ObjectId create_texture(std::string_view name, const TextureDesc& desc) override;
    [[nodiscard]] ObjectId create_buffer(std::string_view name, const BufferDesc& desc) override;
    void destroy_texture(ObjectId texture) override;
    void destroy_buffer(ObjectId buffer) override;
    void barrier(Barrier bits) override;
    void begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) override;
    void end_pass() override;
    void bind_texture(ObjectId texture, const TextureDesc& desc, Binding binding) override;
    void bind_buffer(ObjectId buffer, Binding binding) override;
    [[nodiscard]] std::uint64_t texture_digest(ObjectId texture) override;
    [[nodiscard]] std::uint64_t buffer_digest(ObjectId buffer) override;

    std::map<ObjectId, Object> objects{};               ///< those that have been created and not destroyed
    std::vector<std::string> log{};                     ///< "begin NAME" and "end" of passes, "barrier BITS"
    Targets targets{};                                  ///< of the last pass
    std::vector<std::pair<ObjectId, Binding>> bound{};  ///< by the last pass
    std::size_t created = 0;                            ///< number of objects so far
    /// Number of objects until creating one throws std::runtime_error.
    std::size_t creations_left = std::numeric_limits<std::size_t>::max();
    int open_passes = 0;
    std::size_t digests = 0;  ///< number of digests that were asked for
    std::string misuse{};     ///< what the graph did wrong last; empty if nothing

 private:
    ObjectId create(Object object);
    void destroy(ObjectId id, bool is_texture);
    void bind(ObjectId id, bool is_texture, Binding binding);
    std::uint64_t digest(ObjectId id, bool is_texture);

    ObjectId next_ = 1;
};

}  // namespace candela
