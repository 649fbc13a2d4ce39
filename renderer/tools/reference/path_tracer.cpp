#include "renderer/tools/reference/path_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <candela/scene/scene_error.hpp>
#include "renderer/tools/reference/camera.hpp"
#include "renderer/tools/reference/edges.hpp"
#include "renderer/tools/reference/paths.hpp"

namespace candela::reference {

namespace {

/// A picture in progress. Each thread writes to different pixels.
struct Trace {
    const SceneContent& scene;
    const Settings& settings;
    const std::stop_token& stop;
    Viewpoint viewpoint;
    Estimate estimate;
    std::vector<PixelTrait> traits;
};

void check(const Settings& settings) {
    if (settings.samples == 0 || settings.samples % 2 != 0 || settings.first_sample % 2 != 0) {
        throw std::invalid_argument("the reference's samples must be an even number");
    }
    if (settings.size.x == 0 || settings.size.y == 0) {
        throw std::invalid_argument("the reference's picture has no pixels");
    }
}

const PlacedCamera& find_camera(const SceneContent& scene, Entity wanted) {
    const auto found = std::ranges::find(scene.cameras, wanted, &PlacedCamera::entity);
    if (found == scene.cameras.end()) throw SceneError("the reference's scene has no such camera");
    return *found;
}

tools::Picture black(glm::uvec2 size) {
    return {glm::ivec2(size), std::vector(std::size_t{size.x} * size.y, glm::vec3(0.0F))};
}

Estimate black_estimate(glm::uvec2 size) {
    const std::size_t pixels = std::size_t{size.x} * size.y;
    return {.direct = black(size),
            .indirect = black(size),
            .halves = {black(size), black(size)},
            .hit = std::vector<std::uint8_t>(pixels, 0),
            .edge = {},
            .seconds = 0.0};
}

glm::vec3 mean_indirect(const Trace& trace, const std::vector<SeenSurface>& seen, Sampler sampler) {
    const std::uint32_t pairs = trace.settings.samples / 2;
    glm::dvec3 sum(0.0);
    for (const SeenSurface& layer : seen) {
        for (std::uint32_t i = 0; i < pairs; ++i) {
            sampler.start(trace.settings.first_sample / 2 + i);
            sum += layer.weight * layer.openness *
                   indirect_light(trace.scene, layer.surface, sampler, trace.settings);
        }
    }
    return sum / static_cast<double>(pairs);
}

/// What a surface emits, and what it reflects of the light of emitters and of the sky.
glm::vec3 sampled_light(const Trace& trace, const SeenSurface& seen, Sampler& sampler) {
    const Surface& surface = seen.surface;
    glm::dvec3 sum(0.0);
    for (std::uint32_t i = 0; i < trace.settings.samples; ++i) {
        sampler.start(trace.settings.first_sample + i);
        if (trace.scene.emitters.any()) sum += light_of_emitters(trace.scene, surface, sampler);
        if (trace.scene.sky.any()) sum += light_of_sky(trace.scene, surface, sampler);
    }
    const glm::vec3 mean(sum / static_cast<double>(trace.settings.samples));
    return surface.emission + seen.openness * surface.albedo * mean;
}

/// Sums the direct light of all layers, and records what distinguishes the pixel from its neighbours.
glm::vec3 add_direct(const Trace& trace, const std::vector<SeenSurface>& seen, Sampler sampler,
                     PixelTrait& trait) {
    glm::vec3 sum(0.0F);
    for (const SeenSurface& layer : seen) {
        Direct direct = direct_light(trace.scene, layer.surface, trace.settings.defect);
        sum += layer.weight * direct.radiance;
        if (trace.scene.emitters.any() || trace.scene.sky.any()) {
            sum += layer.weight * sampled_light(trace, layer, sampler);
        }
        trait.layers.push_back(
            {layer.surface.position, layer.surface.face, layer.part, std::move(direct.states)});
    }
    return sum;
}

void trace_pixel(Trace& trace, glm::uvec2 pixel) {
    const std::size_t i = std::size_t{pixel.y} * trace.settings.size.x + pixel.x;
    const Ray ray = trace.viewpoint.through(glm::dvec2(pixel) + 0.5 + trace.settings.offset);
    const auto seen = seen_surfaces(trace.scene.geometry, ray);
    glm::vec3 light_through(1.0F);
    for (const SeenSurface& layer : seen) light_through *= layer.through;
    trace.estimate.direct.pixels[i] = light_through * trace.scene.sky.radiance(ray.direction);
    if (seen.empty()) return;
    trace.estimate.hit[i] = 1;
    trace.estimate.direct.pixels[i] += add_direct(
        trace, seen, Sampler(pixel_seed(trace.settings.seed, pixel, Numbers::direct_light)), trace.traits[i]);
    if (trace.settings.bounces == 0U) return;
    for (const Numbers half : {Numbers::first_half, Numbers::second_half}) {
        const Sampler sampler(pixel_seed(trace.settings.seed, pixel, half));
        trace.estimate.halves[static_cast<std::size_t>(half)].pixels[i] = mean_indirect(trace, seen, sampler);
    }
    trace.estimate.indirect.pixels[i] =
        0.5F * (trace.estimate.halves[0].pixels[i] + trace.estimate.halves[1].pixels[i]);
}

/// Free threads take the next row: the random numbers of a pixel depend only on its position and the seed.
void trace_rows(Trace& trace) {
    std::atomic<std::uint32_t> next_row{0};
    const auto work = [&] {
        for (std::uint32_t y = next_row++; y < trace.settings.size.y; y = next_row++) {
            for (std::uint32_t x = 0; x < trace.settings.size.x && !trace.stop.stop_requested(); ++x) {
                trace_pixel(trace, {x, y});
            }
        }
    };
    const unsigned wanted = trace.settings.threads;
    const unsigned threads = wanted > 0 ? wanted : std::max(std::thread::hardware_concurrency(), 1U);
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
}

}  // namespace

Estimate trace(const Scene& scene, Entity camera, const Settings& settings, const std::stop_token& stop) {
    check(settings);
    const auto start = std::chrono::steady_clock::now();
    const PlacedCamera& placed = find_camera(scene.content(), camera);
    Trace trace{.scene = scene.content(),
                .settings = settings,
                .stop = stop,
                .viewpoint = Viewpoint(placed.camera, placed.to_world, settings.size),
                .estimate = black_estimate(settings.size),
                .traits = std::vector<PixelTrait>(std::size_t{settings.size.x} * settings.size.y)};
    trace_rows(trace);
    if (!stop.stop_requested()) trace.estimate.edge = find_edges(trace.traits, settings.size, edge_radius);
    trace.estimate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(trace.estimate);
}

tools::Picture total(const Estimate& estimate) {
    tools::Picture sum = estimate.direct;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += estimate.indirect.pixels[i];
    return sum;
}

}  // namespace candela::reference
