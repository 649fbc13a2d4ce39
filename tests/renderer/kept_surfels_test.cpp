// Surfels that stay keep what rays have found for them: which slots they have, which rays are traced again,
// and that nothing depends on what was there before.

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gl/graph_backend.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/surfels/surfel_maps.hpp"
#include "renderer/passes/surfels/surfel_visibility.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

TEST_SUITE("surfels: kept") {

using namespace candela;

namespace {

using Ids = std::vector<std::uint64_t>;

constexpr std::uint32_t on_a_side = 3;
constexpr std::uint32_t on_a_wall = on_a_side * on_a_side;
constexpr std::uint32_t in_the_box = 6 * on_a_wall;

/// Surfel `id` of those on the walls of the box from -1 to 1: wall by wall, with a cell of one point.
gpu::CellPoint cell_in_box(std::uint64_t id) {
    const auto wall = static_cast<int>(id / on_a_wall);
    const auto place = static_cast<std::uint32_t>(id % on_a_wall);
    const auto along = [](std::uint32_t i) {
        return (static_cast<float>(i) + 0.5F) / static_cast<float>(on_a_side) * 2.0F - 1.0F;
    };
    gpu::CellPoint point{};
    point.normal[wall / 2] = wall % 2 == 0 ? 1.0F : -1.0F;
    point.position = -point.normal;
    point.position[(wall / 2 + 1) % 3] = along(place % on_a_side);
    point.position[(wall / 2 + 2) % 3] = along(place / on_a_side);
    point.area = 4.0F / on_a_wall;
    return point;
}

SurfelSet set_of(const Ids& ids) {
    SurfelSet set;
    set.ids = ids;
    for (std::uint32_t i = 0; i < ids.size(); ++i) {
        gpu::CellPoint point = cell_in_box(ids[i]);
        point.surfel = i;
        set.points.push_back(point);
        gpu::Surfel surfel{};
        surfel.position = point.position;
        surfel.normal = point.normal;
        surfel.first_point = i;
        surfel.point_count = 1;
        surfel.area = point.area;
        surfel.seed = static_cast<std::uint32_t>(ids[i]);
        set.surfels.push_back(surfel);
    }
    return set;
}

Surfels add_given_surfels(FrameGraph& graph, const Gpu& gpu, ValueHandle<Ids> given) {
    return graph.add("surfels", [&](Pass& pass) {
        pass.read(given);
        const Surfels out{.counts = pass.write(graph.value<VplCounts>("counts")),
                          .point_count = pass.write(graph.value<std::uint32_t>("point count")),
                          .ids = pass.write(graph.value<Ids>("ids")),
                          .maps = {},
                          .surfels = pass.write(growing_buffer<gpu::Surfel>(graph, "surfels"), Usage::copy),
                          .points = pass.write(growing_buffer<gpu::CellPoint>(graph, "points"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) {
            const SurfelSet set = set_of(run.value(given));
            const auto count = static_cast<std::uint32_t>(set.surfels.size());
            upload<gpu::Surfel>(gpu, run, out.surfels, set.surfels);
            upload<gpu::CellPoint>(gpu, run, out.points, set.points);
            run.set(out.counts, VplCounts{.traced = 0, .surfels = count, .emitters = 0, .sky_patches = 0});
            run.set(out.point_count, count);
            run.set(out.ids, set.ids);
        });
        return out;
    });
}

/// Form factors and cover of surfels.
struct Found {
    std::vector<std::vector<std::uint16_t>> factors;  ///< half floats, by two surfels
    std::vector<std::vector<std::uint32_t>> cover;    ///< hits by surfel and part of its rays
    bool operator==(const Found&) const = default;
};

/// The pass `surfel-visibility` alone.
class Visibility {
 public:
    explicit Visibility(const gl::GetProc& get_proc)
        : gpu_(get_proc, gl::ShaderLibrary(gl::embedded_shaders()), {.debug_output = true}) {
        FrameGraph graph;
        const SceneData scene = add_scene_upload(graph, gpu_);
        const Tracing tracing = add_bvh(graph, gpu_, scene);
        epoch_ = graph.import_value<std::uint64_t>("epoch");
        ids_ = graph.import_value<Ids>("given ids");
        const ValueHandle<SceneMotion> motion = add_scene_motion(graph, scene, epoch_);
        const Surfels surfels = add_given_surfels(graph, gpu_, ids_);
        factors_ = add_surfel_visibility(graph, gpu_, tracing, surfels, motion).form_factors;
        cover_ = graph.find_buffer("surfel cover").value().handle;
        graph.add("read back", [&](Pass& pass) {
            pass.read(factors_, Usage::copy);
            pass.read(cover_, Usage::copy);
            pass.side_effect();
        });
        gpu_.programs().compile();
        runtime_.switch_to(compile(std::move(graph)).take());
    }

    Found find(const World& world, const Ids& ids) {
        runtime_.set(ids_, ids);
        runtime_.set(epoch_, epoch_number_);
        runtime_.run(world);
        gpu_.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        return read(static_cast<std::uint32_t>(ids.size()));
    }

    /// The same, with everything traced.
    Found find_anew(const World& world, const Ids& ids) {
        ++epoch_number_;
        return find(world, ids);
    }

    /// Overwrites all results with numbers that rays do not find.
    void mark() {
        const auto fill = [&](ObjectId object, std::uint32_t word) {
            const gl::Buffer& buffer = backend_.buffer(object);
            const std::vector<std::uint32_t> words(buffer.download<std::uint32_t>().size(), word);
            gpu_.gl().NamedBufferSubData(object, 0, static_cast<GLsizeiptr>(4 * words.size()), words.data());
        };
        fill(runtime_.object(factors_), marked_factor | marked_factor << 16U);
        fill(runtime_.object(cover_), marked_hits);
    }
    static constexpr std::uint32_t marked_factor = 0x3c00;  // 1: a cell that fills the hemisphere
    static constexpr std::uint32_t marked_hits = 99;        // of COVER_RAYS = 16

 private:
    Found read(std::uint32_t count) {
        const auto words = backend_.buffer(runtime_.object(factors_)).download<std::uint32_t>();
        const auto hits = backend_.buffer(runtime_.object(cover_)).download<std::uint32_t>();
        Found found{.factors = std::vector(count, std::vector<std::uint16_t>(count)),
                    .cover = std::vector(count, std::vector<std::uint32_t>(COVER_PARTS))};
        for (std::uint32_t row = 0; row < count; ++row) {
            for (std::uint32_t other = 0; other < count; ++other) {
                const std::uint32_t word = words.at(other / 2 * count + row);
                found.factors[row][other] = static_cast<std::uint16_t>(word >> 16U * (other % 2));
            }
            for (std::uint32_t part = 0; part < COVER_PARTS; ++part) {
                found.cover[row][part] = hits.at(row * COVER_PARTS + part);
            }
        }
        return found;
    }

    Gpu gpu_;
    gl::GraphBackend backend_{gpu_.device()};
    GraphRuntime runtime_{backend_};
    ValueHandle<std::uint64_t> epoch_;
    ValueHandle<Ids> ids_;
    BufferHandle<std::uint32_t> factors_;
    BufferHandle<void> cover_;
    std::uint64_t epoch_number_ = 0;
};

Ids shuffled(Ids ids, std::mt19937& engine) {
    std::ranges::shuffle(ids, engine);
    return ids;
}

/// `count` of the ids in the box, in any order.
Ids some_ids(std::size_t count, std::mt19937& engine) {
    Ids ids(in_the_box);
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    ids = shuffled(std::move(ids), engine);
    ids.resize(count);
    return ids;
}

/// Whether a segment from `a` to `b` meets the box: slab test in double precision.
bool meets(const Box& box, const glm::dvec3& a, const glm::dvec3& b) {
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double lower = box.lower[axis] - a[axis], upper = box.upper[axis] - a[axis];
        const double along = b[axis] - a[axis];
        if (along == 0.0) {
            if (lower > 0.0 || upper < 0.0) return false;
            continue;
        }
        enter = std::max(enter, std::min(lower / along, upper / along));
        leave = std::min(leave, std::max(lower / along, upper / along));
    }
    return enter <= leave;
}

/// The slots that surfels have by their cells.
void check_slots(const SurfelMaps& maps, const Ids& cells) {
    const std::set<std::uint32_t> used(maps.slots.begin(), maps.slots.end());
    CHECK(used.size() == cells.size());
    CHECK((used.empty() || *used.rbegin() < cells.size()));
    REQUIRE(maps.cells.size() == cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) CHECK(maps.cells[maps.slots[i]] == cells[i]);
}

class KeptSurfelTests : public RenderFixture {
 protected:
    KeptSurfelTests() : box_(furnace_box(0.5F)) {
        sheet_ = add(box_.world, at({0.0F, 5.0F, 0.0F}),
                     MeshInstance{square(0.4F, diffuse(glm::vec3(0.5F), true))});
    }

    void move_sheet(glm::vec3 place) { box_.world.set(sheet_, at(place)); }

    Scene box_;
    Entity sheet_;
    std::mt19937 engine_{test_seed()};
};

}  // namespace

TEST_CASE("surfels that stay keep their slots, and no two share one") {
    std::mt19937 engine(test_seed());
    SurfelMaps last;
    for (const std::size_t count : {20U, 20U, 31U, 12U, 0U, 40U}) {
        CAPTURE(count);
        const Ids ids = some_ids(count, engine);
        const SurfelMaps maps = assign_slots(ids, &last);
        check_slots(maps, ids);
        for (std::uint32_t slot = 0; slot < last.cells.size(); ++slot) {
            const auto stays = std::ranges::find(ids, last.cells[slot]);
            if (stays != ids.end() && slot < count) CHECK(maps.cells[slot] == last.cells[slot]);
        }
        last = maps;
    }
    CHECK(assign_slots(Ids{7, 5, 9}, nullptr).slots == std::vector<std::uint32_t>{0, 1, 2});
}

TEST_CASE("maps of surfels far from the focus are other ones for each focus") {
    std::vector<gpu::Surfel> surfels(2);
    surfels[1].position.x = 100.0F;
    const Ids ids{1, 2};
    const SurfelMaps first = place_maps(surfels, ids, ids, {glm::vec3(0.0F), 8.0F}, nullptr, 2);
    CHECK(surfels[0].map <= SURFEL_MAP_SLOT);
    CHECK(surfels[1].map > SURFEL_MAP_SLOT);
    const SurfelMaps second = place_maps(surfels, ids, ids, {glm::vec3(1.0F), 8.0F}, &first, 2);
    CHECK(first.keys[0] == second.keys[0]);
    CHECK(first.keys[1] != second.keys[1]);
    static_cast<void>(place_maps(surfels, ids, ids, {}, &second, 2));
    CHECK(surfels[1].map <= SURFEL_MAP_SLOT);
}

TEST_CASE("maps follow a focus a few at a time, and show what they did until then") {
    constexpr std::uint32_t most_new = 3;
    std::vector<gpu::Surfel> surfels(10);
    Ids ids;
    for (gpu::Surfel& surfel : surfels) {
        surfel.position.x = 1000.0F;
        ids.push_back(ids.size() + 1);
    }
    const auto focus_at = [](float x) { return Focus{glm::vec3(x, 0.0F, 0.0F), 8.0F}; };
    const auto focus_of = [](const SurfelMaps& maps, const gpu::Surfel& surfel) {
        return maps.foci.at((surfel.map >> SURFEL_MAP_FOCUS_SHIFT) - 1U);
    };
    SurfelMaps maps = place_maps(surfels, ids, ids, focus_at(0.0F), nullptr, most_new);
    CHECK(maps.outdated == 0);
    for (const std::uint32_t left : {7U, 4U, 1U, 0U}) {
        const SurfelMaps before = maps;
        maps = place_maps(surfels, ids, ids, focus_at(1.0F), &before, most_new);
        CHECK(maps.outdated == left);
        for (const gpu::Surfel& surfel : surfels) {
            const std::uint32_t slot = surfel.map & SURFEL_MAP_SLOT;
            const bool stays = maps.keys[slot] == before.keys[slot];
            CHECK((stays ? focus_of(maps, surfel) == focus_of(before, surfel)
                         : focus_of(maps, surfel) == focus_at(1.0F)));
        }
    }
    std::vector<gpu::Surfel> others = surfels;
    CHECK(maps.keys == place_maps(others, ids, ids, focus_at(1.0F), nullptr, most_new).keys);
    // Each of them is shown by some, until there are more than can be told apart.
    for (int i = 2; i < 12; ++i) {
        const SurfelMaps before = maps;
        maps = place_maps(surfels, ids, ids, focus_at(static_cast<float>(i)), &before, 1);
        std::uint32_t outdated = 0;
        for (const gpu::Surfel& surfel : surfels) {
            CHECK(focus_of(maps, surfel).radius == 8.0F);
            if (focus_of(maps, surfel) != focus_at(static_cast<float>(i))) ++outdated;
        }
        CHECK(outdated == maps.outdated);
        CHECK(outdated < 10);
    }
}

TEST_CASE("what far maps see encloses the focus, and stays while the focus moves a little") {
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> number(-1000.0F, 1000.0F);
    for (const float radius : {0.7F, 4.0F, 1000.0F}) {
        for (int i = 0; i < 100; ++i) {
            const Focus focus{{number(engine), number(engine), number(engine)}, radius};
            const Focus seen = focus_of_maps(std::vector<Focus>{focus});
            CHECK(glm::distance(seen.centre, focus.centre) + radius < seen.radius);
            CHECK(seen.radius <= 4.0F * radius);
        }
        const Focus focus{glm::vec3(0.0F), radius}, aside{glm::vec3(0.2F * radius, 0.0F, 0.0F), radius};
        CHECK(focus_of_maps(std::vector<Focus>{focus}) == focus_of_maps(std::vector<Focus>{aside}));
        CHECK(focus_of_maps(std::vector<Focus>{focus, aside}) == Focus{});
    }
    CHECK(focus_of_maps({}) == Focus{});
}

TEST_CASE("surfels are found by their ids") {
    CHECK(kept_surfels(Ids{5, 6, 7}, Ids{7, 8, 5, 9}).last ==
          std::vector<std::uint32_t>{2, NO_SURFEL, 0, NO_SURFEL});
    CHECK(kept_surfels(Ids{5, 6, 7}, Ids{5, 8, 7}).in_place);
    CHECK_FALSE(kept_surfels(Ids{5, 6, 7}, Ids{6, 5, 7}).in_place);
    CHECK_FALSE(kept_surfels(Ids{5, 6, 7}, Ids{5, 6}).in_place);
}

TEST_CASE_FIXTURE(KeptSurfelTests, "with the same surfels, nothing is traced") {
    Visibility visibility(context->get_proc());
    Ids ids = some_ids(31, engine_);
    const std::uint64_t other = ids.back();
    ids.pop_back();
    static_cast<void>(visibility.find(box_.world, ids));
    visibility.mark();
    ids[0] = other;  // to make the pass run
    const Found found = visibility.find(box_.world, ids);
    for (std::size_t i = 1; i < ids.size(); ++i) {
        for (std::size_t j = 1; j < ids.size(); ++j) {
            CHECK(found.factors[i][j] == Visibility::marked_factor);
        }
        CHECK(found.cover[i] == std::vector<std::uint32_t>(COVER_PARTS, Visibility::marked_hits));
    }
}

TEST_CASE_FIXTURE(KeptSurfelTests, "only rays of new surfels are traced, and all are as from scratch") {
    Visibility visibility(context->get_proc()), anew(context->get_proc());
    move_sheet({0.1F, 0.2F, 0.0F});
    Ids ids = some_ids(30, engine_);
    CHECK(visibility.find(box_.world, ids) == anew.find_anew(box_.world, ids));
    for (const std::size_t stay : {15U, 22U, 0U, 30U}) {
        CAPTURE(stay);
        Ids next = shuffled(ids, engine_);
        next.resize(std::min(stay, next.size()));
        for (const std::uint64_t id : some_ids(in_the_box, engine_)) {
            if (next.size() % 7 == 6 && next.size() > stay) break;
            if (std::ranges::count(ids, id) == 0) next.push_back(id);
        }
        next = shuffled(std::move(next), engine_);
        const Found expected = anew.find_anew(box_.world, next);
        Visibility marked(context->get_proc());
        static_cast<void>(marked.find(box_.world, ids));
        marked.mark();
        const Found with_marks = marked.find(box_.world, next);
        const auto stays = [&](std::size_t i) { return std::ranges::count(ids, next[i]) > 0; };
        for (std::size_t i = 0; i < next.size(); ++i) {
            for (std::size_t j = 0; j < next.size(); ++j) {
                const bool is_kept = stays(i) && stays(j);
                CHECK(with_marks.factors[i][j] ==
                      (is_kept ? Visibility::marked_factor : expected.factors[i][j]));
            }
            CHECK(with_marks.cover[i][0] == (stays(i) ? Visibility::marked_hits : expected.cover[i][0]));
        }
        CHECK(visibility.find(box_.world, next) == expected);
        ids = next;
    }
    ids = shuffled(std::move(ids), engine_);
    CHECK(visibility.find(box_.world, ids) == anew.find_anew(box_.world, ids));
}

TEST_CASE_FIXTURE(KeptSurfelTests, "of many things that move, each has a box of its own") {
    constexpr float half = 0.05F;
    std::vector<Entity> sheets;
    std::vector<Box> boxes;  // at least 0.05 larger, where metres are far more than rays start above surfaces
    for (int i = 0; i < 16; ++i) {
        const auto bit = [&](int b) { return (i >> b & 1) != 0 ? 0.75F : -0.75F; };
        const glm::vec3 place(bit(0), bit(1), bit(2) + ((i >> 3 & 1) != 0 ? 0.15F : -0.15F));
        sheets.push_back(add(box_.world, at(place), MeshInstance{square(half, diffuse(glm::vec3(0.5F)))}));
        boxes.push_back({place - 0.1F, place + 0.1F});
    }
    Box all;
    for (const Box& box : boxes) all.grow(box);
    Visibility visibility(context->get_proc()), anew(context->get_proc());
    const Ids ids = some_ids(in_the_box, engine_);
    static_cast<void>(visibility.find(box_.world, ids));
    for (const Entity sheet : sheets) {
        box_.world.edit<Transform>(sheet, [](Transform& t) { t.translation += glm::vec3(0.01F); });
    }
    visibility.mark();
    const Found found = visibility.find(box_.world, ids);
    const Found expected = anew.find_anew(box_.world, ids);
    std::size_t kept = 0, in_all = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        for (std::size_t j = 0; j < ids.size(); ++j) {
            const glm::dvec3 from(cell_in_box(ids[i]).position), to(cell_in_box(ids[j]).position);
            const auto is_met = [&](const Box& box) { return meets(box, from, to); };
            if (std::ranges::any_of(boxes, is_met)) {
                const std::uint16_t factor = found.factors[i][j];
                CHECK((factor == expected.factors[i][j] || factor == Visibility::marked_factor));
            } else {
                CHECK(found.factors[i][j] == Visibility::marked_factor);
                ++kept;
                if (is_met(all)) ++in_all;
            }
        }
    }
    // Most rays pass between the things.
    CHECK(kept > ids.size() * ids.size() / 2);
    CHECK(in_all > ids.size() * ids.size() / 4);
    CHECK(kept < ids.size() * ids.size());
    CHECK(visibility.find_anew(box_.world, ids) == expected);
}

