#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

namespace candela {

/// The order in which things are drawn: places in an array, for groups of things that follow each other,
/// sorted by a key in each group. There are free places between them, so that one that comes moves few
/// others.
class DrawOrder {
 public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    using Key = std::uint64_t;

    /// Consecutive places.
    struct Group {
        std::uint32_t first = 0;
        std::uint32_t capacity = 0;
        std::uint32_t count = 0;  ///< those in use are among the first `count`
        std::uint32_t used = 0;
    };

    /// Adds a thing to a group. All things of a group have different keys.
    void insert(Group& group, Key key, std::uint32_t thing);
    /// Takes away the thing at a place of the group.
    void remove(Group& group, std::uint32_t place);
    /// Number of places, whether in use or not.
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(things_.size()); }
    /// The thing at a place; `none` if there is none.
    [[nodiscard]] std::uint32_t at(std::uint32_t place) const { return things_[place]; }
    /// Frees the places of a group without things.
    void drop(Group& group);

    /// The smallest key of a group that has things.
    [[nodiscard]] Key first_key(const Group& group) const;

    /// Whether so few places are in use that `compact` pays.
    [[nodiscard]] bool is_sparse() const { return size() > 1024 + 6 * used_; }
    /// Gives new places to the things of these groups, which are all that there are.
    void compact(const std::vector<Group*>& groups);

    /// The places at which things have come or gone since the last call, ascending.
    [[nodiscard]] std::vector<std::uint32_t> take_changed();

 private:
    void set(std::uint32_t place, Key key, std::uint32_t thing);
    void make_room(Group& group, std::uint32_t around);
    void distribute(Group& group, std::uint32_t begin, std::uint32_t size);
    void grow(Group& group);
    [[nodiscard]] std::uint32_t take_places(std::uint32_t capacity);
    [[nodiscard]] Group copy(const DrawOrder& from, const Group& group);

    std::vector<std::uint32_t> things_;  // by place
    std::vector<Key> keys_;              // by place; in each group ascending, with those of free places
    std::vector<std::uint32_t> changed_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_;  // first places that no group has, by capacity
    std::uint32_t used_ = 0;                                    // places
};

}  // namespace candela
