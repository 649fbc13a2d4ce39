#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

namespace candela {

/// Names one entity of one World. A plain value that owns nothing; it stays safe to hold after the entity is
/// destroyed, since the slot's next tenant has another generation. Default-constructed it is null.
struct Entity {
    static constexpr std::uint32_t null_index = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t index = null_index;
    std::uint32_t generation = 0;

    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 misreads the zero in a defaulted comparison.
    std::strong_ordering operator<=>(const Entity&) const = default;

    /// Not null. Whether it is alive only its World knows.
    explicit operator bool() const { return index != null_index; }
};

/// "the null entity" or "entity 3 (generation 5)".
[[nodiscard]] std::string to_string(Entity entity);

/// Use of an entity that is not alive, or of a component that it lacks. The message names both.
class EntityError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;

    [[nodiscard]] static EntityError not_alive(Entity entity, std::string_view component);
    [[nodiscard]] static EntityError lacks(Entity entity, std::string_view component);
};

}  // namespace candela
