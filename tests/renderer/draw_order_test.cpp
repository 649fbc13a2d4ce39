#include "renderer/passes/scene/draw_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "tests/seed.hpp"

TEST_SUITE("draw order") {

using namespace candela;

namespace {

/// Groups of things in a DrawOrder, beside a plain map.
class Things {
 public:
    void add(std::size_t group, DrawOrder::Key key) {
        if (!plain_[group].emplace(key, next_).second) return;
        order_.insert(groups_[group], key, next_++);
        follow();
    }
    void remove(std::size_t group, DrawOrder::Key key) {
        const auto found = plain_[group].find(key);
        if (found == plain_[group].end()) return;
        const auto place = std::ranges::find(seen_, found->second) - seen_.begin();
        order_.remove(groups_[group], static_cast<std::uint32_t>(place));
        plain_[group].erase(found);
        if (plain_[group].empty()) order_.drop(groups_[group]);
        follow();
    }
    void compact_if_sparse() {
        if (!order_.is_sparse()) return;
        std::vector<DrawOrder::Group*> groups;
        for (DrawOrder::Group& group : groups_) {
            if (group.used > 0) groups.push_back(&group);
        }
        order_.compact(groups);
        ++compacted;
        follow();
    }

    /// Whether each group has its things in the order of their keys, by what take_changed has told.
    [[nodiscard]] bool are_in_order() const {
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            const auto first = seen_.begin() + groups_[i].first;
            std::vector<std::uint32_t> found;
            std::ranges::copy_if(first, first + groups_[i].count, std::back_inserter(found),
                                 [](std::uint32_t thing) { return thing != DrawOrder::none; });
            std::vector<std::uint32_t> expected;
            for (const auto& [key, thing] : plain_[i]) expected.push_back(thing);
            if (found != expected) return false;
            if (!expected.empty() && order_.first_key(groups_[i]) != plain_[i].begin()->first) return false;
        }
        return true;
    }
    [[nodiscard]] std::size_t places() const { return order_.size(); }
    [[nodiscard]] std::size_t count(std::size_t group) const { return plain_[group].size(); }
    [[nodiscard]] std::size_t changed() const { return changed_; }

    int compacted = 0;

 private:
    void follow() {
        seen_.resize(order_.size(), DrawOrder::none);
        for (const std::uint32_t place : order_.take_changed()) {
            seen_[place] = order_.at(place);
            ++changed_;
        }
    }

    DrawOrder order_;
    std::vector<DrawOrder::Group> groups_{5};
    std::vector<std::map<DrawOrder::Key, std::uint32_t>> plain_{5};
    std::vector<std::uint32_t> seen_;  // by place
    std::uint32_t next_ = 0;
    std::size_t changed_ = 0;  // places told
};

}  // namespace

TEST_CASE("things are in the order of their keys, whatever comes and goes") {
    std::mt19937 random(test_seed(31));
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
    Things things;
    for (int round = 0; round < 40; ++round) {
        // Sometimes many more come than go, sometimes nearly all go; to the end, to the front, or anywhere.
        const std::uint32_t adds = below(10);
        for (int edit = 0; edit < 100; ++edit) {
            const std::size_t group = below(5);
            const DrawOrder::Key key = below(round % 2 == 0 ? 200 : 5000);
            if (below(10) < adds) {
                things.add(group, key);
            } else {
                things.remove(group, key);
            }
            things.compact_if_sparse();
        }
        CAPTURE(round);
        REQUIRE(things.are_in_order());
    }
}

TEST_CASE("one that comes moves few others, in whichever order they come") {
    std::mt19937 random(test_seed(32));
    constexpr std::uint32_t count = 3000;
    std::vector<DrawOrder::Key> ascending(count);
    for (std::uint32_t i = 0; i < count; ++i) ascending[i] = i;
    std::vector<DrawOrder::Key> descending(ascending.rbegin(), ascending.rend());
    std::vector<DrawOrder::Key> shuffled = ascending;
    std::ranges::shuffle(shuffled, random);
    for (const auto& keys : {ascending, descending, shuffled}) {
        Things things;
        for (const DrawOrder::Key key : keys) things.add(0, key);
        CHECK(things.are_in_order());
        // At most 64 move to free a place. To make room costs about as much again for one that comes.
        CHECK(things.changed() < 2 * 64 * count);
        CHECK(things.places() < 6 * count + 1024);
    }
}

TEST_CASE("places are used again, and an order that few are left of is made smaller") {
    Things things;
    things.add(0, 1);
    things.add(1, 1);
    things.remove(1, 1);
    const std::size_t places = things.places();
    for (DrawOrder::Key key = 0; key < 50; ++key) {
        things.add(1, key);
        things.remove(1, key);
    }
    CHECK(things.places() == places);

    for (DrawOrder::Key key = 0; key < 4000; ++key) things.add(2, key);
    for (DrawOrder::Key key = 0; key < 3990; ++key) {
        things.remove(2, key);
        things.compact_if_sparse();
    }
    CHECK(things.compacted > 0);
    CHECK(things.are_in_order());
    CHECK(things.places() < 1200);
}

}  // TEST_SUITE("draw order")
