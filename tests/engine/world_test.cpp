#include <candela/ecs/world.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <candela/ecs/world_reader.hpp>

TEST_SUITE("world") {

namespace {

using namespace candela;

struct Height {
    int metres = 0;
    bool operator==(const Height&) const = default;
};

struct Label {
    std::string text;
    bool operator==(const Label&) const = default;
};

struct Opaque {
    int value = 0;
};

/// Neither compared nor copied bit by bit.
struct Heavy {
    int value = 0;
    std::shared_ptr<int> copies = std::make_shared<int>(0);

    explicit Heavy(int of) : value(of) {}
    Heavy(const Heavy& other) : value(other.value), copies(other.copies) { ++*copies; }
    Heavy(Heavy&&) noexcept = default;
    Heavy& operator=(const Heavy& other) { return *this = Heavy(other); }
    Heavy& operator=(Heavy&&) noexcept = default;
    ~Heavy() = default;
};

template <class T>
struct Tagged {};

static_assert(component_name<Height>() == "Height");
static_assert(component_name<int>() == "int");
static_assert(component_name<Tagged<int>>() == "Tagged<int>");
static_assert(std::forward_iterator<View<Height, Label>::Iterator>);
static_assert(std::is_copy_constructible_v<World> && std::is_nothrow_move_constructible_v<World>);

std::string message_of(const auto& misuse) {
    try {
        misuse();
    } catch (const EntityError& error) {
        return error.what();
    }
    return "no error";
}

template <class... Cs>
std::vector<Entity> entities_of(const World& world) {
    std::vector<Entity> entities;
    for (const auto& row : world.view<Cs...>()) {
        entities.push_back(std::get<Entity>(row));
    }
    return entities;
}

TEST_CASE("world: an entity is alive from creation to destruction") {
    World world;
    CHECK(world.size() == 0);
    const Entity first = world.create();
    const Entity second = world.create();
    CHECK(first);
    CHECK(first != second);
    CHECK(world.alive(first));
    CHECK(world.size() == 2);

    world.destroy(first);
    CHECK_FALSE(world.alive(first));
    CHECK(world.alive(second));
    CHECK(world.size() == 1);
}

TEST_CASE("world: a slot that is used again holds another entity") {
    World world;
    const Entity old = world.create();
    world.set(old, Height{1});
    world.destroy(old);
    const Entity tenant = world.create();
    CHECK(tenant.index == old.index);
    CHECK(tenant.generation != old.generation);
    CHECK_FALSE(world.alive(old));
    CHECK_FALSE(world.has<Height>(tenant));
}

TEST_CASE("world: all functions refuse null, stale and made-up entities") {
    World world;
    const Entity stale = world.create();
    world.destroy(stale);
    const Entity never_let{stale.index, stale.generation + 1};
    const Entity out_of_range{1000, 1};
    for (const Entity entity : {Entity{}, stale, never_let, out_of_range}) {
        CAPTURE(entity.index);
        CAPTURE(entity.generation);
        CHECK_FALSE(world.alive(entity));
        CHECK_THROWS_AS(world.destroy(entity), EntityError);
        CHECK_THROWS_AS(world.set(entity, Height{}), EntityError);
        CHECK_THROWS_AS(world.remove<Height>(entity), EntityError);
        CHECK_THROWS_AS(world.edit<Height>(entity, [](Height&) {}), EntityError);
        CHECK_THROWS_AS((void)world.find<Height>(entity), EntityError);
        CHECK_THROWS_AS((void)world.get<Height>(entity), EntityError);
        CHECK_THROWS_AS((void)world.has<Height>(entity), EntityError);
        CHECK_THROWS_AS((void)world.changed<Height>(entity), EntityError);
    }
    CHECK(world.size() == 0);
    CHECK(world.revision<Height>() == 0);
}

TEST_CASE("world: errors name the entity and the component") {
    World world;
    const Entity entity = world.create();
    CHECK(message_of([&] { (void)world.get<Height>(entity); }) == "entity 0 (generation 1) has no Height");
    world.destroy(entity);
    CHECK(message_of([&] { (void)world.find<Label>(entity); }) ==
          "entity 0 (generation 1) is not alive, so it has no Label");
    CHECK(message_of([&] { world.set(Entity{}, Height{}); }) ==
          "the null entity is not alive, so it has no Height");
}

TEST_CASE("world: a change updates only the ticks of its component and its pool") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    world.set(a, Height{1});
    const Tick first = world.changed<Height>(a);
    world.set(b, Height{2});
    const Tick second = world.changed<Height>(b);
    world.set(a, Label{"a"});
    CHECK(first > 0);
    CHECK(second > first);
    CHECK(world.changed<Height>(a) == first);
    CHECK(world.revision<Height>() == second);
    CHECK(world.revision<Label>() > second);
    CHECK(world.revision() == world.revision<Label>());
    CHECK(world.changed<Label>(b) == 0);
    CHECK(world.revision<Opaque>() == 0);

    world.remove<Height>(b);
    CHECK(world.revision<Height>() > world.revision<Label>());
    CHECK(world.changed<Height>(a) == first);
    CHECK(world.changed<Height>(b) == 0);
}

TEST_CASE("world: no two changes have the same tick, not even in different worlds") {
    World one;
    World other;
    const Entity entity = one.create();
    REQUIRE(other.create() == entity);
    one.set(entity, Height{1});
    other.set(entity, Height{2});
    CHECK(one.revision<Height>() != other.revision<Height>());
    World copy = one;
    CHECK(copy.revision<Height>() == one.revision<Height>());
    one.set(entity, Height{3});
    copy.set(entity, Height{4});
    CHECK(copy.revision<Height>() != one.revision<Height>());
}

TEST_CASE("world: setting an equal value is no change, unless its type cannot be compared") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{1});
    const Tick first = world.changed<Height>(entity);
    world.set(entity, Height{1});
    world.edit<Height>(entity, [](Height& height) { height.metres = 1; });
    CHECK(world.revision<Height>() == first);
    world.edit<Height>(entity, [](Height& height) { height.metres = 2; });
    CHECK(world.revision<Height>() > first);
    CHECK(world.get<Height>(entity).metres == 2);

    world.set(entity, Opaque{1});
    const Tick opaque = world.revision<Opaque>();
    world.set(entity, Opaque{1});
    CHECK(world.revision<Opaque>() > opaque);
}

