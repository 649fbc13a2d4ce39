#include "renderer/passes/vpl_schedule.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "tests/seed.hpp"

using namespace candela;

namespace {

constexpr std::uint32_t count = 120;
constexpr ScheduleSettings limits{.budget = 8, .tiles = count, .maps = true};

LightTable::Entry point_light(std::uint32_t entity, float flux, glm::vec3 position = glm::vec3(0.0F)) {
    return {.entity = {entity, 1},
            .light = {.position = position, .kind = gpu::LightKind::point},
            .flux = glm::vec3(flux)};
}

VplPaths plan_for(const LightTable& lights, std::uint32_t seed = 0) {
    return plan_paths(lights, 0.5F, {.count = count, .bounces = 3, .seed = seed});
}

/// Paths all hold where they were, at random places of the light.
VplChecks all_hold(const VplPaths& plan) {
    VplChecks checks;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    for (const gpu::Path& path : plan.paths) {
        const float x = uniform(random);
        const glm::vec2 start(x, uniform(random));
        checks.paths.push_back({.bounces = path.vpl_count, .start = start, .canonical_start = start});
    }
    return checks;
}

std::uint32_t traced(const VplMemory& memory) {
    std::uint32_t bounces = 0;
    for (const gpu::Path& path : memory.paths.paths) bounces += path.bounces - path.kept;
    return bounces;
}

/// Share of a light's flux that its paths carry into a bounce, counted from 0.
double weight_at(const VplPaths& paths, std::uint32_t light, std::uint32_t bounce) {
    double sum = 0.0;
    for (const gpu::Path& path : paths.paths) {
        if (path.light == light && path.bounces > bounce) {
            sum += static_cast<double>(paths.places[path.first_vpl + bounce].weight);
        }
    }
    return sum;
}

/// What every schedule must keep to.
void check_schedule(const VplMemory& memory, const VplPaths& plan, const ScheduleSettings& settings) {
    const VplPaths& paths = memory.paths;
    CHECK(traced(memory) <= settings.budget);
    CHECK(paths.maps_due.size() <= settings.budget);
    std::set<std::uint32_t> tiles;
    std::uint32_t missing = 0;
    for (const gpu::Path& path : paths.paths) {
        CHECK(path.kept <= path.bounces);
        CHECK(path.bounces <= path.vpl_count);
        missing += path.vpl_count - path.bounces;
        for (std::uint32_t bounce = 0; bounce < path.bounces; ++bounce) {
            const gpu::VplPlace& place = paths.places[path.first_vpl + bounce];
            CHECK(place.weight >= 0.0F);
            CHECK(place.tile < paths.map_count);
            CHECK(tiles.insert(place.tile).second);  // nobody shares a tile
        }
    }
    CHECK(paths.debt >= missing);
    CHECK(paths.vpl_count == plan.vpl_count);
    for (const std::uint32_t place : paths.maps_due) CHECK(place < paths.vpl_count);
}

struct Fixture {
    LightTable lights{{point_light(3, 1.0F), point_light(5, 2.0F)}};
    VplPaths plan = plan_for(lights);
    VplMemory memory = schedule_all(plan, lights, limits);

    VplMemory next(const VplChecks& checks) const {
        const VplPaths now = plan_for(lights);
        VplMemory result = schedule(now, lights, memory, checks, limits);
        check_schedule(result, now, limits);
        return result;
    }
    /// Flux of the light whose path has this place.
    float mean_flux(std::uint32_t place) const {
        const auto path = std::ranges::upper_bound(plan.paths, place, {}, &gpu::Path::first_vpl) - 1;
        return path->flux.x;
    }
    /// Until nothing is left to do; gives how many schedules that took.
    std::uint32_t settle() {
        std::uint32_t rounds = 0;
        while (memory.paths.debt + memory.paths.stale > 0) {
            memory = next({});
            REQUIRE(++rounds < 1000);
        }
        return rounds;
    }
};

}  // namespace

