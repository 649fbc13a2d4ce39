#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>

namespace candela::sandbox {

/// All components of an entity that a user can change.
struct EntityState {
    std::optional<Name> name;
    std::optional<Transform> transform;
    std::vector<AnyLight> lights;  ///< at most one of each kind
    std::optional<MeshInstance> mesh_instance;
    std::optional<Environment> environment;
    std::optional<Camera> camera;
    bool operator==(const EntityState&) const = default;
};

[[nodiscard]] EntityState state_of(const World& world, Entity entity);
/// Sets and removes components so that state_of gives `state`.
void set_state(World& world, Entity entity, const EntityState& state);

/// The states of some entities.
using EntityStates = std::vector<std::pair<Entity, EntityState>>;
[[nodiscard]] EntityStates states_of(const World& world, const std::vector<Entity>& entities);

/// The changes of a world, to be undone and redone in order. An entity that was deleted is still alive,
/// without components, so that handles to it stay valid: entities of the world must not be destroyed.
class History {
 public:
    /// Keeps the last `most` edits, >= 1.
    explicit History(std::size_t most = 1000) : most_(most) {}

    /// Starts an edit of these entities: what changes in them until `commit` is undone together. Commits an
    /// edit that is open. `name` tells the user what happens: "move ceiling light".
    void begin(const World& world, std::string name, const std::vector<Entity>& entities);
    /// Ends the open edit, if there is one; it is kept if it has changed anything.
    void commit(const World& world);
    /// Ends the open edit, if there is one, and restores the entities.
    void cancel(World& world);

    /// Keeps a change that has already been made: `before` are the states before it. Joins the previous one
    /// if that was kept by this function too, with the same name and entities, and there was no
    /// `end_of_gesture` since. Nothing happens if nothing has changed.
    void record(const World& world, std::string name, EntityStates before);
    /// The next recorded change does not join the previous one. Call this when a field is released.
    void end_of_gesture() { joins_ = false; }

    /// Undoes or redoes one edit, an open one first. Returns the entities that it touched; none if there was
    /// nothing to do.
    std::vector<Entity> undo(World& world);
    std::vector<Entity> redo(World& world);

    [[nodiscard]] std::size_t undo_count() const { return done_.size(); }
    [[nodiscard]] std::size_t redo_count() const { return undone_.size(); }
    /// The names of the edits that undo and redo would change; nullopt if there is none.
    [[nodiscard]] std::optional<std::string_view> undo_name() const;
    [[nodiscard]] std::optional<std::string_view> redo_name() const;

 private:
    struct Edit {
        std::string name;
        EntityStates before;
        EntityStates after;
    };
    struct Open {
        std::string name;
        EntityStates before;
    };

    void keep(const World& world, std::string name, EntityStates before, bool may_join);
    [[nodiscard]] bool joins(const std::string& name, const EntityStates& before) const;

    std::size_t most_;
    std::deque<Edit> done_;
    std::vector<Edit> undone_;  ///< the next one to redo is the last
    std::optional<Open> open_;
    bool joins_ = false;  ///< the last edit may still grow
};

}  // namespace candela::sandbox
