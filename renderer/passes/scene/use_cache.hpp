#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace candela {

/// What was made for objects, found by their addresses, and kept as long as each scene uses it. A thing must
/// keep its object alive, so that the address stays that of the object.
template <class Object, class Thing>
class UseCache {
 public:
    /// Starts another scene: nothing is in use.
    void begin() {
        ++round_;
        used_.clear();
    }

    /// Returns the number of the object's thing among those in use, in the order of their first use. The
    /// thing is made by `make()` if there is none.
    template <class Make>
    std::uint32_t use(const Object* object, Make make) {
        auto found = entries_.find(object);
        if (found == entries_.end()) found = entries_.emplace(object, Entry{make()}).first;
        Entry& entry = found->second;
        if (entry.round != round_) {
            entry.round = round_;
            entry.number = static_cast<std::uint32_t>(used_.size());
            used_.push_back(&entry.thing);
        }
        return entry.number;
    }

    /// Ends the list of a scene: forgets the things that it does not use.
    void drop_unused() {
        std::erase_if(entries_, [this](const auto& entry) { return entry.second.round != round_; });
    }

    /// The object's thing; null if it has none.
    [[nodiscard]] const Thing* find(const Object* object) const {
        const auto found = entries_.find(object);
        return found == entries_.end() ? nullptr : &found->second.thing;
    }

    /// The things in use, by number.
    [[nodiscard]] const std::vector<Thing*>& used() const { return used_; }
    [[nodiscard]] Thing& operator[](std::uint32_t number) const { return *used_[number]; }

 private:
    struct Entry {
        Thing thing;
        std::uint64_t round = 0;  // of the last use
        std::uint32_t number = 0;
    };
    std::unordered_map<const Object*, Entry> entries_;
    std::vector<Thing*> used_;
    std::uint64_t round_ = 0;
};

}  // namespace candela
