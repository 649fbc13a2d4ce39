#pragma once

#include <map>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/graph/backend.hpp"
#include "renderer/gl/device.hpp"
#include "renderer/gl/objects.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gl/timer.hpp"

namespace candela::gl {

/// Gives the resources of a frame graph their GL objects; an ObjectId is the object's GL name. Before each
/// pass it binds the pass's attachments and puts the state that passes change back to what they start from:
/// no depth test (where a pass turns it on, the greater of the reversed depths wins), no culling, no
/// blending, depth and colour written, viewport of the attachments.
class GraphBackend final : public Backend {
 public:
    /// The device outlives the back end.
    explicit GraphBackend(Device& device) : device_(&device), timer_(device) {}

    ObjectId create_texture(std::string_view name, const TextureDesc& desc) override;
    ObjectId create_buffer(std::string_view name, const BufferDesc& desc) override;
    void destroy_texture(ObjectId texture) override;
    void destroy_buffer(ObjectId buffer) override;
    void barrier(Barrier bits) override;
    void begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) override;
    void end_pass() override;
    std::uint64_t texture_digest(ObjectId texture) override;
    std::uint64_t buffer_digest(ObjectId buffer) override;

    /// GPU times of the passes between `begin_frame` and `end_frame` of its frames.
    [[nodiscard]] Timer& timer() { return timer_; }

    /// For reports and tests: what stands behind an id that this back end gave out.
    [[nodiscard]] const Buffer& buffer(ObjectId id) const { return buffers_.at(id); }
    [[nodiscard]] const Texture& texture(ObjectId id) const { return textures_.at(id); }

 private:
    /// The attachments' names: the colours, then the depth (0: none).
    using Attachments = std::vector<ObjectId>;
    void bind_targets(const PassTargets& targets);

    Device* device_;
    Timer timer_;
    std::unordered_map<ObjectId, Texture> textures_;
    std::unordered_map<ObjectId, Buffer> buffers_;
    std::map<Attachments, Framebuffer> framebuffers_;
};

/// The glMemoryBarrier bits of a planned barrier.
[[nodiscard]] GLbitfield barrier_bits(Barrier barrier);

}  // namespace candela::gl