TEST_CASE("world: an edit that throws changes nothing") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{1});
    const auto fail = [](Height& height) {
        height.metres = 2;
        throw std::runtime_error("no");
    };
    const Tick before = world.revision<Height>();
    CHECK_THROWS_WITH(world.edit<Height>(entity, fail), "no");
    CHECK(world.get<Height>(entity) == Height{1});
    CHECK(world.revision<Height>() == before);
}

TEST_CASE("world: destroying an entity updates only the revisions of the pools that lose a component") {
    World world;
    const Entity entity = world.create();
    const Entity other = world.create();
    world.set(entity, Height{1});
    world.set(entity, Label{"gone"});
    world.set(other, Opaque{1});
    const Tick before = world.revision();
    world.destroy(entity);
    CHECK(world.revision<Height>() > before);
    CHECK(world.revision<Label>() == world.revision<Height>());
    CHECK(world.revision<Opaque>() == before);
    CHECK(world.count<Height>() == 0);
}

TEST_CASE("world: a view walks the smallest pool in its packed order") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 5; ++i) {
        entities.push_back(world.create());
        world.set(entities.back(), Height{i});
    }
    CHECK(entities_of<Height>(world) == entities);

    world.remove<Height>(entities[1]);  // the last one fills the gap
    CHECK(entities_of<Height>(world) == std::vector{entities[0], entities[4], entities[2], entities[3]});

    for (const int i : {3, 1, 0}) {
        world.set(entities[static_cast<std::size_t>(i)], Label{"x"});
    }
    CHECK(entities_of<Height, Label>(world) == std::vector{entities[3], entities[0]});
    CHECK(entities_of<Label, Height>(world) == std::vector{entities[3], entities[0]});
    CHECK(entities_of<Height, Opaque>(world).empty());
}