TEST_SUITE("vpl schedule") {
    TEST_CASE_FIXTURE(Fixture, "at first all is traced and drawn, whatever the budget") {
        CHECK(traced(memory) == plan.vpl_count);
        CHECK(memory.paths.maps_due.size() == plan.vpl_count);
        CHECK(memory.paths.debt == 0);
        CHECK(memory.paths.stale == 0);
        // And then nothing, but the same light.
        const VplMemory second = next({});
        CHECK(traced(second) == 0);
        CHECK(second.paths.maps_due.empty());
        CHECK(second.paths.places == memory.paths.places);
    }

    TEST_CASE_FIXTURE(Fixture, "what no longer holds is dropped at once and comes back under the budget") {
        VplChecks checks = all_hold(plan);
        std::uint32_t dropped = 0;
        for (std::size_t i = 0; i < plan.paths.size(); i += 3) {
            dropped += plan.paths[i].vpl_count;
            checks.paths[i].bounces = 0;
        }
        REQUIRE(dropped > 3 * limits.budget);
        memory = next(checks);
        for (std::size_t i = 0; i < plan.paths.size(); ++i) {
            const gpu::Path& path = memory.paths.paths[i];
            CHECK(path.kept == (i % 3 == 0 ? 0 : path.vpl_count));
        }
        CHECK(memory.paths.debt == dropped - traced(memory));
        // The light stands still: paths come back at their points of the sequence.
        CHECK(memory.paths.stale == 0);
        // Those present carry all the flux: 1 up to rounding of a hundred floats, at each bounce what the
        // plan has.
        for (const std::uint32_t light : {0U, 1U}) {
            for (const std::uint32_t bounce : {0U, 1U, 2U}) {
                CHECK(weight_at(memory.paths, light, bounce) ==
                      doctest::Approx(weight_at(plan, light, bounce)).epsilon(1e-5));
            }
        }
        // A path of three bounces that does not fit leaves at most two unused.
        CHECK(settle() <= (dropped + limits.budget - 3) / (limits.budget - 2));
        CHECK(std::ranges::equal(memory.paths.places, plan.places, {}, &gpu::VplPlace::weight,
                                 &gpu::VplPlace::weight));
    }

    TEST_CASE_FIXTURE(Fixture, "a path that is cut keeps what lies before the cut") {
        VplChecks checks = all_hold(plan);
        const auto longest =
            std::ranges::max_element(plan.paths, {}, &gpu::Path::vpl_count) - plan.paths.begin();
        const auto i = static_cast<std::size_t>(longest);
        REQUIRE(plan.paths[i].vpl_count == 3);
        checks.paths[i].bounces = 1;
        const VplMemory after = next(checks);
        CHECK(after.paths.paths[i].kept == 1);
        CHECK(after.paths.paths[i].bounces == 3);
        CHECK(traced(after) == 2);
        CHECK(after.paths.maps_due.size() == 2);
        CHECK(after.paths.debt == 0);
        CHECK(after.paths.stale == 0);
    }

    TEST_CASE_FIXTURE(Fixture, "while one light moves, the other's paths are not touched") {
        lights.entries[0].light.position = {1, 0, 0};
        VplChecks checks = all_hold(plan);
        checks.paths[0].bounces = 0;
        const VplMemory after = next(checks);
        for (std::size_t i = 0; i < plan.paths.size(); ++i) {
            const gpu::Path& path = after.paths.paths[i];
            if (path.light == 0) continue;
            CHECK(path.kept == path.vpl_count);
            CHECK(after.memories[i].canonical);
            for (std::uint32_t b = 0; b < path.vpl_count; ++b) {
                CHECK(after.paths.places[path.first_vpl + b] == memory.paths.places[path.first_vpl + b]);
            }
        }
        // The new path of the moving light starts at a place of its own.
        CHECK(after.paths.paths[0].bounces > 0);
        CHECK(after.paths.paths[0].start.x >= 0.0F);
        CHECK_FALSE(after.memories[0].canonical);
    }

    TEST_CASE_FIXTURE(Fixture, "a light at rest comes back to its sequence within VPLs / budget rounds") {
        lights.entries[0].light.position = {1, 0, 0};
        memory = next(all_hold(plan));
        CHECK(memory.paths.stale > 0);
        const std::uint32_t rounds = settle();
        CHECK(rounds <= (count + limits.budget - 1) / limits.budget);
        CHECK(std::ranges::equal(memory.paths.places, plan.places, {}, &gpu::VplPlace::weight,
                                 &gpu::VplPlace::weight));
    }

    TEST_CASE_FIXTURE(Fixture, "paths of other sequences serve on, and give way within the budget") {
        const VplPaths others = plan_for(lights, 1);
        memory = schedule_all(others, lights, limits);
        VplChecks checks = all_hold(plan);
        const auto longest =
            std::ranges::max_element(plan.paths, {}, &gpu::Path::vpl_count) - plan.paths.begin();
        const auto cut = static_cast<std::size_t>(longest);
        checks.paths[cut].bounces = 1;
        memory = next(checks);
        CHECK(memory.paths.debt == 0);
        CHECK(memory.paths.stale >= plan.vpl_count - limits.budget);
        std::uint32_t kept = 0;
        for (std::size_t i = 0; i < plan.paths.size(); ++i) {
            // One that is cut goes on by the sequence that it was begun by; it would not hold together else.
            const bool old = memory.paths.paths[i].kept > 0;
            CHECK(memory.paths.paths[i].seed == (old ? others : plan).paths[i].seed);
            CHECK(memory.memories[i].canonical == !old);
            CHECK(memory.memories[i].canonical_start == checks.paths[i].canonical_start);
            kept += old ? 1 : 0;
        }
        CHECK(memory.paths.paths[cut].kept == 1);
        CHECK(kept < plan.paths.size());
        CHECK(settle() <= (count + limits.budget - 3) / (limits.budget - 2));
        for (std::size_t i = 0; i < plan.paths.size(); ++i) {
            CHECK(memory.paths.paths[i].seed == plan.paths[i].seed);
        }
        CHECK(std::ranges::equal(memory.paths.places, plan.places, {}, &gpu::VplPlace::weight,
                                 &gpu::VplPlace::weight));
    }

    TEST_CASE_FIXTURE(Fixture, "a light that goes leaves its share at once, in which place ever it stood") {
        lights.entries.erase(lights.entries.begin());
        const VplPaths now = plan_for(lights);
        memory = next(all_hold(now));
        CHECK(std::ranges::all_of(memory.paths.paths, [](const gpu::Path& path) { return path.light == 0; }));
        CHECK(memory.paths.paths.size() == now.paths.size());
        // The light that stays carries its flux on the paths that it had, and soon on all.
        CHECK(weight_at(memory.paths, 0, 0) == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(memory.paths.debt > 0);
        settle();
        CHECK(std::ranges::equal(memory.paths.places, now.places, {}, &gpu::VplPlace::weight,
                                 &gpu::VplPlace::weight));
    }

    TEST_CASE_FIXTURE(Fixture, "no lights, and lights again") {
        const LightTable before = lights;
        lights.entries.clear();
        memory = next({});
        CHECK(memory.paths.paths.empty());
        CHECK(memory.paths.debt == 0);
        lights = before;
        memory = next(all_hold(plan));
        CHECK(traced(memory) > 0);
        settle();
        CHECK(memory.paths.vpl_count == plan.vpl_count);
    }

    TEST_CASE_FIXTURE(Fixture, "maps that may show what moved are redrawn, the strongest first, others not") {
        VplChecks checks = all_hold(plan);
        checks.moved = {{.lower = {-1, 1, -1}, .upper = {1, 2, 1}}};
        std::uint32_t facing = 0;
        for (std::uint32_t tile = 0; tile < count; ++tile) {
            // Every other looks up to the box; of those every third is no VPL.
            const bool looks = tile % 2 == 0;
            const float throughput = tile % 3 == 0 ? 0.0F : 0.1F + 0.001F * static_cast<float>(tile);
            checks.records.push_back({.position = glm::vec3(0.0F),
                                      .normal = {0, looks ? 1.0F : -1.0F, 0},
                                      .throughput = throughput});
            facing += looks && throughput > 0.0F && tile < plan.vpl_count ? 1 : 0;
        }
        memory = next(checks);
        CHECK(traced(memory) == 0);
        REQUIRE(memory.paths.maps_due.size() == limits.budget);
        CHECK(memory.paths.debt == facing - limits.budget);
        const auto strength = [&](std::uint32_t place) {
            return memory.paths.places[place].weight * checks.records[place].throughput;
        };
        float weakest_drawn = 1e9F;
        for (const std::uint32_t place : memory.paths.maps_due) {
            CHECK(place % 2 == 0);
            CHECK(place % 3 != 0);
            weakest_drawn = std::min(weakest_drawn, mean_flux(place) * strength(place));
        }
        for (const gpu::Path& path : memory.paths.paths) {
            for (std::uint32_t place = path.first_vpl; place < path.first_vpl + path.vpl_count; ++place) {
                const bool due = std::ranges::count(memory.paths.maps_due, place) > 0;
                if (due || place % 2 != 0 || place % 3 == 0) continue;
                CHECK(mean_flux(place) * strength(place) <= weakest_drawn);
            }
        }
        CHECK(settle() == (facing - limits.budget + limits.budget - 1) / limits.budget);
    }

    TEST_CASE_FIXTURE(Fixture, "a path longer than the budget is traced whole, in a frame of its own") {
        VplChecks checks = all_hold(plan);
        for (CheckedLength& check : checks.paths) check.bounces = 0;
        const ScheduleSettings small{.budget = 2, .tiles = count, .maps = true};
        memory = schedule(plan, lights, memory, checks, small);
        std::uint32_t rounds = 0;
        while (memory.paths.debt > 0) {
            memory = schedule(plan, lights, memory, {}, small);
            const auto begun = std::ranges::count_if(
                memory.paths.paths, [](const gpu::Path& path) { return path.kept < path.bounces; });
            if (traced(memory) > small.budget) CHECK(begun == 1);
            REQUIRE(++rounds < 1000);
        }
        CHECK(memory.paths.stale == 0);
    }

    TEST_CASE("any edits keep to the rules, and what is left to do comes to an end" *
              doctest::test_suite("random")) {
        std::mt19937 random(test_seed());
        const auto draw = [&](std::uint32_t choices) {
            return static_cast<std::uint32_t>(random() % choices);
        };
        Fixture f;
        std::uint32_t entity = 10;
        for (int step = 0; step < 400; ++step) {
            auto& entries = f.lights.entries;
            const std::uint32_t what = draw(6);
            if (what == 0 && entries.size() < 6) {
                entries.insert(entries.begin() + draw(static_cast<std::uint32_t>(entries.size()) + 1),
                               point_light(entity++, 0.2F + 0.1F * static_cast<float>(draw(30))));
            } else if (what == 1 && !entries.empty()) {
                entries.erase(entries.begin() + draw(static_cast<std::uint32_t>(entries.size())));
            } else if (what < 4 && !entries.empty()) {
                entries[draw(static_cast<std::uint32_t>(entries.size()))].light.position.x += 0.1F;
            } else if (what == 4 && !entries.empty()) {
                entries[draw(static_cast<std::uint32_t>(entries.size()))].flux *= 1.3F;
            }
            const VplPaths plan = plan_for(f.lights);
            VplChecks checks = all_hold(plan);
            for (CheckedLength& check : checks.paths)
                check.bounces -= draw(8) == 0 ? draw(check.bounces + 1) : 0;
            f.memory = f.next(checks);
            if (step % 50 == 49) f.settle();
        }
    }
}
