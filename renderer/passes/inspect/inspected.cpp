#include "renderer/passes/inspect/inspected.hpp"

#include <algorithm>
#include <any>
#include <glm/common.hpp>

#include "shaders/bindings.glsl"

namespace candela {
namespace {

constexpr int channels_luminance = 5;  // as in shaders/inspect/inspected.glsl, like the values of Channels

Shown shown_texture(const TextureDesc& desc, const Inspection& wanted) {
    Shown shown{.desc = desc,
                .mip = std::min(wanted.mip, desc.mips - 1),
                .layer = std::min(wanted.layer, desc.layers - 1),
                .mips = desc.mips,
                .layers = desc.layers};
    shown.extent = shown.texels = glm::max(desc.size >> shown.mip, glm::uvec2(1));
    return shown;
}

Shown shown_lists(const CellGrid& grid, const Inspection& wanted) {
    const bool all = wanted.layer == Inspection::all_slices;
    return {.desc = {},
            .layer = all ? 0 : std::min(wanted.layer, grid.slices - 1),
            .slices = all ? grid.slices : 1,
            .layers = grid.slices,
            .extent = grid.size,
            .texels = grid.tiles,
            .texel_size = grid.tile_size};
}

Mapping mapping_of(const Inspected& inspected, Mapping wanted) {
    if (wanted != Mapping::automatic) return wanted;
    if (inspected.depth.terms || (inspected.texture && is_depth(inspected.texture->desc.format))) {
        return Mapping::depth;
    }
    const bool single = !inspected.texture || gl::format_info(inspected.texture->desc.format).components == 1;
    return single ? Mapping::heat : Mapping::colour;
}

int channels_of(const Inspected& inspected, Channels wanted, Mapping mapping) {
    if (wanted != Channels::rgb) return static_cast<int>(wanted);
    if (!inspected.texture || gl::format_info(inspected.texture->desc.format).components == 1) {
        return static_cast<int>(Channels::red);
    }
    return mapping == Mapping::colour ? static_cast<int>(Channels::rgb) : channels_luminance;
}

/// The size in this shape whose longer side is at most `longest`.
glm::uvec2 fitted(glm::uvec2 size, std::uint32_t longest) {
    const std::uint32_t side = std::max(size.x, size.y);
    const std::uint32_t most = std::max(longest, 1U);
    return side <= most ? size : glm::max(size * most / side, glm::uvec2(1));
}

bool is_integer(const Inspected& inspected) {
    return inspected.texture && inspected.texture->desc.format == Format::r32ui;
}

}  // namespace

std::optional<Inspected> find_inspected(const FrameGraph& graph, std::string_view name) {
    if (const auto texture = graph.find_texture(name)) {
        const auto* const depth = std::any_cast<DepthNote>(texture->note);
        return Inspected{.texture = texture, .depth = depth ? *depth : DepthNote{}};
    }
    if (const auto buffer = graph.find_buffer(name)) {
        const auto* const lengths = std::any_cast<ListLengths>(buffer->note);
        return Inspected{.buffer = buffer, .grid = lengths ? std::optional(lengths->grid) : std::nullopt};
    }
    return std::nullopt;
}

void read_inspected(Pass& pass, const Inspected& inspected) {
    if (inspected.texture) pass.read(inspected.texture->handle, Usage::sampled);
    if (inspected.buffer) pass.read(inspected.buffer->handle, {Usage::storage, BINDING_LIST_COUNT});
    if (inspected.grid) pass.read(*inspected.grid);
    if (inspected.depth.read) inspected.depth.read(pass);
}

Shown shown_of(const Execution& run, const Inspected& inspected, const Inspection& wanted) {
    Shown shown = inspected.grid ? shown_lists(run.value(*inspected.grid), wanted)
                                 : shown_texture(run.desc(inspected.texture->handle), wanted);
    shown.picture = fitted(shown.extent, wanted.longest);
    shown.mapping = mapping_of(inspected, wanted.mapping);
    shown.channels = channels_of(inspected, wanted.channels, shown.mapping);
    shown.range = wanted.range;
    if (inspected.depth.terms && shown.mapping != Mapping::colour) {
        shown.depth_terms = inspected.depth.terms(run, shown.layer);
    }
    return shown;
}

const gl::Program& inspecting_program(Gpu& gpu, std::string_view file, const Inspected& inspected) {
    std::vector<std::string> defined;
    if (inspected.grid) {
        defined.emplace_back("LISTS");
    } else if (is_integer(inspected)) {
        defined.emplace_back("INTEGER");
    }
    return gpu.program({std::string(file)}, defined);
}

InspectedTexels::InspectedTexels(Gpu& gpu, const Execution& run, const Inspected& inspected,
                                 const Shown& shown)
    : uniforms_{{"texels", shown.texels},
                {"channels", shown.channels},
                {"has_metres", shown.depth_terms.has_value()},
                {"depth_terms", shown.depth_terms.value_or(glm::vec4(0.0F))}} {
    if (inspected.texture) {
        view_ = gl::Texture(gpu.device(), "inspected", run.object(inspected.texture->handle), shown.desc,
                            shown.mip, shown.layer);
        view_.bind(UNIT_INSPECTED);
        gpu.nearest().bind(UNIT_INSPECTED);
    } else {
        uniforms_ =
            uniforms_ + gl::Uniforms{{"first_slice", shown.layer}, {"end_slice", shown.layer + shown.slices}};
    }
}

}  // namespace candela
