#include "renderer/passes/mirror/mirror_rays.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <candela/graph/execute.hpp>
#include <candela/workload.hpp>
#include "renderer/passes/sky/background.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

std::optional<BufferHandle<gpu::LitEmitter>> emitters_of(const MirroredSources& sources) {
    if (!sources.emitters || !sources.vpls) return std::nullopt;
    const auto* const lit = std::get_if<LitSurfels>(&sources.vpls->vpls.records);
    return lit != nullptr ? lit->emitters : std::nullopt;
}

/// Whether there are emitting surfels for the pass to read.
bool read_emitters(Pass& pass, const MirroredSources& sources) {
    const auto emitters = emitters_of(sources);
    if (!emitters) return false;
    pass.read(*emitters, {Usage::storage, BINDING_LIT_EMITTERS});
    read_vpl_constants(pass, sources.vpls->common);
    return true;
}

void read_sky(Pass& pass, const MirroredSky& sky) {
    pass.read(sky.sky.environment);
    pass.read(sky.sky.split);
    pass.read(sky.picture, {Usage::sampled, UNIT_SKY});
    pass.read(sky.tree.levels, {Usage::sampled, UNIT_SKY_TREE});
    pass.read(sky.tree.share);
}

/// Of shaders/mirror/sky_rays.glsl.
gl::Uniforms mirrored_sky_uniforms(const Execution& run, const MirroredSky& sky) {
    constexpr float most_to_sky = 0.5F;  // of the rays
    const Environment& environment = run.value(sky.sky.environment);
    std::vector<glm::vec4> suns;
    for (const SkySun& sun : run.value(sky.sky.split).suns) {
        suns.emplace_back(rotated_sky(sun.direction, environment.rotation), around_sun_cosine);
    }
    suns.resize(MOST_SKY_SUNS, glm::vec4(0.0F));
    return sky_uniforms(environment) +
           gl::Uniforms{{"share_to_sky", most_to_sky * run.value(sky.tree.share)}, {"suns", suns}};
}

}  // namespace

MirroredSurfaces add_mirror_rays(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                 const Tracing& tracing, const MirroredSources& sources, const ViewData& view,
                                 std::optional<ValueHandle<std::uint32_t>> round) {
    return graph.add("mirror-rays", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_geometry_and_material(pass, surfaces);
        read_tracing(pass, tracing);
        read_view(pass, view);
        std::vector<std::string> variant = material_variant(parts_of(surfaces));
        if (sources.bumpy) variant.emplace_back("MIRRORED_BUMPS");
        if (sources.emitters) variant.emplace_back("EMISSION");
        if (read_emitters(pass, sources)) variant.emplace_back("EMITTERS");
        if (sources.sky) {
            read_sky(pass, *sources.sky);
            variant.emplace_back("SKY");
        }
        if (round) pass.read(*round);
        const gl::Program& program =
            gpu.program({"output/fullscreen.vert", "mirror/mirror_rays.frag"}, variant);
        const auto write = [&](std::string_view name, Format format) {
            return pass.write(graph.texture(name, {view.size, format}), Usage::colour_target);
        };
        MirroredSurfaces out;
        out.surfaces.depth = write("mirrored place", Format::rgba32f);
        out.surfaces.normal = write("mirrored normal", Format::rgba32f);
        out.surfaces.albedo = write("mirrored albedo", Format::rgba16f);
        out.surfaces.mirrored = true;
        out.round = round;
        out.source = write("mirrored source", Format::rgba32f);
        out.surfaces.mirror = write("mirrored reflectance", Format::rgba16f);
        out.surfaces.gloss = write("mirrored gloss", Format::rg16f);
        if (sources.bumpy) out.surfaces.bumps = write("mirrored bumps", Format::rgba32f);
        pass.run([=, &gpu, &program, metrics = tracing.metrics](Execution& run) {
            gl::Uniforms uniforms{{"ray_offset", run.value(metrics).ray_offset()},
                                  {"ray_round", round ? run.value(*round) : 0U}};
            if (sources.sky) uniforms = uniforms + mirrored_sky_uniforms(run, *sources.sky);
            gpu.clear_colour();
            gpu.draw_fullscreen(program, uniforms);
        });
        return out;
    });
}

TextureHandle add_mirror_resolve(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                 const MirroredSources& sources, const MirroredSurfaces& mirrored,
                                 std::optional<TextureHandle> reflected, const ViewData& view,
                                 TextureHandle radiance) {
    return graph.add("mirror-resolve", [&](Pass& pass) {
        pass.note(Workload::pixels);
        read_geometry_and_material(pass, surfaces);
        read_view(pass, view);
        pass.read(*mirrored.surfaces.depth, {Usage::sampled, UNIT_MIRRORED_PLACE});
        pass.read(*mirrored.surfaces.normal, {Usage::sampled, UNIT_MIRRORED_NORMAL});
        pass.read(mirrored.source, {Usage::sampled, UNIT_MIRRORED_SOURCE});
        std::vector<std::string> variant = material_variant(parts_of(surfaces));
        if (mirrored.round) pass.read(*mirrored.round);
        if (read_emitters(pass, sources)) {
            pass.read(*mirrored.surfaces.albedo, {Usage::sampled, UNIT_MIRRORED_ALBEDO});
            variant.emplace_back("EMITTERS");
        }
        if (reflected) {
            pass.read(*reflected, {Usage::sampled, UNIT_INDIRECT});
            variant.emplace_back("REFLECTED");
        }
        const gl::Program& program =
            gpu.program({"output/fullscreen.vert", "mirror/mirror_resolve.frag"}, variant);
        const TextureHandle out = pass.write(radiance, Usage::colour_target);
        pass.run([=, &gpu, &program, round = mirrored.round](Execution& run) {
            gpu.mirror_shares().bind(UNIT_MIRROR_SHARES);
            gpu.draw_fullscreen(program, {{"ray_round", round ? run.value(*round) : 0U}},
                                {.blending = gl::Blending::add});
        });
        return out;
    });
}

}  // namespace candela
