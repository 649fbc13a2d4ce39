#include <candela/ecs/world.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

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

template <class T>
struct Tagged {};

static_assert(component_name<Height>() == "Height");
static_assert(component_name<int>() == "int");
static_assert(component_name<Tagged<int>>() == "Tagged<int>");
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

}  // namespace

}  // TEST_SUITE("world")