TEST_CASE("world: views give references to the components themselves") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{7});
    world.set(entity, Label{"seven"});
    for (const auto [seen, height, label] : world.view<Height, Label>()) {
        CHECK(seen == entity);
        CHECK(&height == world.find<Height>(entity));
        CHECK(&label == world.find<Label>(entity));
    }
}

TEST_CASE("world: the changes since a revision are known, of copies that have been through it") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    CHECK(world.changes_since<Height>(0)->empty());
    world.set(a, Height{1});
    const Tick first = world.revision<Height>();
    world.set(b, Height{2});
    world.set(b, Label{"b"});
    world.remove<Height>(a);
    const auto changed = [](const World& in, Tick tick) {
        std::vector<Entity> entities;
        const auto changes = in.changes_since<Height>(tick);
        REQUIRE(changes);
        for (const Change& change : *changes) entities.push_back(change.entity);
        return entities;
    };
    CHECK(changed(world, 0) == std::vector{a, b, a});
    CHECK(changed(world, first) == std::vector{b, a});
    CHECK(changed(world, world.revision<Height>()).empty());

    World copy = world;
    const Tick shared = world.revision<Height>();
    const Tick of_label = world.revision<Label>();
    world.destroy(b);
    copy.set(a, Height{3});
    CHECK(changed(world, shared) == std::vector{b});
    CHECK(changed(copy, shared) == std::vector{a});
    // The copy has never been through the destruction.
    CHECK_FALSE(copy.changes_since<Height>(world.revision<Height>()));
    CHECK_FALSE(world.changes_since<Height>(of_label));
}

TEST_CASE("world: changes are kept for a while only") {
    World world;
    const Entity entity = world.create();
    std::vector<Tick> revisions;
    for (int i = 0; i < 5000; ++i) {
        world.set(entity, Height{i});
        revisions.push_back(world.revision<Height>());
        const std::size_t known = std::min<std::size_t>(revisions.size() - 1, 1000);
        const auto changes = world.changes_since<Height>(revisions[revisions.size() - 1 - known]);
        REQUIRE(changes);
        REQUIRE(changes->size() == known);
    }
    CHECK_FALSE(world.changes_since<Height>(0));
    CHECK_FALSE(world.changes_since<Height>(revisions.front()));
}

TEST_CASE("world: places are those of the view") {
    World world;
    std::vector<Entity> all;
    for (int i = 0; i < 5; ++i) {
        all.push_back(world.create());
        world.set(all.back(), Height{i});
    }
    world.remove<Height>(all[1]);
    CHECK(entities_of<Height>(world) ==
          std::vector(world.entities<Height>().begin(), world.entities<Height>().end()));
    CHECK_FALSE(world.place<Height>(all[1]));
    for (const std::size_t i : {0U, 2U, 3U, 4U}) {
        CHECK(world.entities<Height>()[world.place<Height>(all[i]).value()] == all[i]);
    }
    CHECK(world.entities<Label>().empty());
}

TEST_CASE("world: a copy keeps entities and ticks, and is independent of the original") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Label{"original"});
    World copy = world;
    CHECK(copy.get<Label>(entity) == Label{"original"});
    CHECK(copy.changed<Label>(entity) == world.changed<Label>(entity));
    const Tick before = world.revision<Label>();

    copy.set(entity, Label{"changed"});
    copy.destroy(copy.create());
    CHECK(world.get<Label>(entity) == Label{"original"});
    CHECK(world.revision<Label>() == before);
    CHECK(copy.revision<Label>() > before);

    world = copy;
    CHECK(world.get<Label>(entity) == Label{"changed"});
    const World moved = std::move(copy);
    CHECK(moved.get<Label>(entity) == Label{"changed"});
    CHECK(moved.size() == 1);
}

TEST_CASE("world: each component type has a small number of its own, in all threads") {
    const std::size_t height = component_index<Height>();
    const std::size_t label = component_index<Label>();
    CHECK(height != label);
    CHECK(std::max(height, label) < 1000);
    std::size_t elsewhere = height + 1;
    std::thread([&] { elsewhere = component_index<Height>(); }).join();
    CHECK(elsewhere == height);
}

