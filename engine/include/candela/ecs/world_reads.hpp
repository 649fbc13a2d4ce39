#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <candela/ecs/storage.hpp>
#include <candela/ecs/view.hpp>

namespace candela {

/// The functions that read a world. World and WorldReader derive from it; each has `entity_table()` and
/// `pool<C>()`, which WorldReader checks.
///
/// All functions that take an Entity, except `alive`, throw EntityError if the entity is not alive.
template <class Self>
class WorldReads {
 public:
    [[nodiscard]] bool alive(Entity entity) const { return self().entity_table().alive(entity); }
    /// Number of live entities.
    [[nodiscard]] std::size_t size() const { return self().entity_table().size(); }

    /// Null if the entity has no C. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] const C* find(Entity entity) const {
        return storage<C>().find(entity);
    }

    /// EntityError if the entity has no C. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] const C& get(Entity entity) const {
        return storage<C>().get(entity);
    }

    template <Component C>
    [[nodiscard]] bool has(Entity entity) const {
        return storage<C>().has(entity);
    }

    /// Tick at which the entity's C last changed; 0 if it has none.
    template <Component C>
    [[nodiscard]] Tick changed(Entity entity) const {
        return storage<C>().changed(entity);
    }

    /// Tick at which a C was last inserted, changed or removed; 0 if never.
    template <Component C>
    [[nodiscard]] Tick revision() const {
        return storage<C>().revision();
    }

    /// The entities whose C was inserted, changed or removed since the pool's revision was `tick`, oldest
    /// change first, an entity as often as it was changed. Nullopt if `tick` is none of the pool's revisions,
    /// or one so long ago that not all changes since are known: then anything may have changed. At least the
    /// last thousand are known, or, if that is more, as many as a quarter of the pool. Valid until any C of
    /// the world changes.
    template <Component C>
    [[nodiscard]] std::optional<std::span<const Change>> changes_since(Tick tick) const {
        return storage<C>().changes_since(tick);
    }

    /// The entities that have a C, in the order of `view<C>()`. Valid until any C of the world changes.
    template <Component C>
    [[nodiscard]] std::span<const Entity> entities() const {
        return storage<C>().entities();
    }

    /// Place of the entity in `entities<C>()`; nullopt if it has no C.
    template <Component C>
    [[nodiscard]] std::optional<std::uint32_t> place(Entity entity) const {
        return storage<C>().place(entity);
    }

    /// Number of entities that have a C.
    template <Component C>
    [[nodiscard]] std::size_t count() const {
        return entities<C>().size();
    }

    /// The entities that have every one of the types; see View for the order and for what invalidates it.
    template <Component C, Component... Cs>
    [[nodiscard]] View<C, Cs...> view() const {
        return View<C, Cs...>(self().template pool<C>(), self().template pool<Cs>()...);
    }

    /// All components of type C; see Storage for how long it is valid.
    template <Component C>
    [[nodiscard]] Storage<const C> storage() const {
        return {self().entity_table(), self().template pool<C>(), nullptr};
    }

 private:
    [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
};

}  // namespace candela
