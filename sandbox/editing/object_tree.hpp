#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <candela/ecs/world.hpp>

namespace candela::sandbox {

/// A line of the tree of objects.
struct ObjectRow {
    Entity entity;
    std::string name;
    std::string_view kind;  ///< "point light", "mesh" or, of what only has others below it, "group"
    int depth = 0;          ///< 0: below nothing
    bool operator==(const ObjectRow&) const = default;
};

/// The lights and objects with meshes of a world, with all that they are below: each one below its parent, by
/// name. With words to find, a list of those whose names have them, upper and lower case alike.
[[nodiscard]] std::vector<ObjectRow> object_rows(const World& world, std::string_view find = {});

/// The rows of a world, made again only when it has changed.
class ObjectTree {
 public:
    [[nodiscard]] const std::vector<ObjectRow>& rows(const World& world);

    std::string find;  ///< as in object_rows

 private:
    std::optional<Tick> made_at_;  // the world's revision
    std::string made_for_;
    std::vector<ObjectRow> rows_;
};

}  // namespace candela::sandbox