TEST_CASE("world: what changes nothing takes no tick") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{1});
    const Tick before = world.revision();
    for (int i = 0; i < 1000; ++i) {
        world.set(entity, Height{1});
        world.edit<Height>(entity, [](Height&) {});
        world.remove<Label>(entity);
        world.destroy(world.create());
    }
    CHECK(world.revision() == before);
    world.set(entity, Height{2});
    CHECK(world.revision() == before + 1);
}

TEST_CASE("world: worlds that threads change at once have no tick in common") {
    std::vector<World> worlds(4);
    std::vector<std::vector<Tick>> ticks(worlds.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        threads.emplace_back([&world = worlds[i], &drawn = ticks[i]] {
            const Entity entity = world.create();
            for (int value = 0; value < 5000; ++value) {
                world.set(entity, Height{value});
                drawn.push_back(world.revision());
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    std::set<Tick> all;
    for (const std::vector<Tick>& drawn : ticks) {
        CHECK(std::ranges::is_sorted(drawn));
        all.insert(drawn.begin(), drawn.end());
    }
    CHECK(all.size() == 4 * 5000);
}

TEST_CASE("world: the ticks of copies ascend, and are not those of the original") {
    World world;
    const Entity entity = world.create();
    std::set<Tick> all;
    int value = 0;
    for (int round = 0; round < 100; ++round) {
        World copy = world;
        for (World* const changed : {&world, &copy, &world}) {
            const Tick before = changed->revision();
            changed->set(entity, Height{++value});
            CHECK(changed->revision() > before);
            CHECK(all.insert(changed->revision()).second);
        }
        if (round % 2 == 0) world = std::move(copy);
    }
}

TEST_CASE("world: what is costly to copy is edited where it is, and counts as changed in any case") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Heavy(1));
    const Heavy* const component = world.find<Heavy>(entity);
    const int copies = *component->copies;
    const Tick first = world.revision<Heavy>();
    world.edit<Heavy>(entity, [&](Heavy& heavy) {
        CHECK(&heavy == component);
        heavy.value = 2;
    });
    CHECK(component->value == 2);
    CHECK(*component->copies == copies);
    const Tick second = world.changed<Heavy>(entity);
    CHECK(second > first);

    const auto fail = [](Heavy& heavy) {
        heavy.value = 3;
        throw std::runtime_error("no");
    };
    CHECK_THROWS_WITH(world.edit<Heavy>(entity, fail), "no");
    CHECK(component->value == 3);
    CHECK(world.revision<Heavy>() > second);
    CHECK(world.changes_since<Heavy>(first)->size() == 2);
    CHECK_THROWS_AS(world.edit<Heavy>(world.create(), fail), EntityError);
}

TEST_CASE(
    "world: an edit that throws changes nothing of what is copied bit by bit, though it cannot be compared") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Opaque{1});
    const Tick before = world.revision();
    const auto fail = [](Opaque& opaque) {
        opaque.value = 2;
        throw std::runtime_error("no");
    };
    CHECK_THROWS_WITH(world.edit<Opaque>(entity, fail), "no");
    CHECK(world.get<Opaque>(entity).value == 1);
    CHECK(world.revision() == before);
}

TEST_CASE("world: views of three types are ordered by the smallest pool, whichever it is") {
    World world;
    std::vector<Entity> all;
    for (int i = 0; i < 30; ++i) {
        all.push_back(world.create());
        world.set(all.back(), Opaque{i});
    }
    for (std::size_t i = 30; i-- > 0;) {
        if (i % 2 == 0) world.set(all[i], Label{std::to_string(i)});
        if (i % 3 == 0) world.set(all[i], Height{static_cast<int>(i)});
    }
    const std::vector expected{all[24], all[18], all[12], all[6], all[0]};
    CHECK(entities_of<Height, Label, Opaque>(world) == expected);
    CHECK(entities_of<Opaque, Height, Label>(world) == expected);
    CHECK(entities_of<Label, Opaque, Height>(world) == expected);
    for (const auto [entity, opaque, label, height] : world.view<Opaque, Label, Height>()) {
        CHECK(&opaque == world.find<Opaque>(entity));
        CHECK(&label == world.find<Label>(entity));
        CHECK(&height == world.find<Height>(entity));
    }
    const auto view = world.view<Opaque, Label>();
    auto at = view.begin();
    CHECK(std::get<Entity>(*at++) == all[28]);
    CHECK(std::get<Entity>(*at) == all[26]);
    CHECK(at != view.begin());
    CHECK(std::ranges::distance(view) == 15);
}

