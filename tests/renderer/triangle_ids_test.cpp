#include "renderer/passes/scene/triangle_ids.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "renderer/gpu/gpu_types.hpp"
#include "tests/seed.hpp"

TEST_SUITE("triangle ids") {

using namespace candela;

namespace {

/// Primitives with their triangles' ids, as who uses them knows them.
class Known {
 public:
    void add(PrimitiveKey key, std::uint32_t count) {
        if (counts_.contains(key)) return;
        counts_[key] = count;
        if (const auto first = ids_.insert(key, count)) {
            firsts_[key] = *first;
            return;
        }
        ++renumbered;
        for (const auto& [known, ignored] : counts_) firsts_[known] = ids_.first(known);
    }
    void remove(PrimitiveKey key) {
        if (counts_.erase(key) == 0) return;
        firsts_.erase(key);
        ids_.remove(key);
    }
    /// Whether all ids are different and increase with the keys.
    [[nodiscard]] bool are_in_order() const {
        std::uint64_t next = 0;
        for (const auto& [key, count] : counts_) {
            if (firsts_.at(key) < next || ids_.first(key) != firsts_.at(key)) return false;
            next = std::uint64_t{firsts_.at(key)} + count;
        }
        return next <= TRIANGLE_MASKED;
    }

    int renumbered = 0;

 private:
    TriangleIds ids_;
    std::map<PrimitiveKey, std::uint32_t> counts_;
    std::map<PrimitiveKey, std::uint32_t> firsts_;
};

constexpr PrimitiveKey of_entity(std::uint32_t entity, std::uint32_t primitive = 0) {
    return PrimitiveKey{entity} << 32U | primitive;
}

}  // namespace

TEST_CASE("ids increase from primitive to primitive, whatever comes and goes") {
    std::mt19937 random(test_seed(33));
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
    Known known;
    for (int edit = 0; edit < 3000; ++edit) {
        const PrimitiveKey key = of_entity(below(300), below(3));
        if (below(2) == 0) {
            known.add(key, 1 + below(edit % 50 == 0 ? 20'000'000 : 5000));
        } else {
            known.remove(key);
        }
        REQUIRE(known.are_in_order());
    }
}

TEST_CASE("ids change rarely, also where entities come in the opposite order") {
    for (const bool ascending : {true, false}) {
        CAPTURE(ascending);
        Known known;
        for (std::uint32_t i = 0; i < 20'000; ++i) known.add(of_entity(i), 12);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const std::uint32_t entity = 20'000 + (ascending ? i : 1999 - i);
            for (std::uint32_t primitive = 0; primitive < 3; ++primitive) {
                known.add(of_entity(entity, primitive), 500);
            }
        }
        CHECK(known.are_in_order());
        // Once more room for each entity is needed than there was; hardly again.
        CHECK(known.renumbered <= 3);
    }
}

}  // TEST_SUITE("triangle ids")
