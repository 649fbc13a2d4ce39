// The cost of World, by operation, with 10³ and 10⁶ entities, beside that of EnTT where CMake finds it. EnTT
// does not track changes. `per_entity` is the relevant figure.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <candela/ecs/world.hpp>
#include "tests/study/study.hpp"

#if CANDELA_ENTT
#include <entt/entt.hpp>
#endif

namespace {

using namespace candela;

struct Position {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
    bool operator==(const Position&) const = default;
};
struct Velocity {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
    bool operator==(const Velocity&) const = default;
};

/// World, as the benchmarks use it.
struct Candela {
    using Id = Entity;
    World world;

    Id create() { return world.create(); }
    void destroy(Id id) { world.destroy(id); }
    template <class C>
    void set(Id id, const C& value) {
        world.set(id, value);
    }
    template <class C>
    void remove(Id id) {
        world.remove<C>(id);
    }
    [[nodiscard]] const Position& get(Id id) const { return world.get<Position>(id); }
    [[nodiscard]] const Position* find(Id id) const { return world.find<Position>(id); }
    auto storage() { return world.storage<Position>(); }
    template <class... Cs>
    void visit(auto&& each) const {
        for (const auto& row : world.view<Cs...>()) std::apply(each, row);
    }
};

#if CANDELA_ENTT
struct Entt {
    using Id = entt::entity;
    entt::registry registry;

    struct Storage {
        entt::storage<Position>& of;
        void set(Id id, const Position& value) {
            if (of.contains(id)) {
                of.patch(id, [&](Position& position) { position = value; });
            } else {
                of.emplace(id, value);
            }
        }
        [[nodiscard]] const Position& get(Id id) const { return of.get(id); }
        [[nodiscard]] const Position* find(Id id) const { return of.contains(id) ? &of.get(id) : nullptr; }
    };

    Id create() { return registry.create(); }
    void destroy(Id id) { registry.destroy(id); }
    template <class C>
    void set(Id id, const C& value) {
        registry.emplace_or_replace<C>(id, value);
    }
    template <class C>
    void remove(Id id) {
        registry.remove<C>(id);
    }
    [[nodiscard]] const Position& get(Id id) const { return registry.get<Position>(id); }
    [[nodiscard]] const Position* find(Id id) const { return registry.try_get<Position>(id); }
    Storage storage() { return {registry.storage<Position>()}; }
    template <class... Cs>
    void visit(auto&& each) const {
        for (const auto& row : registry.view<const Cs...>().each()) std::apply(each, row);
    }
};
#endif

Position position(std::size_t i) {
    return {static_cast<float>(i), 1.0F, 2.0F};
}

/// Entities that have both components.
template <class Host>
struct Populated {
    explicit Populated(benchmark::State& state) {
        for (std::int64_t i = 0; i < state.range(0); ++i) {
            ids.push_back(host.create());
            host.set(ids.back(), position(ids.size()));
            host.set(ids.back(), Velocity{});
        }
    }