TEST_CASE("world: a storage reads and changes what the world does") {
    World world;
    const Entity with = world.create();
    const Entity without = world.create();
    Storage<Height> heights = world.storage<Height>();
    CHECK(heights.find(with) == nullptr);
    heights.set(with, {1});
    CHECK(world.get<Height>(with) == Height{1});
    const Tick first = world.revision();
    heights.set(with, {1});
    CHECK(world.revision() == first);
    heights.edit(with, [](Height& height) { height.metres = 2; });
    CHECK(heights.get(with) == Height{2});
    CHECK(&heights.get(with) == world.find<Height>(with));
    CHECK(heights.changed(with) == world.changed<Height>(with));
    CHECK(heights.revision() == world.revision());
    CHECK(heights.changes_since(first)->size() == 1);
    CHECK(heights.has(with));
    CHECK_FALSE(heights.has(without));
    CHECK(heights.changed(without) == 0);
    CHECK_FALSE(heights.place(without));
    CHECK(heights.entities()[heights.place(with).value()] == with);
    heights.remove(without);
    CHECK(message_of([&] { (void)heights.get(without); }) == "entity 1 (generation 1) has no Height");

    const World& read = world;
    const Storage<const Height> all = read.storage<Height>();
    for (const auto [entity, height] : all) {
        CHECK(entity == with);
        CHECK(&height == all.find(with));
    }
    CHECK(read.storage<Label>().begin() == read.storage<Label>().end());

    heights.remove(with);
    CHECK_FALSE(world.has<Height>(with));
    world.destroy(with);
    CHECK_THROWS_AS(heights.set(with, {3}), EntityError);
    CHECK_THROWS_AS(heights.remove(with), EntityError);
    CHECK_THROWS_AS(heights.edit(with, [](Height&) {}), EntityError);
    CHECK_THROWS_AS((void)heights.find(with), EntityError);
    CHECK_THROWS_AS((void)heights.has(with), EntityError);
    CHECK_THROWS_AS((void)heights.changed(with), EntityError);
    CHECK_THROWS_AS((void)heights.place(with), EntityError);
}

TEST_CASE("world: an entity is created as a host hints, unless another has the index") {
    World world;
    CHECK(world.create({5, 7}) == Entity{5, 7});
    CHECK(world.alive({5, 7}));
    CHECK(world.size() == 1);
    const Entity other = world.create({5, 9});
    CHECK(other.index != 5);
    CHECK(world.alive(other));
    CHECK(world.alive(world.create(Entity{})));

    world.destroy({5, 7});
    CHECK(world.create({5, 3}) == Entity{5, 3});
    CHECK_FALSE(world.alive({5, 7}));
    world.destroy({5, 3});
    const Entity next = world.create();
    CHECK(next.index == 5);
    CHECK(next.generation > 3);
}

TEST_CASE("world: no entity is created with a generation that none has") {
    World world;
    constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max() - 2;
    CHECK(message_of([&] {
              (void)world.create({3, 2});
          }) == "entity 3 (generation 2) cannot be created: no entity has that generation");
    CHECK_THROWS_AS((void)world.create({3, 0}), EntityError);
    CHECK_THROWS_AS((void)world.create({3, last + 2}), EntityError);
    CHECK(world.size() == 0);

    // The generations of index 0 are used up, so that only a hint can use it again.
    world.destroy(world.create({0, last}));
    CHECK(world.create().index != 0);
    CHECK(world.create({0, 1}) == Entity{0, 1});
}

