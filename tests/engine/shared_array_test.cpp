#include "engine/shared_array.hpp"

#include <cstddef>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

TEST_SUITE("shared array") {

using candela::SharedArray;

namespace {

std::vector<int> values_of(const SharedArray<int>& array) {
    std::vector<int> values;
    for (std::size_t i = 0; i < array.size(); ++i) values.push_back(array[i]);
    return values;
}

/// One random change to both.
void edit(SharedArray<int>& array, std::vector<int>& plain) {
    const int value = *rc::gen::inRange(0, 3);
    const int kind = *rc::gen::inRange(0, 8);
    if (kind == 0) {
        // From one block to several groups of blocks.
        const int most = *rc::gen::element(100, 300, 3 * static_cast<int>(SharedArray<int>::group_size));
        const auto size = static_cast<std::size_t>(*rc::gen::inRange(0, most));
        array.resize(size);
        plain.resize(size);
    } else if (kind == 1 || plain.empty()) {
        array.push_back(value);
        plain.push_back(value);
    } else {
        const auto at = *rc::gen::inRange<std::size_t>(0, plain.size());
        array.set(at, value);
        plain[at] = value;
    }
}

}  // namespace

TEST_CASE("shared array: copies differ where plain ones do") {
    CHECK(rc::check([] {
        std::vector<SharedArray<int>> arrays(3);
        std::vector<std::vector<int>> plain(3);
        for (int step = 0; step < 60; ++step) {
            const auto from = static_cast<std::size_t>(*rc::gen::inRange(0, 3));
            const auto to = static_cast<std::size_t>(*rc::gen::inRange(0, 3));
            if (*rc::gen::inRange(0, 5) == 0) {
                arrays[to] = arrays[from];
                plain[to] = plain[from];
            } else {
                edit(arrays[to], plain[to]);
            }
            RC_ASSERT(values_of(arrays[to]) == plain[to]);
            RC_ASSERT((arrays[from] == arrays[to]) == (plain[from] == plain[to]));
            std::vector<std::size_t> found;
            visit_differences(arrays[from], arrays[to], [&](std::size_t i) { found.push_back(i); });
            std::vector<std::size_t> expected;
            for (std::size_t i = 0; i < plain[from].size() && i < plain[to].size(); ++i) {
                if (plain[from][i] != plain[to][i]) expected.push_back(i);
            }
            RC_ASSERT(found == expected);
            found.clear();
            visit_changes(arrays[from], arrays[to], [&](std::size_t i) { found.push_back(i); });
            for (std::size_t i = plain[from].size(); i < plain[to].size(); ++i) expected.push_back(i);
            RC_ASSERT(found == expected);
        }
    }));
}

TEST_CASE("shared array: elements that come back are those made by default") {
    SharedArray<int> array;
    array.push_back(7);
    array.push_back(8);
    array.resize(1);
    array.resize(2);
    CHECK(values_of(array) == std::vector{7, 0});
}

}  // TEST_SUITE("shared array")
