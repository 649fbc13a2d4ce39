#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <random>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include "renderer/gl/graph_backend.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "sandbox/files/shipped_file.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

TEST_SUITE("compute tracer") {

using namespace candela;

namespace {

struct TestRay {
    glm::vec3 origin;
    float t_max;
    glm::vec3 direction;
    float pad0 = 0.0F;
};

/// As trace_rays.comp writes it.
struct TestHit {
    glm::vec3 front;
    float t;
    std::uint32_t triangle;
    std::uint32_t instance;
    std::array<std::uint32_t, 2> pad;
};

/// A hit on the GPU: distance, and the triangle in world space, with the normal of its front, of any length,
/// and the colour of its first vertex as in gpu::TraceTriangle; infinity for none.
struct GpuHit {
    float t = std::numeric_limits<float>::infinity();
    Triangle triangle{};
    glm::vec3 front{0.0F};
    std::uint32_t colour = 0;
};

/// Leads from the space of an instance's mesh to the world.
glm::mat4 world_from_mesh(const gpu::WideNode& instance) {
    const glm::mat4 rows(glm::vec4(instance.origin, std::bit_cast<float>(instance.exponents)),
                         std::bit_cast<glm::vec4>(instance.lower), std::bit_cast<glm::vec4>(instance.upper),
                         glm::vec4(0, 0, 0, 1));
    return glm::inverse(glm::transpose(rows));
}

Triangle placed(const gpu::TraceTriangle& triangle, const glm::mat4& world) {
    const auto at = [&](glm::vec3 place) { return glm::vec3(world * glm::vec4(place, 1.0F)); };
    return {at(triangle.a), at(triangle.a + triangle.edge_ab), at(triangle.a + triangle.edge_ac)};
}

std::string trace_rays_source() {
    std::ifstream file(sandbox::shipped_file("", "trace_rays.comp"));
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The shipped shaders and trace_rays.comp.
class Shaders {
 public:
    [[nodiscard]] gl::ShaderLibrary library() const { return gl::ShaderLibrary(files_); }

 private:
    std::string source_ = trace_rays_source();
    std::vector<gl::EmbeddedShader> files_ = [this] {
        const auto shipped = gl::embedded_shaders();
        std::vector<gl::EmbeddedShader> files(shipped.begin(), shipped.end());
        files.push_back({"trace_rays.comp", source_});
        return files;
    }();
};

/// Rays from points within `reach` of `centre` along each axis, in all directions, of all lengths; some end
/// early.
std::vector<TestRay> random_rays(std::size_t count, glm::vec3 centre, float reach) {
    std::mt19937 engine(7);
    const auto number = [&](float limit) {
        return std::uniform_real_distribution<float>(-limit, limit)(engine);
    };
    const auto vector = [&](float limit) {
        const float x = number(limit), y = number(limit);
        return glm::vec3(x, y, number(limit));
    };
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 origin = centre + vector(reach);
        const float t_max = i % 8 == 0 ? 0.5F : std::numeric_limits<float>::infinity();
        rays.push_back({origin, t_max, vector(1.0F)});
    }
    // Directions that contain zeros of either sign.
    for (const glm::vec3 axis :
         {glm::vec3(0, -1, 0), glm::vec3(-0.0F, 1, -0.0F), glm::vec3(0, 0, -2), glm::vec3(1, 0, -0.0F)}) {
        rays.push_back({centre + vector(0.3F * reach), std::numeric_limits<float>::infinity(), axis});
    }
    return rays;
}

/// Traces rays on the GPU through worlds, each uploaded by the renderer's own passes as a change of the last
/// one.
class Tracer {
 public:
    explicit Tracer(const gl::GetProc& get_proc)
        : gpu_(get_proc, shaders_.library(), {.debug_output = true}) {
        FrameGraph graph;
        const SceneData scene = add_scene_upload(graph, gpu_);
        const Tracing tracing = add_bvh(graph, gpu_, scene);
        graph.add("trace-rays", [&](Pass& pass) {
            read_tracing(pass, tracing);
            pass.side_effect();
            pass.run([this, tracing](Execution& run) {
                program_.use({{"ray_count", ray_count_}});
                gpu_.gl().DispatchCompute(static_cast<GLuint>(ray_count_ + 31) / 32, 1, 1);
                gpu_.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
                triangles_ = backend_.buffer(run.object(tracing.triangles)).download<gpu::TraceTriangle>();
                nodes_ = backend_.buffer(run.object(tracing.nodes)).download<gpu::WideNode>();
            });
        });
        runtime_.switch_to(compile(std::move(graph)).take());
    }

    [[nodiscard]] std::vector<GpuHit> trace(const World& world, const std::vector<TestRay>& rays) {
        const gl::Buffer ray_buffer(gpu_.device(), "rays", rays);
        const gl::Buffer hit_buffer(gpu_.device(), "hits", rays.size() * sizeof(TestHit));
        ray_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, BINDING_LAST + 1);
        hit_buffer.bind_base(GL_SHADER_STORAGE_BUFFER, BINDING_LAST + 2);
        ray_count_ = static_cast<std::uint32_t>(rays.size());
        runtime_.run(world);

        std::vector<GpuHit> hits;
        for (const TestHit& hit : hit_buffer.download<TestHit>()) {
            if (hit.triangle == 0xffffffffU) {
                hits.emplace_back();
                continue;
            }
            const gpu::TraceTriangle& t = triangles_.at(hit.triangle);
            const Triangle triangle = placed(t, world_from_mesh(nodes_.at(hit.instance)));
            hits.push_back({hit.t, triangle, hit.front, t.colour_a});
        }
        return hits;
    }

 private:
    Shaders shaders_;
    Gpu gpu_;
    gl::GraphBackend backend_{gpu_.device()};
    GraphRuntime runtime_{backend_};
    const gl::Program& program_{gpu_.programs().compiled({"trace_rays.comp"}, {})};
    std::uint32_t ray_count_ = 0;
    std::vector<gpu::TraceTriangle> triangles_;
    std::vector<gpu::WideNode> nodes_;
};

class TraceRays : public GlFixture {
 protected:
    /// Compares the hits with the hierarchy on the CPU, built from the world itself.
    static void check(Tracer& tracer, const World& world, const std::vector<TestRay>& rays,
                      double least_hit_share) {
        const std::vector<Triangle> triangles = world_triangles(world);
        const Bvh bvh = build_bvh(triangles);
        const std::vector<GpuHit> hits = tracer.trace(world, rays);
        std::size_t hit_count = 0;
        std::size_t ties = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            CAPTURE(i);
            const auto wanted = closest_hit(
                bvh, triangles,
                {.origin = rays[i].origin, .direction = rays[i].direction, .t_max = rays[i].t_max});
            REQUIRE(wanted.has_value() == std::isfinite(hits[i].t));
            if (!wanted) continue;
            ++hit_count;
            // The corners were reconstructed from edges and the inverse matrix, with rounding. In the world,
            // those of a mirrored mesh have another order.
            const auto near = [](glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < 1e-5F; };
            const Triangle& t = triangles[wanted->triangle];
            const Triangle& found = hits[i].triangle;
            const bool same = near(t.a, found.a) && ((near(t.b, found.b) && near(t.c, found.c)) ||
                                                     (near(t.b, found.c) && near(t.c, found.b)));
            if (!same) ++ties;
            // The same triangle, or another one at the same distance within 100 roundings: across an edge, or
            // the floor under a block.
            REQUIRE(std::abs(hits[i].t - wanted->t) <= 1e-5F * std::max(wanted->t, 1.0F));
        }
        CHECK(static_cast<double>(hit_count) > least_hit_share * static_cast<double>(rays.size()));
        CHECK(ties * 100 < rays.size());
    }

    Tracer tracer{context->get_proc()};
};

}  // namespace