TEST_CASE("world: a reader of a world reads all that the world does") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{7});
    world.set(entity, Label{"seven"});
    const WorldReader reader = world;
    CHECK(reader.alive(entity));
    CHECK(reader.size() == 1);
    CHECK(reader.find<Height>(entity) == world.find<Height>(entity));
    CHECK(reader.get<Label>(entity) == Label{"seven"});
    CHECK_FALSE(reader.has<Opaque>(entity));
    CHECK(reader.changed<Height>(entity) == world.changed<Height>(entity));
    CHECK(reader.revision<Label>() == world.revision());
    CHECK(reader.changes_since<Height>(0)->size() == 1);
    CHECK(reader.entities<Height>()[reader.place<Height>(entity).value()] == entity);
    CHECK(reader.count<Height>() == 1);
    CHECK(std::ranges::distance(reader.view<Height, Label>()) == 1);
    CHECK(reader.storage<Height>().get(entity) == Height{7});
    CHECK_THROWS_AS((void)reader.get<Opaque>(entity), EntityError);
}

TEST_CASE("world: a pass reads only components of types that it has declared") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Height{7});
    world.set(entity, Label{"seven"});
    std::vector<bool> declared(component_index<Height>() + 1);
    declared[component_index<Height>()] = true;
    const WorldReader reader(world, declared, "sums");
    CHECK(reader.alive(entity));
    CHECK(reader.get<Height>(entity) == Height{7});
    CHECK(std::ranges::distance(reader.view<Height>()) == 1);
    CHECK(reader.for_messages().get<Label>(entity) == Label{"seven"});

    const auto refused = [&](const auto& read) {
        CHECK_THROWS_WITH_AS(read(), "pass 'sums' reads Label components without having declared it",
                             UndeclaredAccess);
    };
    refused([&] { (void)reader.find<Label>(entity); });
    refused([&] { (void)reader.get<Label>(entity); });
    refused([&] { (void)reader.has<Label>(entity); });
    refused([&] { (void)reader.changed<Label>(entity); });
    refused([&] { (void)reader.revision<Label>(); });
    refused([&] { (void)reader.changes_since<Label>(0); });
    refused([&] { (void)reader.entities<Label>(); });
    refused([&] { (void)reader.place<Label>(entity); });
    refused([&] { (void)reader.count<Label>(); });
    refused([&] { (void)reader.view<Height, Label>(); });
    refused([&] { (void)reader.storage<Label>(); });
    // The list need not be as long as there are types.
    CHECK_THROWS_AS((void)WorldReader(world, {}, "none").count<Height>(), UndeclaredAccess);
}

// The reference model: the contents of each component type, by entity, and all entities ever created.
template <class C>
using Column = std::map<Entity, C>;

struct Model {
    std::map<Entity, bool> alive;
    Column<Height> heights;
    Column<Label> labels;
};

template <class C>
struct Stamps {
    Tick revision = 0;
    std::map<Entity, Tick> changed;
};

template <class C>
Stamps<C> stamps_of(const World& world) {
    Stamps<C> stamps{world.revision<C>(), {}};
    for (const auto& [entity, component] : world.view<C>()) {
        stamps.changed[entity] = world.changed<C>(entity);
    }
    return stamps;
}

template <class C>
Column<C> column_of(const World& world) {
    Column<C> column;
    for (const auto& [entity, component] : world.view<C>()) {
        RC_ASSERT(column.emplace(entity, component).second);
        RC_ASSERT(world.find<C>(entity) == &component);
    }
    return column;
}

template <class C>
void check_contents(const World& world, const Model& model, const Column<C>& column) {
    RC_ASSERT(column_of<C>(world) == column);
    RC_ASSERT(world.count<C>() == column.size());
    for (const auto& [entity, alive] : model.alive) {
        if (alive) RC_ASSERT(world.has<C>(entity) == column.contains(entity));
    }
}

