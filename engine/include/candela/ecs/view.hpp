#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include <candela/ecs/pool.hpp>

namespace candela {

/// The entities that have every one of `Cs`, as tuples (Entity, const Cs&...):
///
///     for (auto [entity, light, transform] : world.view<PointLight, Transform>()) { ... }
///
/// Iterates over the smallest of the pools (the first named one among equals) in its packed order: the order
/// of insertion, except that each removal moved the last component into the gap. The order is therefore
/// deterministic: it depends only on the sequence of changes to the world. A view refers to the pools: any
/// change to one of them invalidates the view, its iterators and the references from them.
template <Component... Cs>
class View {
    using Pools = std::tuple<const Pool<Cs>*...>;

 public:
    class Iterator {
     public:
        using value_type = std::tuple<Entity, const Cs&...>;
        using difference_type = std::ptrdiff_t;

        Iterator() = default;
        Iterator(Pools pools, std::span<const Entity> candidates)
            : pools_(std::move(pools)), candidates_(candidates) {
            skip_incomplete();
        }

        [[nodiscard]] value_type operator*() const {
            const Entity entity = candidates_.front();
            return {entity, *std::get<const Pool<Cs>*>(pools_)->find(entity)...};
        }

        Iterator& operator++() {
            candidates_ = candidates_.subspan(1);
            skip_incomplete();
            return *this;
        }

        Iterator operator++(int) {
            Iterator before = *this;
            ++*this;
            return before;
        }

        [[nodiscard]] bool operator==(const Iterator& other) const {
            return candidates_.size() == other.candidates_.size();
        }
        [[nodiscard]] bool operator==(std::default_sentinel_t) const { return candidates_.empty(); }

     private:
        [[nodiscard]] bool complete(Entity entity) const {
            return (std::get<const Pool<Cs>*>(pools_)->find(entity) && ...);
        }

        void skip_incomplete() {
            while (!candidates_.empty() && !complete(candidates_.front())) {
                candidates_ = candidates_.subspan(1);
            }
        }

        Pools pools_{};
        std::span<const Entity> candidates_;  // from here to the end of the smallest pool
    };

    /// A null pool counts as empty.
    explicit View(const Pool<Cs>*... pools) : pools_(pools...) {
        if ((pools && ...)) {
            candidates_ = std::get<0>(pools_)->entities();
            (consider(pools->entities()), ...);
        }
    }

    [[nodiscard]] Iterator begin() const { return Iterator(pools_, candidates_); }
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

 private:
    void consider(std::span<const Entity> entities) {
        if (entities.size() < candidates_.size()) candidates_ = entities;
    }

    Pools pools_;
    std::span<const Entity> candidates_;
};

}  // namespace candela
