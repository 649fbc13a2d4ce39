#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <random>

#include "sandbox/files/shipped_file.hpp"
#include "tests/engine/malformed_gltf.hpp"
#include "tests/engine/moving_gltf.hpp"
#include "tests/seed.hpp"

TEST_SUITE("random") {

using namespace candela;
using namespace candela::test;

namespace {

const std::filesystem::path cornell = sandbox::shipped_file("scenes", "cornell.gltf");

Bytes read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// An integer in [0, n), the same on every machine.
std::size_t below(std::size_t n, std::mt19937& random) {
    return random() % n;
}

/// Changes, removes or cuts off bytes at one place.
void edit(Bytes& file, std::mt19937& random) {
    const auto at = file.begin() + static_cast<std::ptrdiff_t>(below(file.size(), random));
    const auto some = static_cast<std::ptrdiff_t>(1 + below(8, random));
    switch (below(5, random)) {
        case 0:
            *at = static_cast<unsigned char>(*at ^ 1U << below(8, random));
            break;
        case 1:
            *at = static_cast<unsigned char>(below(256, random));
            break;
        case 2:
            *at = static_cast<unsigned char>('0' + below(10, random));
            break;
        case 3:
            file.erase(at, at + std::min(file.end() - at, some));
            break;
        default:
            file.erase(at, file.end());
            break;
    }
}

// A valid file with a few edits must either be imported or be rejected with a message. Sanitizers detect
// crashes.
void check_edited(const Bytes& sound, unsigned int seed, int rounds) {
    std::mt19937 random(seed);
    int refused = 0;
    for (int round = 0; round < rounds; ++round) {
        Bytes file = sound;
        for (std::size_t edits = 1 + below(3, random); edits > 0 && !file.empty(); --edits) {
            edit(file, random);
        }
        refused += error_of(file) != "imported" ? 1 : 0;
    }
    // Most edits cause an error, but an edit of a number's last digit or of a name is harmless.
    CHECK(refused > rounds / 4);
    CHECK(refused < rounds);
}

}  // namespace

TEST_CASE("mutated glTF: the Cornell box") {
    check_edited(read(cornell), test_seed(1), 1500);
}
TEST_CASE("mutated glTF: a scene with all features, as text") {
    check_edited(complete_scene().gltf(), test_seed(2), 1500);
}
TEST_CASE("mutated glTF: a scene with all features, as binary") {
    check_edited(complete_scene().glb(), test_seed(3), 3000);
}
TEST_CASE("mutated glTF: a figure that moves, as text and binary") {
    check_edited(moving_scene().gltf(), test_seed(73), 1500);
    check_edited(moving_scene().glb(), test_seed(74), 3000);
}

}  // TEST_SUITE("random")