// The revision and the ticks advance exactly where the contents have changed.
template <class C>
void check_stamps(const Stamps<C>& before, const Stamps<C>& after, const Column<C>& old,
                  const Column<C>& now) {
    RC_ASSERT((after.revision > before.revision) == (old != now));
    RC_ASSERT(after.revision >= before.revision);
    for (const auto& [entity, component] : now) {
        const auto was = old.find(entity);
        const bool same = was != old.end() && was->second == component;
        const Tick expected = same ? before.changed.at(entity) : after.revision;
        RC_ASSERT(after.changed.at(entity) == expected);
    }
}

void check_joined_view(const World& world, const Model& model) {
    Column<Height> joined;
    for (const auto [entity, height, label] : world.view<Height, Label>()) {
        RC_ASSERT(model.labels.at(entity) == label);
        joined.emplace(entity, height);
    }
    Column<Height> expected = model.heights;
    std::erase_if(expected, [&](const auto& row) { return !model.labels.contains(row.first); });
    RC_ASSERT(joined == expected);
}

enum class Action { create, destroy, set_height, set_label, edit_height, remove_height, remove_label, count };

struct Edit {
    Action action = Action::create;
    Entity entity;
    int value = 0;
};

void apply(const Edit& edit, World& world) {
    switch (edit.action) {
        case Action::destroy:
            return world.destroy(edit.entity);
        case Action::set_height:
            return world.set(edit.entity, Height{edit.value});
        case Action::set_label:
            return world.set(edit.entity, Label{std::to_string(edit.value)});
        case Action::edit_height:
            return world.edit<Height>(edit.entity, [&](Height& height) { height.metres += edit.value; });
        case Action::remove_height:
            return world.remove<Height>(edit.entity);
        case Action::remove_label:
            return world.remove<Label>(edit.entity);
        default:
            return;
    }
}

void apply(const Edit& edit, Model& model) {
    switch (edit.action) {
        case Action::destroy:
            model.alive[edit.entity] = false;
            model.heights.erase(edit.entity);
            model.labels.erase(edit.entity);
            return;
        case Action::set_height:
            model.heights[edit.entity] = Height{edit.value};
            return;
        case Action::set_label:
            model.labels[edit.entity] = Label{std::to_string(edit.value)};
            return;
        case Action::edit_height:
            model.heights.at(edit.entity).metres += edit.value;
            return;
        case Action::remove_height:
            model.heights.erase(edit.entity);
            return;
        case Action::remove_label:
            model.labels.erase(edit.entity);
            return;
        default:
            return;
    }
}

bool refused(const Edit& edit, const Model& model) {
    const bool lacks_height = edit.action == Action::edit_height && !model.heights.contains(edit.entity);
    return !model.alive.at(edit.entity) || lacks_height;
}

// An entity that exists or existed. The value is small, so that equal values are frequent.
Edit make_edit(std::uint8_t action, std::uint8_t pick, std::uint8_t value, const Model& model) {
    const auto count = static_cast<std::uint8_t>(Action::count);
    if (model.alive.empty()) return {Action::create, {}, 0};
    const auto entity =
        std::next(model.alive.begin(), pick % static_cast<std::ptrdiff_t>(model.alive.size()));
    return {static_cast<Action>(action % count), entity->first, value % 3};
}

void step(const Edit& edit, World& world, Model& model) {
    if (edit.action == Action::create) {
        RC_ASSERT(model.alive.emplace(world.create(), true).second);
    } else if (refused(edit, model)) {
        RC_ASSERT_THROWS_AS(apply(edit, world), EntityError);
    } else {
        apply(edit, world);
        apply(edit, model);
    }
}

TEST_CASE("world: containers of elements without == are components that always count as changed") {
    struct Plain {
        int value = 0;
    };
    static_assert(!Comparable<std::vector<Plain>> && !Comparable<std::map<int, Plain>>);
    static_assert(!Comparable<std::pair<int, Plain>> && !Comparable<std::tuple<Plain, int>>);
    static_assert(Comparable<std::vector<std::string>> && Comparable<std::map<int, float>>);
    World world;
    const Entity entity = world.create();
    world.set(entity, std::vector<Plain>{{1}});
    const Tick before = world.revision<std::vector<Plain>>();
    world.set(entity, std::vector<Plain>{{1}});
    CHECK(world.revision<std::vector<Plain>>() != before);
}

