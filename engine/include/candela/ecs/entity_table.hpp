#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <candela/api.hpp>
#include <candela/ecs/entity.hpp>

namespace candela {

/// Which entities of a world are alive. Creating, destroying and asking take constant time.
class CANDELA_API EntityTable {
 public:
    [[nodiscard]] Entity create() {
        if (free_.empty()) return add();
        const std::uint32_t index = free_.back();
        free_.pop_back();
        ++live_;
        return {index, ++rows_[index].generation};
    }
    /// See World::create.
    [[nodiscard]] Entity create(Entity hint);
    /// The entity must be alive.
    void destroy(Entity entity);

    [[nodiscard]] bool alive(Entity entity) const {
        return is_used(entity.generation) && entity.index < rows_.size() &&
               rows_[entity.index].generation == entity.generation;
    }
    /// EntityError, which names the component, if the entity is not alive.
    void require_alive(Entity entity, std::string_view component) const {
        if (!alive(entity)) throw EntityError::not_alive(entity, component);
    }

    /// Number of live entities.
    [[nodiscard]] std::size_t size() const { return live_; }

 private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Of one index. The generation is odd while an entity uses the index. An Entity with an even generation
    /// is never alive, so not even an invented handle can refer to a free index.
    struct Row {
        std::uint32_t generation = 0;
        std::uint32_t place = none;  // of a free index: in `free_`, if it is there
    };

    [[nodiscard]] static bool is_used(std::uint32_t generation) { return generation % 2 == 1; }
    /// An entity with a new index.
    [[nodiscard]] Entity add();
    void put_on_free_list(std::uint32_t index);
    void take_off_free_list(std::uint32_t index);

    std::vector<Row> rows_;            // by index
    std::vector<std::uint32_t> free_;  // indices that `create` may use, the next one last
    std::size_t live_ = 0;
};

}  // namespace candela