TEST_CASE_FIXTURE(TraceRays, "hits in the Cornell box equal those on the CPU") {
    check(tracer, cornell_box().world, random_rays(20'000, {0, 1, 0}, 0.95F), 0.7);
}

TEST_CASE_FIXTURE(TraceRays, "hits among 100,000 triangles equal those on the CPU") {
    World world;
    add(world, Transform{}, MeshInstance{soup(100'000, 3)});
    check(tracer, world, random_rays(10'000, {0, 0, 0}, 1.2F), 0.5);
}

TEST_CASE_FIXTURE(TraceRays, "hits with one triangle, and with none, equal those on the CPU") {
    World world;
    check(tracer, world, random_rays(100, {0, 0, 0}, 1.0F), -1.0);
    add(world, Transform{}, MeshInstance{soup(1, 3)});
    check(tracer, world, random_rays(1000, {0, 0, 0}, 1.0F), -1.0);
}

TEST_CASE_FIXTURE(TraceRays, "hits of mirrored and sheared instances equal brute force") {
    World world;
    const Entity parent = add(world, Transform{.scale = {-0.7F, 1.3F, 1.0F}});
    add(world, Transform{.rotation = glm::angleAxis(0.7F, glm::vec3(0, 0, 1)), .parent = parent},
        MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F)))});
    const auto rays = random_rays(2000, {0, 0, 0}, 0.3F);
    const auto hits = tracer.trace(world, rays);
    const auto triangles = world_triangles(world);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        // Two-sided brute force over the world's own triangles: mirrored ones have another order of
        // corners.
        float nearest = rays[i].t_max;
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto hit =
                intersect(triangles[t], t,
                          {.origin = rays[i].origin, .direction = rays[i].direction, .t_max = nearest});
            if (hit) nearest = hit->t;
        }
        REQUIRE((nearest < rays[i].t_max) == std::isfinite(hits[i].t));
        if (!std::isfinite(hits[i].t)) continue;
        REQUIRE(std::abs(hits[i].t - nearest) <= 1e-5F * std::max(nearest, 1.0F));
        // The front faces inwards, at a right angle to the triangle. Corners are within some hundred
        // roundings.
        const Triangle& t = hits[i].triangle;
        const glm::vec3 front = glm::normalize(hits[i].front);
        CHECK(glm::dot(front, t.a) < 0.0F);
        CHECK(std::abs(glm::dot(front, t.b - t.a)) < 1e-5F);
        CHECK(std::abs(glm::dot(front, t.c - t.a)) < 1e-5F);
    }
}

TEST_CASE_FIXTURE(TraceRays, "hits equal those on the CPU after each of many additions, moves and removals") {
    std::mt19937 random(test_seed(12));
    const auto number = [&](float lower, float upper) {
        return std::uniform_real_distribution<float>(lower, upper)(random);
    };
    const auto anywhere = [&] {
        const float x = number(-0.7F, 0.7F), y = number(-0.7F, 0.7F), angle = number(0.0F, 6.0F);
        return Transform{.translation = {x, y, number(-0.7F, 0.7F)},
                         .rotation = glm::angleAxis(angle, glm::normalize(glm::vec3(1, x, y))),
                         .scale = {number(0.1F, 0.8F), 0.4F, 0.3F}};
    };
    World world;
    std::vector<Entity> soups;
    const auto any = [&] { return soups[random() % soups.size()]; };
    const auto rays = random_rays(500, {0, 0, 0}, 1.0F);
    for (std::uint32_t edit = 0; edit < 60; ++edit) {
        CAPTURE(edit);
        // Sizes from a leaf to more triangles than all others have together.
        const std::size_t triangles = std::size_t{1} << (random() % 13);
        switch (soups.empty() ? 0 : random() % 5) {
            case 0:
            case 1:
                soups.push_back(add(world, anywhere(), MeshInstance{soup(triangles, edit, 0.3F)}));
                break;
            case 2: {
                const auto gone = soups.begin() + static_cast<std::ptrdiff_t>(random() % soups.size());
                world.destroy(*gone);
                soups.erase(gone);
                break;
            }
            default:
                world.set(any(), anywhere());
                if (edit % 2 == 0) world.set(any(), anywhere());
        }
        check(tracer, world, rays, -1.0);
    }
}

TEST_CASE_FIXTURE(TraceRays, "of surfaces in one place the same one is hit, whatever came and went before") {
    // Each of another colour.
    const auto sheet = [](std::uint32_t number) {
        Mesh mesh = *soup(50, 1, 0.5F);
        for (Vertex& vertex : mesh.primitives.front().vertices) {
            vertex.colour = {number << 10U, 0, 0, 65535};
        }
        return std::make_shared<const Mesh>(std::move(mesh));
    };
    std::mt19937 random(test_seed(13));
    World world;
    std::vector<Entity> sheets;
    const auto rays = random_rays(50, {0, 0, 0}, 1.0F);
    for (std::uint32_t edit = 0; edit < 30; ++edit) {
        CAPTURE(edit);
        if (sheets.size() < 2 || random() % 2 == 0) {
            sheets.push_back(add(world, MeshInstance{sheet(edit)}));
        } else if (random() % 2 == 0) {
            // Moves the last component of the pool into the gap.
            world.destroy(sheets.front());
            sheets.erase(sheets.begin());
        } else {
            world.set(sheets[random() % sheets.size()], MeshInstance{sheet(edit)});
        }
        Tracer fresh(context->get_proc());
        const auto hits = tracer.trace(world, rays);
        const auto wanted = fresh.trace(world, rays);
        std::size_t count = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            CHECK(hits[i].t == wanted[i].t);
            CHECK(hits[i].colour == wanted[i].colour);
            count += std::isfinite(hits[i].t) ? 1 : 0;
        }
        CHECK(count > 0);
    }
}

}  // TEST_SUITE("compute tracer")