TEST_CASE("world: after random edits it has the same content as a plain map" *
          doctest::test_suite("random")) {
    using Raw = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>;
    CHECK(rc::check("world equals model", [](const std::vector<Raw>& script) {
        World world;
        Model model;
        for (const auto& [action, pick, value] : script) {
            const Model old = model;
            const auto heights = stamps_of<Height>(world);
            const auto labels = stamps_of<Label>(world);
            step(make_edit(action, pick, value, model), world, model);

            for (const auto& [entity, alive] : model.alive) {
                RC_ASSERT(world.alive(entity) == alive);
            }
            const auto live = std::ranges::count_if(model.alive, [](const auto& row) { return row.second; });
            RC_ASSERT(world.size() == static_cast<std::size_t>(live));
            check_contents(world, model, model.heights);
            check_contents(world, model, model.labels);
            check_joined_view(world, model);
            check_stamps(heights, stamps_of<Height>(world), old.heights, model.heights);
            check_stamps(labels, stamps_of<Label>(world), old.labels, model.labels);
        }
        const World copy = world;
        check_contents(copy, model, model.heights);
        check_contents(copy, model, model.labels);
    }));
}

/// Does what a Storage can do through it.
void apply_to_storage(const Edit& edit, World& world) {
    switch (edit.action) {
        case Action::set_height:
            return world.storage<Height>().set(edit.entity, {edit.value});
        case Action::edit_height:
            return world.storage<Height>().edit(edit.entity,
                                                [&](Height& height) { height.metres += edit.value; });
        case Action::remove_height:
            return world.storage<Height>().remove(edit.entity);
        default:
            return apply(edit, world);
    }
}

std::vector<Entity> changed_heights(const World& world) {
    std::vector<Entity> entities;
    const auto changes = world.changes_since<Height>(0);
    for (const Change& change : changes.value()) entities.push_back(change.entity);
    return entities;
}

TEST_CASE("world: random edits through storages do what they do through the world" *
          doctest::test_suite("random")) {
    using Raw = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>;
    CHECK(rc::check("storage equals world", [](const std::vector<Raw>& script) {
        World world;
        World through_storages;
        Model model;
        for (const auto& [action, pick, value] : script) {
            const Edit edit = make_edit(action, pick, value, model);
            step(edit, world, model);
            if (edit.action == Action::create) {
                (void)through_storages.create();
            } else {
                try {
                    apply_to_storage(edit, through_storages);
                } catch (const EntityError&) {  // as in `step`
                }
            }
        }
        RC_ASSERT(column_of<Height>(through_storages) == model.heights);
        RC_ASSERT(entities_of<Height>(through_storages) == entities_of<Height>(world));
        RC_ASSERT(changed_heights(through_storages) == changed_heights(world));
    }));
}

TEST_CASE("world: entities created with random hints are those of a plain set" *
          doctest::test_suite("random")) {
    using Raw = std::tuple<bool, std::uint8_t, std::uint8_t>;
    CHECK(rc::check("hints", [](const std::vector<Raw>& script) {
        World world;
        std::map<std::uint32_t, std::uint32_t> live;  // generation by index
        for (const auto& [create, at, turn] : script) {
            const Entity hint{at % 16U, 2U * turn + 1U};
            const bool is_free = !live.contains(hint.index);
            if (create) {
                const Entity made = world.create(hint);
                RC_ASSERT(is_free == (made == hint));
                RC_ASSERT(live.emplace(made.index, made.generation).second);
            } else if (!is_free) {
                world.destroy({hint.index, live.at(hint.index)});
                live.erase(hint.index);
            } else {
                const Entity made = world.create();
                RC_ASSERT(live.emplace(made.index, made.generation).second);
            }
            RC_ASSERT(world.size() == live.size());
            for (const auto& [index, generation] : live) RC_ASSERT(world.alive({index, generation}));
        }
    }));
}

}  // namespace

}  // TEST_SUITE("world")
