#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <candela/extension.hpp>
#include <candela/graph/execute.hpp>
#include <candela/inspection.hpp>
#include "renderer/passes/lights/light_bins.hpp"
#include "renderer/passes/lights/shadow_maps.hpp"
#include "renderer/passes/vpls/vpl_constants.hpp"

namespace candela {

/// A texture with the depths of shadow maps.
struct ShadowDepths {
    ValueHandle<ShadowPlan> plan;
    bool cubes = false;
};

/// What turns the depths of a texture into metres: those along the axis of the camera or of a shadow map, or
/// the octahedral distance to a VPL. None: unknown.
using DepthMeaning =
    std::variant<std::monostate, ValueHandle<CameraView>, ShadowDepths, ValueHandle<VplAtlas>>;

/// A resource of a graph: a texture or a buffer.
struct Inspected {
    std::optional<FoundTexture> texture{};
    DepthMeaning depth{};
    std::optional<FoundBuffer> buffer{};
    std::optional<ValueHandle<CellGrid>> grid{};  ///< the buffer holds the lengths of light lists by cell

    [[nodiscard]] bool has_picture() const { return texture || grid; }
};

/// The resource with this name, if passes of the graph have written one so far. `frame` is the view whose
/// passes are being declared.
[[nodiscard]] std::optional<Inspected> find_inspected(const FrameGraph& graph, const ViewFrame& frame,
                                                      std::string_view name);

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
    int channels = 0;  ///< as in shaders/inspect/inspected.glsl
    /// Elements [2][2], [3][2], [2][3] and [3][3] of the projection that made the depths, if they are shown
    /// in metres.
    std::optional<glm::vec4> depth_terms{};
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
