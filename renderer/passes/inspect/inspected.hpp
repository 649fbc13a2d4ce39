#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <candela/graph/execute.hpp>
#include <candela/inspection.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/inspect/depth_note.hpp"
#include "renderer/passes/lights/light_lists.hpp"

namespace candela {

/// A resource of a graph: a texture or a buffer.
struct Inspected {
    std::optional<FoundTexture> texture{};
    DepthNote depth{};  ///< without functions if its depths have no unit
    std::optional<FoundBuffer> buffer{};
    std::optional<ValueHandle<CellGrid>> grid{};  ///< the buffer holds the lengths of light lists by cell

    [[nodiscard]] bool has_picture() const { return texture || grid; }
};

/// The resource with this name, if passes of the graph have written one so far.
[[nodiscard]] std::optional<Inspected> find_inspected(const FrameGraph& graph, std::string_view name);

/// Declares the reads of a pass that uses it.
void read_inspected(Pass& pass, const Inspected& inspected);

/// What is shown of a resource, now that its size is known.
struct Shown {
    TextureDesc desc;         ///< of textures
    std::uint32_t mip = 0;    ///< as in Inspection, but existing
    std::uint32_t layer = 0;  ///< the first slice of lists
    std::uint32_t slices = 1;
    std::uint32_t mips = 1;        ///< that could be shown
    std::uint32_t layers = 1;      ///< or slices
    glm::uvec2 extent{1};          ///< texels, or pixels that the tiles cover
    glm::uvec2 texels{1};          ///< or tiles
    std::uint32_t texel_size = 1;  ///< pixels along the edge of a tile; 1 for textures
    glm::uvec2 picture{1};         ///< pixels of the picture
    Mapping mapping = Mapping::colour;
    int channels = 0;                         ///< as in shaders/inspect/inspected.glsl
    std::optional<DepthTerms> depth_terms{};  ///< if depths are shown in metres
    std::optional<ValueRange> range{};
};
[[nodiscard]] Shown shown_of(const Execution& run, const Inspected& inspected, const Inspection& wanted);

/// The program of this compute shader for the resource. It includes inspected.glsl.
[[nodiscard]] const gl::Program& inspecting_program(Gpu& gpu, std::string_view file,
                                                    const Inspected& inspected);
/// Binds the texture.
class InspectedTexels {
 public:
    InspectedTexels(Gpu& gpu, const Execution& run, const Inspected& inspected, const Shown& shown);

    /// Of inspected.glsl.
    [[nodiscard]] const gl::Uniforms& uniforms() const { return uniforms_; }

 private:
    gl::Texture view_;  // of the mip and layer
    gl::Uniforms uniforms_;
};

}  // namespace candela
