#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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
    using Indices = std::index_sequence_for<Cs...>;

 public:
    class Iterator {
     public:
        using value_type = std::tuple<Entity, const Cs&...>;
        using difference_type = std::ptrdiff_t;

        Iterator() = default;
        Iterator(Pools pools, std::size_t smallest, std::span<const Entity> candidates)
            : pools_(std::move(pools)), smallest_(smallest), candidates_(candidates) {
            skip_incomplete();
        }

        [[nodiscard]] value_type operator*() const { return row(Indices{}); }

        Iterator& operator++() {
            ++at_;
            skip_incomplete();
            return *this;
        }

        Iterator operator++(int) {
            Iterator before = *this;
            ++*this;
            return before;
        }

        [[nodiscard]] bool operator==(const Iterator& other) const { return at_ == other.at_; }
        [[nodiscard]] bool operator==(std::default_sentinel_t) const { return at_ == candidates_.size(); }

     private:
        template <std::size_t... I>
        [[nodiscard]] value_type row(std::index_sequence<I...> /*of_pools*/) const {
            return {candidates_[at_], std::get<I>(pools_)->values()[places_[I]]...};
        }

        void skip_incomplete() {
            while (at_ < candidates_.size() && !find_places(Indices{})) ++at_;
        }

        /// False if a pool lacks the candidate.
        template <std::size_t... I>
        [[nodiscard]] bool find_places(std::index_sequence<I...> /*of_pools*/) {
            return (((places_[I] = place_in<I>()) != PoolBase::absent) && ...);
        }

        template <std::size_t I>
        [[nodiscard]] std::uint32_t place_in() const {
            const bool is_smallest = sizeof...(Cs) == 1 || I == smallest_;
            return is_smallest ? static_cast<std::uint32_t>(at_)
                               : std::get<I>(pools_)->place_of(candidates_[at_]);
        }

        Pools pools_{};
        std::size_t smallest_ = 0;
        std::span<const Entity> candidates_;  // the entities of the smallest pool
        std::size_t at_ = 0;
        std::array<std::uint32_t, sizeof...(Cs)> places_{};  // of the candidate's components
    };

    explicit View(const Pool<Cs>&... pools) : pools_(&pools...) {
        const std::array<std::span<const Entity>, sizeof...(Cs)> candidates{pools.entities()...};
        for (std::size_t i = 1; i < candidates.size(); ++i) {
            if (candidates[i].size() < candidates[smallest_].size()) smallest_ = i;
        }
        candidates_ = candidates[smallest_];
    }

    [[nodiscard]] Iterator begin() const { return Iterator(pools_, smallest_, candidates_); }
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

 private:
    Pools pools_;
    std::size_t smallest_ = 0;
    std::span<const Entity> candidates_;
};

}  // namespace candela
