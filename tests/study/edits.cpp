#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/headless_context.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include "tests/study/bench.hpp"
#include "tests/study/study.hpp"
#include "tests/uploads.hpp"

namespace candela::study {
namespace {

std::shared_ptr<const Material> painted(glm::vec3 albedo, std::uint32_t texture_size = 0) {
    Material material;
    material.base_colour = glm::vec4(albedo, 1.0F);
    if (texture_size > 0) {
        Image image{.width = texture_size, .height = texture_size, .texels = {}};
        for (std::uint32_t i = 0; i < texture_size * texture_size; ++i) {
            image.texels.emplace_back(i % 251, i % 241, i % 239, 255);
        }
        material.base_colour_texture = std::make_shared<const Image>(std::move(image));
    }
    return std::make_shared<const Material>(std::move(material));
}

/// A sphere of radius 1 with 2 · rings · rings triangles.
std::shared_ptr<const Mesh> sphere(std::uint32_t rings, std::shared_ptr<const Material> material) {
    Primitive primitive{.vertices = {}, .indices = {}, .material = std::move(material)};
    for (std::uint32_t i = 0; i <= rings; ++i) {
        for (std::uint32_t j = 0; j <= rings; ++j) {
            const glm::vec2 uv = glm::vec2(j, i) / static_cast<float>(rings);
            const float around = 6.2831853F * uv.x, down = 3.1415927F * uv.y;
            const glm::vec3 at(std::sin(down) * std::cos(around), std::cos(down),
                               -std::sin(down) * std::sin(around));
            primitive.vertices.push_back({at, at, uv});
            if (i < rings && j < rings) {
                const std::uint32_t a = i * (rings + 1) + j, b = a + rings + 1;
                for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) {
                    primitive.indices.push_back(corner);
                }
            }
        }
    }
    return std::make_shared<const Mesh>(Mesh{"sphere", {std::move(primitive)}});
}

Entity place(World& world, const std::shared_ptr<const Mesh>& mesh, glm::vec3 at, float size) {
    const Entity entity = world.create();
    world.set(entity, Transform{.translation = at, .scale = glm::vec3(size)});
    world.set(entity, MeshInstance{mesh});
    return entity;
}

/// Where the n-th of a row of things is: on a grid of 32 × 32 per layer, 1 m apart.
glm::vec3 grid_place(std::uint32_t n) {
    return glm::vec3(n % 32, n / 1024, n / 32 % 32) - glm::vec3(16.0F, 0.0F, 48.0F);
}

/// A world with a camera and a lamp.
World studio() {
    World world;
    const Entity camera = world.create();
    world.set(camera, Transform{.translation = {0.0F, 1.0F, 4.0F}});
    world.set(camera, Camera{});
    const Entity lamp = world.create();
    world.set(lamp, Transform{.translation = {0.0F, 20.0F, 0.0F}});
    world.set(lamp, PointLight{.intensity = 500.0F});
    return world;
}

/// A kind of edit: `apply` makes one, on the frame with that number.
struct EditStudy {
    std::string name;
    std::function<void(int)> apply;
};

/// Medians of one kind of edit, by pass, in milliseconds of the CPU.
struct EditCost {
    std::map<std::string, std::vector<double>, std::less<>> passes;
    std::vector<double> all;
    std::uint64_t bytes = 0;
};

/// Whether the pass works on the CPU for every edit of the scene, and not for the picture.
bool is_of_scene(std::string_view pass) {
    static constexpr std::array names{"scene-gather", "scene-upload", "instance-upload",
                                      "bvh",          "scene-motion", "lights",
                                      "view-cull",    "refinement",   "shadow-plan"};
    return std::ranges::find(names, pass) != names.end();
}

EditCost measure_edit(Bench& bench, const EditStudy& edit, int rounds) {
    EditCost cost;
    for (int round = 0; round < 2 * rounds; ++round) {
        bench.frame({});
        edit.apply(round);
        static_cast<void>(Uploads::take());
        bench.frame({});
        cost.bytes = Uploads::take();
        double sum = 0.0;
        for (const PassRecord& pass : bench.renderer().last_passes()) {
            if (pass.ran && is_of_scene(pass.name)) {
                cost.passes[std::string(pass.name)].push_back(pass.cpu_ms);
                sum += pass.cpu_ms;
            }
        }
        cost.all.push_back(sum);
    }
    return cost;
}

void print_costs(Bench& bench, const std::vector<EditStudy>& edits, int rounds) {
    for (const EditStudy& edit : edits) {
        const EditCost cost = measure_edit(bench, edit, rounds);
        fmt::print("  {}: {:.3f} ms, {} bytes uploaded;", edit.name, median(cost.all), cost.bytes);
        for (const auto& [pass, times] : cost.passes) {
            fmt::print(" {} {:.3f}", pass, median(times));
        }
        fmt::print("\n");
    }
}

Configuration direct_light() {
    Configuration configuration;
    configuration.indirect = false;
    configuration.refinement.enabled = false;
    return configuration;
}

/// Adds and removes a box beside four textures.
void study_textures(const gl::GetProc& get_proc, int rounds) {
    World world = studio();
    for (std::uint32_t i = 0; i < 4; ++i) {
        place(world, sphere(8, painted(glm::vec3(1.0F), 2048)), grid_place(i), 0.4F);
    }
    const auto box = sphere(2, painted({0.5F, 0.2F, 0.2F}));
    Entity added{};
    Bench bench(get_proc, world, {64, 48});
    bench.configure(direct_light());
    fmt::print("four textures of 2,048 x 2,048:\n");
    const auto toggle = [&](int round) {
        if (round % 2 == 0) {
            added = place(world, box, {0.0F, 0.0F, -2.0F}, 0.4F);
        } else {
            world.destroy(added);
        }
    };
    print_costs(bench, {{"a box comes or goes", toggle}}, rounds);
}

/// Moves, adds and removes things in a scene of a million triangles.
void study_crowd(const gl::GetProc& get_proc, int rounds) {
    World world = studio();
    const auto large = sphere(71, painted(glm::vec3(0.5F)));
    const auto small = sphere(2, painted({0.5F, 0.2F, 0.2F}));
    for (std::uint32_t i = 0; i < 100; ++i) {
        place(world, large, grid_place(i), 0.4F);
    }
    std::vector<Entity> crowd{place(world, small, {0.0F, 0.0F, -2.0F}, 0.4F)};
    Bench bench(get_proc, world, {64, 48});
    bench.configure(direct_light());
    const auto move = [&](int round) {
        for (const Entity entity : crowd) {
            world.edit<Transform>(entity, [&](Transform& pose) {
                pose.translation.y += round % 2 == 0 ? 0.3F : -0.3F;
                pose.rotation = glm::angleAxis(0.1F * static_cast<float>(round), glm::vec3(0, 1, 0));
            });
        }
    };
    fmt::print("100 things of 10,082 triangles and a small one:\n");
    print_costs(bench, {{"the small one moves", move}}, rounds);
    const auto toggle = [&](int round) {
        if (round % 2 == 0) {
            crowd.push_back(place(world, small, {0.5F, 0.0F, -2.0F}, 0.4F));
        } else {
            world.destroy(crowd.back());
            crowd.pop_back();
        }
    };
    print_costs(bench, {{"another small one comes or goes", toggle}}, rounds);

    const auto cloth = sphere(71, painted({0.2F, 0.2F, 0.5F}));
    const Entity waving = place(world, cloth, {0.0F, 1.0F, -2.0F}, 0.4F);
    const auto deform = [&](int round) {
        DeformedMesh::Vertices vertices{cloth->primitives.front().vertices};
        for (Vertex& vertex : vertices.front()) {
            vertex.position.y += 0.1F * std::sin(5.0F * vertex.position.x + static_cast<float>(round));
        }
        world.set(waving, DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(std::move(vertices))});
    };
    print_costs(bench, {{"one of 10,082 triangles is deformed", deform}}, rounds);
    world.destroy(waving);

