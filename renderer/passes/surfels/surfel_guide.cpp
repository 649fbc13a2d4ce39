#include "renderer/passes/surfels/surfel_guide.hpp"

#include <algorithm>
#include <variant>

#include <glm/geometric.hpp>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/traced_scene.hpp"

namespace candela {
namespace {

constexpr glm::ivec2 rays_a_view{48, 32};

/// Resources of the node.
struct GuideNode {
    SceneData scene;
    Tracing tracing;
    ValueHandle<std::vector<ViewRequest>> requests;
    ValueHandle<SpreadSurfels> spread;
    Surfels surfels;
    BufferHandle<float> seen;    // by surfel
    BufferHandle<float> shares;  // by surfel
    ValueHandle<SurfelGuide> out;
    const gl::Program& program;
};

/// The surfel whose cell a surface is most likely in. Of two that are as far away, the one that faces the
/// same way.
std::size_t surfel_at(const std::vector<SurfelPlace>& places, const SurfaceHit& hit) {
    constexpr float weight_of_turn = 8.0F;
    const auto remoteness = [&](const SurfelPlace& place) {
        const glm::vec3 apart = place.position - hit.place;
        return glm::dot(apart, apart) * (1.0F + weight_of_turn * (1.0F - glm::dot(place.normal, hit.normal)));
    };
    return static_cast<std::size_t>(std::ranges::min_element(places, {}, remoteness) - places.begin());
}

/// By surfel: how many rays through the pictures meet its cell.
std::vector<float> count_seen(const Execution& run, const GuideNode& node) {
    const TracedScene traced{*run.value(node.tracing.hierarchy), run.value(node.scene.layout),
                             run.value(node.scene.placement)};
    const std::vector<SurfelPlace>& places = run.value(node.surfels.places);
    std::vector<float> seen(places.size());
    for (const CameraView& view : requested_views(run.world(), run.value(node.requests))) {
        for (const Ray& ray : rays_through(view, rays_a_view)) {
            const auto hit = nearest_surface(traced, ray);
            if (hit) seen[surfel_at(places, *hit)] += 1.0F;
        }
    }
    return seen;
}

/// By surfel: how much of the light that is seen it sends.
std::vector<float> shares_of(const Gpu& gpu, Execution& run, const GuideNode& node) {
    const VplCounts& counts = run.value(node.surfels.counts);
    upload<float>(gpu, run, node.seen, count_seen(run, node));
    run.reserve(node.shares, counts.surfels);
    const gl::Uniforms uniforms =
        count_uniforms(counts.all_surfels()) + gl::Uniforms{{"sending_count", counts.surfels}};
    ComputeSteps steps(gpu);
    steps.run(node.program, {groups(counts.all_surfels(), SURFEL_GROUP)},
              uniforms + gl::Uniforms{{"receives", true}});
    steps.run(node.program, {groups(counts.surfels, SURFEL_GROUP)},
              uniforms + gl::Uniforms{{"receives", false}});
    std::vector<float> shares(counts.surfels);
    gpu.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gpu.gl().GetNamedBufferSubData(run.object(node.shares), 0,
                                   static_cast<GLsizeiptr>(shares.size() * sizeof(float)), shares.data());
    return shares;
}

/// Spreads the shares of surfels evenly over their cells.
void find_guide(const Gpu& gpu, Execution& run, const GuideNode& node) {
    SurfelGuide guide{.key = run.value(node.spread).placement_key, .points = {}};
    const std::vector<SurfelPlace>& surfels = run.value(node.surfels.places);
    if (run.value(node.surfels.counts).surfels > 0) {
        const std::vector<float> shares = shares_of(gpu, run, node);
        for (const CellPlace& point : run.value(node.surfels.cell_places)) {
            if (point.surfel >= shares.size() || !(point.area > 0.0F)) continue;
            const float share = shares[point.surfel] * point.area / surfels[point.surfel].area;
            guide.points.push_back({point.place, point.area, share});
        }
    }
    run.set(node.out, std::move(guide));
}

}  // namespace

ValueHandle<SurfelGuide> add_surfel_guide(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                          const Tracing& tracing,
                                          ValueHandle<std::vector<ViewRequest>> requests,
                                          ValueHandle<SpreadSurfels> spread,
                                          const SurfelVisibility& visibility, const Vpls& lit) {
    return graph.add("surfel-guide", [&](Pass& pass) {
        const auto& records = std::get<LitSurfels>(lit.records);
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        read_requests(pass, requests);
        pass.read(spread);
        pass.read(visibility.surfels.counts);
        pass.read(visibility.surfels.places);
        pass.read(visibility.surfels.cell_places);
        pass.read(visibility.form_factors, {Usage::storage, BINDING_FORM_FACTORS});
        pass.read(visibility.rows, {Usage::storage, BINDING_SURFEL_ROWS});
        pass.read(records.surfels, {Usage::storage, BINDING_LIT_SURFELS});
        const GuideNode node{.scene = scene,
                             .tracing = tracing,
                             .requests = requests,
                             .spread = spread,
                             .surfels = visibility.surfels,
                             .seen = pass.write(growing_buffer<float>(graph, "seen surfels"),
                                                {Usage::copy, BINDING_SEEN_SURFELS}),
                             .shares = pass.write(growing_buffer<float>(graph, "shares of the picture"),
                                                  {Usage::storage, BINDING_GUIDE}),
                             .out = pass.write(graph.value<SurfelGuide>("surfel guide")),
                             .program = gpu.program({"surfels/surfel_guide.comp"})};
        pass.run([=, &gpu](Execution& run) { find_guide(gpu, run, node); });
        return node.out;
    });
}

}  // namespace candela