    Host host;
    std::vector<typename Host::Id> ids;
};

/// Times `step()` alone, and calls `reset()` after each time.
void time_steps(benchmark::State& state, auto&& step, auto&& reset) {
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        step();
        benchmark::ClobberMemory();
        state.SetIterationTime(
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        reset();
    }
    state.counters["per_entity"] =
        benchmark::Counter(static_cast<double>(state.range(0)),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Host>
void create(benchmark::State& state) {
    Host host;
    const auto step = [&] {
        for (std::int64_t i = 0; i < state.range(0); ++i) benchmark::DoNotOptimize(host.create());
    };
    time_steps(state, step, [&] { host = Host(); });
}

template <class Host>
void destroy(benchmark::State& state) {
    auto populated = std::make_unique<Populated<Host>>(state);
    const auto step = [&] {
        for (const auto id : populated->ids) populated->host.destroy(id);
    };
    time_steps(state, step, [&] { populated = std::make_unique<Populated<Host>>(state); });
}

/// The pool keeps its capacity.
template <class Host>
void set_new(benchmark::State& state) {
    Populated<Host> populated(state);
    const auto remove_all = [&] {
        for (const auto id : populated.ids) populated.host.template remove<Position>(id);
    };
    remove_all();
    const auto step = [&] {
        std::size_t i = 0;
        for (const auto id : populated.ids) populated.host.set(id, position(++i));
    };
    time_steps(state, step, remove_all);
}

/// Sets all of `to`, a Host or its storage, to other values in each step.
void set_all(benchmark::State& state, auto& to, const auto& ids, std::size_t growth) {
    std::size_t first = 0;
    const auto step = [&] {
        std::size_t i = first;
        for (const auto id : ids) to.set(id, position(++i));
    };
    time_steps(state, step, [&] { first += growth; });
}

template <class Host>
void set_changed(benchmark::State& state) {
    Populated<Host> populated(state);
    set_all(state, populated.host, populated.ids, 1);
}

template <class Host>
void set_equal(benchmark::State& state) {
    Populated<Host> populated(state);
    set_all(state, populated.host, populated.ids, 0);
}

template <class Host>
void set_changed_in_storage(benchmark::State& state) {
    Populated<Host> populated(state);
    auto storage = populated.host.storage();
    set_all(state, storage, populated.ids, 1);
}

/// Does not sum: where the sum is kept would decide on the time.
void read_all(benchmark::State& state, const auto& ids, auto&& read) {
    const auto step = [&] {
        for (const auto id : ids) benchmark::DoNotOptimize(read(id));
    };
    time_steps(state, step, [] {});
}

template <class Host>
void get(benchmark::State& state) {
    const Populated<Host> populated(state);
    read_all(state, populated.ids, [&](auto id) { return populated.host.get(id).x; });
}

float x_of(const Position* position) {
    return position ? position->x : 0.0F;
}

template <class Host>
void find(benchmark::State& state) {
    const Populated<Host> populated(state);
    read_all(state, populated.ids, [&](auto id) { return x_of(populated.host.find(id)); });
}

template <class Host>
void get_in_storage(benchmark::State& state) {
    Populated<Host> populated(state);
    const auto storage = populated.host.storage();
    read_all(state, populated.ids, [&](auto id) { return storage.get(id).x; });
}

template <class Host>
void find_in_storage(benchmark::State& state) {
    Populated<Host> populated(state);
    const auto storage = populated.host.storage();
    read_all(state, populated.ids, [&](auto id) { return x_of(storage.find(id)); });
}

template <class Host>
void iterate_one(benchmark::State& state) {
    const Populated<Host> populated(state);
    const auto step = [&] {
        float total = 0.0F;
        populated.host.template visit<Position>([&](auto, const Position& at) { total += at.x; });
        benchmark::DoNotOptimize(total);
    };
    time_steps(state, step, [] {});
}

template <class Host>
void iterate_two(benchmark::State& state) {
    const Populated<Host> populated(state);
    const auto step = [&] {
        float total = 0.0F;
        populated.host.template visit<Position, Velocity>(
            [&](auto, const Position& at, const Velocity& by) { total += at.x + by.x; });
        benchmark::DoNotOptimize(total);
    };
    time_steps(state, step, [] {});
}

template <class Host>
void add(const std::string& host) {
    const auto add_one = [&](const char* name, void (*function)(benchmark::State&)) {
        benchmark::RegisterBenchmark((name + ("/" + host)).c_str(), function)
            ->Arg(1'000)
            ->Arg(1'000'000)
            ->UseManualTime();
    };
    add_one("create", create<Host>);
    add_one("destroy", destroy<Host>);
    add_one("set_new", set_new<Host>);
    add_one("set_changed", set_changed<Host>);
    add_one("set_equal", set_equal<Host>);
    add_one("get", get<Host>);
    add_one("find", find<Host>);
    add_one("set_changed_in_storage", set_changed_in_storage<Host>);
    add_one("get_in_storage", get_in_storage<Host>);
    add_one("find_in_storage", find_in_storage<Host>);
    add_one("iterate_one", iterate_one<Host>);
    add_one("iterate_two", iterate_two<Host>);
}

}  // namespace

int candela::study::world(int count, char** arguments) {
    benchmark::ClearRegisteredBenchmarks();  // those of `graph`
    add<Candela>("candela");
#if CANDELA_ENTT
    add<Entt>("entt");
#endif
    return run_benchmarks(count, arguments);
}
