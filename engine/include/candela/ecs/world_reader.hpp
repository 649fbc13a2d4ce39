#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>
#include <candela/error.hpp>

namespace candela {

/// Thrown if a pass reads or changes components, or creates or destroys entities, without having declared it.
/// The message names the pass and the type.
class CANDELA_API UndeclaredAccess : public Error {
 public:
    using Error::Error;

    /// `verb`: such as "reads".
    [[nodiscard]] static UndeclaredAccess of(std::string_view pass, std::string_view verb,
                                             std::string_view component);
};

/// A world to read, for code that may read only components of some types, or of all. A small value, which
/// owns nothing and is valid as long as the world is where it is. Like `const World&`, which converts to it;
/// what it returns is the world's, and may outlive the reader.
///
/// All functions with a type C throw UndeclaredAccess if components of that type may not be read.
class CANDELA_API WorldReader : public WorldReads<WorldReader> {
 public:
    /// Everything may be read.
    WorldReader(const World& world) : world_(&world) {}
    /// Reads for a pass, which has declared the types C with `declared[component_index<C>()]`; others, and
    /// those that the list is too short for, may not be read. List and name must outlive the reader.
    WorldReader(const World& world, const std::vector<bool>& declared, std::string_view pass)
        : world_(&world), declared_(&declared), pass_(pass) {}

    /// For texts of messages, which may name what a pass's result does not depend on: everything may be read.
    [[nodiscard]] WorldReader for_messages() const { return {*world_}; }

 protected:
    /// The name given, for messages.
    [[nodiscard]] std::string_view pass() const { return pass_; }

 private:
    friend WorldReads<WorldReader>;

    [[nodiscard]] const EntityTable& entity_table() const { return world_->entity_table(); }

    template <Component C>
    [[nodiscard]] const Pool<C>& pool() const {
        if (!may_read(component_index<C>())) throw UndeclaredAccess::of(pass_, "reads", component_name<C>());
        return world_->pool<C>();
    }

    [[nodiscard]] bool may_read(std::size_t component) const {
        return !declared_ || (component < declared_->size() && (*declared_)[component]);
    }

    const World* world_;
    const std::vector<bool>* declared_ = nullptr;  // null: all
    std::string_view pass_;
};

}  // namespace candela
