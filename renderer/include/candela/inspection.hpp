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
#include <glm/vec4.hpp>

#include <candela/api.hpp>
#include <candela/view.hpp>

/// @file
/// For tools: what a renderer computes on the way to its picture, and how far two pictures are apart.

namespace candela {

class Renderer;

/// How values become colours.
enum class Mapping : std::uint8_t {
    /// Depth for depth formats; heat for other formats of one channel and for light lists; colour otherwise.
    automatic,
    colour,  ///< black at the low end of the range, full colour at the high one, sRGB-encoded
    depth,   ///< grey: white at the low end, black at the high one and where there is no surface
    heat     ///< heat_colour; of RGB the luminance (Rec. 709)
};

/// Which channels of a texture are shown.
enum class Channels : std::uint8_t { red, green, blue, alpha, rgb };

/// The values at the two ends of a mapping. Values beyond are clamped; with high <= low, they are above
/// `high` or not.
struct ValueRange {
    float low = 0.0F;
    float high = 1.0F;
    bool operator==(const ValueRange&) const = default;
};

/// What to see of a resource of the frame graph.
struct Inspection {
    static constexpr std::uint32_t all_slices = 0xffff'ffffU;

    std::string resource;   ///< its name as in Renderer::description, with the ending of the view
    std::uint32_t mip = 0;  ///< the last one if there are fewer
    /// Of an array; of a cube array the face, 6 a cube; the last one if there are fewer. Of light lists of
    /// clusters the slice, 0 at the eye, or all_slices: the longest list of a tile.
    std::uint32_t layer = 0;
    Mapping mapping = Mapping::automatic;
    Channels channels = Channels::rgb;  ///< rgb shows a format with a single channel as that
    /// None: the least and the greatest finite value; for colours, with 0.
    std::optional<ValueRange> range{};
    std::uint32_t longest = 1024;  ///< texels along the longer side of the picture, at most
    /// Fills InspectionResult::texel: across and up, in the mip and layer; the last one if there are fewer.
    /// Of light lists a tile.
    std::optional<glm::uvec2> texel{};
    bool operator==(const Inspection&) const = default;
};

/// The values of a texel.
struct InspectedTexel {
    glm::uvec2 at{0};                 ///< across and up
    glm::vec4 channels{0.0F};         ///< as stored; whole numbers above 2^24 are rounded
    std::uint32_t channel_count = 1;  ///< that the format has
    std::optional<float> metres{};    ///< of a depth whose unit is known; 0: there is no surface
    bool operator==(const InspectedTexel&) const = default;
};

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
    std::uint32_t mips = 0;        ///< that can be chosen; 0 without a picture
    std::uint32_t layers = 0;      ///< layers, faces or slices that can be chosen
    glm::uvec2 extent{0};          ///< texels of the mip, or pixels that the tiles of light lists cover
    std::uint32_t texel_size = 1;  ///< pixels along the edge of a tile; 1 for textures
    float least = 0.0F;            ///< finite value that is shown; 0 if there is none
    float greatest = 0.0F;
    std::uint32_t faulty = 0;  ///< texels with values that are infinite or no numbers; above 2^24 rounded
    /// How many of the shown values are in each of 64 equal parts of the range: of red, green and blue if
    /// these are shown, one list behind the other, else of a single channel. Of large textures, one texel in
    /// several counts.
    std::vector<std::uint32_t> histogram{};
    std::optional<InspectedTexel> texel{};
};

/// How a number is stored.
enum class NumberType : std::uint8_t {
    uint32,
    int32,
    float32,
    unorm16,  ///< 16 bits without a sign; 65535 is 1
    snorm16   ///< 16 bits with a sign; 32767 is 1
};

/// One or several numbers in each element of a buffer, one behind the other.
struct ElementField {
    std::string name;  ///< as in the shaders; empty if an element is just these numbers
    NumberType type = NumberType::float32;
    std::uint32_t count = 1;   ///< numbers
    std::uint32_t offset = 0;  ///< bytes from the start of the element
    bool operator==(const ElementField&) const = default;
};

/// Elements of a buffer.
struct BufferElements {
    std::vector<std::byte> bytes;  ///< of the elements that were read
    std::uint32_t stride = 1;      ///< bytes of an element
    std::uint64_t count = 0;       ///< elements that the buffer has room for
    /// What an element holds, by offset, without what only fills gaps. Empty if that is not known: for
    /// buffers of hosts.
    std::vector<ElementField> fields{};
};

/// The numbers of a field of element number `index`. Throws std::out_of_range if the element was not read.
[[nodiscard]] CANDELA_API std::vector<double> numbers_of(const BufferElements& elements,
                                                         const ElementField& field, std::size_t index);

/// Shows one resource of a renderer's frame graph at a time, by an extension named "inspect". It does not
/// change the picture; only a frame budget counts the time of its passes. They run when the resource or what
/// is wanted of it has changed. To be used like the renderer: in its context, not synchronised. The renderer
/// must outlive it and must not be moved meanwhile; `show({})` before its end removes the passes.
class CANDELA_API ResourceInspector {
 public:
    explicit ResourceInspector(Renderer& renderer);

    /// What to show from the next frame on, in any configuration that has the resource; none: nothing.
    /// Another resource means a new frame graph; anything else of an inspection is cheap to change. Returns
    /// errors like Renderer::extend; then all stays as it was.
    [[nodiscard]] std::vector<std::string> show(std::optional<Inspection> wanted);
    [[nodiscard]] std::optional<Inspection> shown() const;

    /// What the last frame shows. Ranges, histogram and texel are read back after frames in which they were
    /// found again; this waits for the GPU.
    [[nodiscard]] InspectionResult result() const;

    /// Reads elements of the resource back if it is a buffer, `most` of them from number `first` on, or fewer
    /// where it ends; waits for the GPU. Empty before the next frame and without a buffer.
    [[nodiscard]] BufferElements read_buffer(std::uint64_t first, std::uint64_t most) const;

 private:
    struct State;
    [[nodiscard]] CANDELA_PRIVATE bool has_run() const;

    Renderer* renderer_;
    std::shared_ptr<State> state_;  // shared with the passes; null while nothing is shown
};

/// The colour of a heat map at a value from 0 (low end of the range) to 1 (high end), sRGB-encoded.
[[nodiscard]] CANDELA_API glm::vec3 heat_colour(float at);

/// Draws how far two pictures are apart: |a - b| times `factor`, clamped to [0, 1], alpha 1. `a` and `b` are
/// GL names of 2D textures of the size of the target. What they store is compared as it is: of tone-mapped
/// pictures in rgba8, the sRGB-encoded values. Context and state of OpenGL as in Renderer::render. Throws
/// gl::GlError where Renderer::tone_map does, and if a texture has another size than the target.
CANDELA_API void draw_difference(Renderer& renderer, std::uint32_t a, std::uint32_t b, float factor,
                                 const Target& target);

}  // namespace candela
