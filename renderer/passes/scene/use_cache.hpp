#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

namespace candela {

/// What was made for objects, found by keys with their addresses, and kept while it is in use. A thing must
/// keep its object alive, so that the address stays that of the object. No key in use is that made by
/// default.
template <class Key, class Thing>
class UseCache {
 public:
    /// Returns the number of the key's thing, which stays the same while it is in use, and counts one more
    /// use. The thing is made by `make()` if there is none.
    template <class Make>
    std::uint32_t take(const Key& key, Make make) {
        auto found = numbers_.find(key);
        if (found == numbers_.end()) {
            Thing thing = make();
            found = numbers_.emplace(key, new_number()).first;
            entries_[found->second] = {key, std::move(thing), 0};
            added_.push_back(found->second);
        }
        ++entries_[found->second].uses;
        return found->second;
    }

    /// Ends one use. A thing without uses is still there until drop_unused.
    void release(const Key& key) {
        const std::uint32_t number = numbers_.at(key);
        if (--entries_[number].uses == 0) unused_.push_back(number);
    }

    /// Forgets the things that are not in use any more, after `drop(number)` for each.
    template <class Drop>
    void drop_unused(Drop drop) {
        for (const std::uint32_t number : std::exchange(unused_, {})) {
            Entry& entry = entries_[number];
            if (entry.uses > 0 || entry.key == Key{}) continue;
            drop(number);
            numbers_.erase(entry.key);
            entry = {};
            free_.push_back(number);
        }
    }

    /// The numbers of the things that are new since the last call and still there.
    [[nodiscard]] std::vector<std::uint32_t> take_added() {
        std::vector<std::uint32_t> added = std::exchange(added_, {});
        std::erase_if(added, [this](std::uint32_t number) { return entries_[number].key == Key{}; });
        return added;
    }

    /// All numbers are smaller.
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
    [[nodiscard]] Thing& operator[](std::uint32_t number) { return entries_[number].thing; }
    [[nodiscard]] const Thing& operator[](std::uint32_t number) const { return entries_[number].thing; }

    /// Calls `visit(thing)` for all.
    template <class Visit>
    void visit(Visit visit) {
        for (Entry& entry : entries_) {
            if (entry.key != Key{}) visit(entry.thing);
        }
    }

 private:
    struct Entry {
        Key key{};  // made by default: the number is free
        Thing thing{};
        std::uint32_t uses = 0;
    };

    std::uint32_t new_number() {
        if (free_.empty()) {
            entries_.emplace_back();
            return static_cast<std::uint32_t>(entries_.size() - 1);
        }
        const std::uint32_t number = free_.back();
        free_.pop_back();
        return number;
    }

    std::map<Key, std::uint32_t> numbers_;
    std::deque<Entry> entries_;  // by number; things stay where they are
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> added_;
    std::vector<std::uint32_t> unused_;
};

}  // namespace candela
