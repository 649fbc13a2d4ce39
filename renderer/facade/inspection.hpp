#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/renderer.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// What the last frame shows of the inspected resource.
struct InspectionResult {
    /// GL name of a flat texture of rgba8 with colours for the display, the bottom row first. 0: there is no
    /// picture, and `description` tells why. It belongs to the renderer, which may change or delete it in its
    /// next call; it may be read, not written.
    std::uint32_t texture = 0;
    glm::uvec2 size{0};                    ///< pixels of the picture
    std::string description;               ///< format, size, mips and layers of the resource
    std::string_view unit;                 ///< of the values: "m", "lights", or empty
    Mapping mapping = Mapping::automatic;  ///< the one that was used
    float low = 0.0F;                      ///< the range that was used
    float high = 0.0F;
    std::uint32_t mips = 0;    ///< that can be chosen; 0 without a picture
    std::uint32_t layers = 0;  ///< layers, faces or slices that can be chosen
};

/// Elements of a buffer.
struct BufferElements {
    std::vector<std::byte> bytes;  ///< of the elements that were read
    std::uint32_t stride = 1;      ///< bytes of an element
    std::uint64_t count = 0;       ///< elements that the buffer has room for
};

/// Shows one resource of a renderer's frame graph at a time, by an extension named "inspect". It does not
/// change the picture; only a frame budget counts the time of its passes. They run when the resource or what
/// is wanted of it has changed. To be used like the renderer: in its context, not synchronised. The renderer
/// must outlive it; `show({})` before its end removes the passes.
class ResourceInspector {
 public:
    explicit ResourceInspector(Renderer& renderer);

    /// What to show from the next frame on, in any configuration that has the resource; none: nothing.
    /// Another resource means a new frame graph; anything else of an inspection is cheap to change. Returns
    /// errors like Renderer::extend; then all stays as it was.
    [[nodiscard]] std::vector<std::string> show(std::optional<Inspection> wanted);
    [[nodiscard]] const std::optional<Inspection>& shown() const { return shown_; }

    /// What the last frame shows. An automatic range is read back after frames in which it was found again;
    /// this waits for the GPU.
    [[nodiscard]] InspectionResult result() const;

    /// Reads elements of the resource back if it is a buffer, `most` of them from number `first` on, or fewer
    /// where it ends; waits for the GPU. Empty before the next frame and without a buffer.
    [[nodiscard]] BufferElements read_buffer(std::uint64_t first, std::uint64_t most) const;

 private:
    struct State;
    [[nodiscard]] bool has_run() const;

    Renderer* renderer_;
    std::optional<Inspection> shown_;
    std::shared_ptr<State> state_;  // shared with the passes
};

/// The colour of a heat map at a value from 0 (low end of the range) to 1 (high end), sRGB-encoded.
[[nodiscard]] glm::vec3 heat_colour(float at);

}  // namespace candela
