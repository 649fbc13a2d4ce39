#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/world_reader.hpp>

namespace candela {

/// The access of a pass to the components of a world. The lists are indexed by component_index; types that a
/// list is too short for do not count.
struct DeclaredComponents {
    std::vector<bool> reads{};
    std::vector<bool> writes{};
    bool writes_entities = false;
};

/// A world to read and to change, for code that may do so with components of some types, or of all. A small
/// value, like WorldReader. `World&` converts to it.
///
/// All functions do what those of World do that have their names. They throw UndeclaredAccess if that was not
/// declared.
class CANDELA_API WorldWriter : public WorldReader {
 public:
    /// Everything may be read and changed.
    WorldWriter(World& world) : WorldReader(world), world_(&world) {}
    /// For a pass. `writable`: the same world; null if nothing may be written, whatever is declared. The
    /// declaration and the name must outlive the writer.
    WorldWriter(const World& world, World* writable, const DeclaredComponents& declared,
                std::string_view pass)
        : WorldReader(world, declared.reads, pass), world_(writable), declared_(&declared) {}

    template <Component C>
    void set(Entity entity, C value) const {
        writable<C>().set(entity, std::move(value));
    }
    template <Component C, std::invocable<C&> F>
    void edit(Entity entity, F&& change) const {
        writable<C>().template edit<C>(entity, std::forward<F>(change));
    }
    template <Component C>
    void remove(Entity entity) const {
        writable<C>().template remove<C>(entity);
    }
    [[nodiscard]] Entity create() const { return with_entities().create(); }
    void destroy(Entity entity) const { with_entities().destroy(entity); }

 private:
    template <Component C>
    [[nodiscard]] World& writable() const {
        if (!may_write(component_index<C>())) {
            throw UndeclaredAccess::of(pass(), "changes", component_name<C>());
        }
        return *world_;
    }
    [[nodiscard]] bool may_write(std::size_t component) const {
        if (!declared_) return true;
        return world_ && component < declared_->writes.size() && declared_->writes[component];
    }
    [[nodiscard]] World& with_entities() const;

    World* world_;
    const DeclaredComponents* declared_ = nullptr;  // null: everything
};

}  // namespace candela
