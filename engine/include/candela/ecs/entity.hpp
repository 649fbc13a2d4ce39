#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <candela/api.hpp>
#include <candela/error.hpp>

namespace candela {

/// Identifies one entity of one World. A plain value that owns nothing. It is safe to keep after the entity
/// is destroyed: an entity that later reuses the index has another generation. Null if default-constructed.
struct Entity {
    static constexpr std::uint32_t null_index = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t index = null_index;
    std::uint32_t generation = 0;

    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 misreads the zero in a defaulted comparison.
    std::strong_ordering operator<=>(const Entity&) const = default;

    /// True if not null. Only World::alive tells whether the entity is alive.
    explicit operator bool() const { return index != null_index; }
};

/// "the null entity" or "entity 3 (generation 5)".
[[nodiscard]] CANDELA_API std::string to_string(Entity entity);

/// Thrown for use of an entity that is not alive or cannot be, or of a component that it does not have. The
/// message names the entity and the component.
class CANDELA_API EntityError : public Error {
 public:
    using Error::Error;

    [[nodiscard]] static EntityError not_alive(Entity entity, std::string_view component);
    [[nodiscard]] static EntityError lacks(Entity entity, std::string_view component);
    /// No entity with this generation is ever alive.
    [[nodiscard]] static EntityError never_alive(Entity entity);
};

}  // namespace candela