TEST_CASE_FIXTURE(KeptSurfelTests, "rays between surfels that stay are traced again where something moves") {
    Visibility visibility(context->get_proc()), anew(context->get_proc());
    const Ids ids = some_ids(40, engine_);
    move_sheet({0.0F, 0.95F, 0.0F});
    const Found before = visibility.find(box_.world, ids);
    move_sheet({0.0F, 0.0F, 0.0F});
    Ids next = shuffled(ids, engine_);
    next.resize(33);
    const Found expected = anew.find_anew(box_.world, next);
    CHECK(visibility.find(box_.world, next) == expected);
    // The sheet hides some that were visible.
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < next.size(); ++i) {
        for (std::size_t j = 0; j < next.size(); ++j) {
            const auto last = [&](std::size_t k) { return std::ranges::find(ids, next[k]) - ids.begin(); };
            const auto row = static_cast<std::size_t>(last(i)), column = static_cast<std::size_t>(last(j));
            if (before.factors[row][column] != 0 && expected.factors[i][j] == 0) ++hidden;
        }
    }
    CHECK(hidden > 10);
    // In place.
    move_sheet({0.2F, 0.3F, 0.0F});
    CHECK(visibility.find(box_.world, next) == anew.find_anew(box_.world, next));
}

}  // TEST_SUITE("surfels: kept")