    fmt::print("with 1,000 small ones:\n");
    const auto toggle_all = [&](int round) {
        if (round % 2 == 0) {
            for (std::uint32_t i = 0; i < 1000; ++i) {
                crowd.push_back(place(world, small, grid_place(1024 + i), 0.2F));
            }
        } else {
            for (const Entity entity : std::exchange(crowd, {})) {
                world.destroy(entity);
            }
        }
    };
    print_costs(bench, {{"all come or go", toggle_all}}, rounds);
    toggle_all(0);
    print_costs(bench, {{"all move", move}}, rounds);
}

/// `count` edits at a time in a wide world of so many things.
void study_world(const gl::GetProc& get_proc, int rounds, std::uint32_t things) {
    World world = studio();
    const Entity camera = world.entities<Camera>().front();
    const auto small = sphere(2, painted({0.5F, 0.2F, 0.2F}));
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(things)));
    const auto at = [&](std::uint32_t n) {
        return glm::vec3(n % side, 0.0F, n / side) - 0.5F * glm::vec3(side, 2.0F, side);
    };
    std::vector<Entity> all;
    for (std::uint32_t i = 0; i < things; ++i) all.push_back(place(world, small, at(i), 0.3F));
    std::vector<Entity> added;

    Bench bench(get_proc, world, {64, 48});
    bench.configure(direct_light());
    fmt::print("{} things:\n", things);
    const auto add_places = [&](int) { world.set(world.create(), Transform{}); };
    const auto turn = [&](int) {
        world.edit<Transform>(camera, [](Transform& pose) {
            pose.rotation = glm::angleAxis(0.02F, glm::vec3(0, 1, 0)) * pose.rotation;
        });
    };
    std::vector<EditStudy> edits{{"an entity with a transform alone is added", add_places},
                                 {"the camera turns", turn}};
    for (const std::uint32_t count : {1U, 10U, 100U, 1000U}) {
        if (count > things) continue;
        const auto move = [&, count](int round) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const Entity entity =
                    all[(std::uint64_t{i} * things / count + 7 * static_cast<std::uint32_t>(round)) % things];
                world.edit<Transform>(entity, [](Transform& pose) { pose.translation.y += 0.1F; });
            }
        };
        const auto toggle = [&, count](int round) {
            for (std::uint32_t i = 0; i < count && round % 2 == 0; ++i) {
                added.push_back(place(world, small, at(things + i), 0.3F));
            }
            if (round % 2 == 0) return;
            for (const Entity entity : std::exchange(added, {})) world.destroy(entity);
        };
        edits.push_back({fmt::format("{} moved", count), move});
        edits.push_back({fmt::format("{} came or went", count), toggle});
    }
    print_costs(bench, edits, rounds);
}

}  // namespace

int edits(const EditsStudy& study) {
    const auto context = HeadlessContext::create(ContextKind::egl);
    context->make_current();
    const gl::GetProc get_proc = Uploads::counting(context->get_proc());
    fmt::print("CPU time of the scene's passes after an edit, medians of {} rounds\n", 2 * study.rounds);
    for (const std::uint32_t things : study.things) study_world(get_proc, study.rounds, things);
    if (!study.things.empty()) return 0;
    study_textures(get_proc, study.rounds);
    study_crowd(get_proc, study.rounds);
    return 0;
}

}  // namespace candela::study
