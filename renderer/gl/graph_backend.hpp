#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <candela/graph/backend.hpp>
#include "renderer/gl/device.hpp"
#include "renderer/gl/objects.hpp"
#include "renderer/gl/texture.hpp"
#include "renderer/gl/timer.hpp"

namespace candela::gl {

/// Implements the frame graph's back end in OpenGL. An ObjectId is the object's GL name. Before each pass it
/// binds the pass's attachments, sets the viewport to their size, and sets the default RasterState. After
/// passes of the host's, it sets the state that others assume.
class GraphBackend final : public Backend {
 public:
    /// The device must outlive the back end.
    explicit GraphBackend(Device& device);

    ObjectId create_texture(std::string_view name, const TextureDesc& desc) override;
    ObjectId create_buffer(std::string_view name, const BufferDesc& desc) override;
    void destroy_texture(ObjectId texture) override;
    void destroy_buffer(ObjectId buffer) override;
    void barrier(Barrier bits) override;
    void begin_pass(std::string_view name, std::uint32_t index, const PassTargets* targets) override;
    void end_pass() override;
    void bind_texture(ObjectId texture, const TextureDesc& desc, Binding binding) override;
    void bind_buffer(ObjectId buffer, Binding binding) override;
    std::uint64_t texture_digest(ObjectId texture) override;
    std::uint64_t buffer_digest(ObjectId buffer) override;

    /// Names of the passes that the host has written, which may leave any state behind.
    void set_host_passes(std::set<std::string, std::less<>> names) { host_passes_ = std::move(names); }
    /// All passes are the host's, which may also change the state between frames.
    void expect_any_state() { host_passes_.reset(); }

    /// Whether new objects are cleared. Without that, what no pass writes is undefined, and digests may
    /// differ.
    void clear_new(bool on) { clears_new_ = on; }

    /// GPU times of passes. The owner calls the timer's begin_frame and end_frame around each frame.
    [[nodiscard]] Timer& timer() { return timer_; }

    /// For reports and tests: the object of an id that this back end returned. Throws std::out_of_range for
    /// other ids.
    [[nodiscard]] const Buffer& buffer(ObjectId id) const { return buffers_.at(id).buffer; }
    [[nodiscard]] const Texture& texture(ObjectId id) const { return textures_.at(id); }

 private:
    /// GL names of the attachments: the colours, then depth (0: none).
    using Attachments = std::vector<ObjectId>;
    struct GraphBuffer {
        std::string name;
        Buffer buffer;
        BufferTexels texels{};  ///< made when they are first bound
    };
    void bind_targets(const PassTargets& targets);

    Device* device_;
    Timer timer_;
    bool in_debug_group_ = false;  // the running pass has pushed its group
    bool in_host_pass_ = false;
    bool clears_new_ = false;
    std::optional<std::set<std::string, std::less<>>> host_passes_{std::in_place};  // none: all
    std::unordered_map<ObjectId, Texture> textures_;
    std::unordered_map<ObjectId, GraphBuffer> buffers_;
    std::map<Attachments, Framebuffer> framebuffers_;
    Framebuffer* targets_ = nullptr;  // of the running pass; null without attachments
    std::uint32_t drawn_colours_ = 0;
};

/// The bits of glMemoryBarrier for a barrier of the frame graph.
[[nodiscard]] GLbitfield barrier_bits(Barrier barrier);

}  // namespace candela::gl
