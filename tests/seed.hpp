#pragma once

#include <cstdint>

/// Random tests draw from one seed: that of the environment's CANDELA_TEST_SEED, 1 without it. So they are
/// the same in every run, and others can be asked for.
namespace candela {

/// Different for each `stream`, which tells apart what would otherwise draw the same numbers.
[[nodiscard]] std::uint32_t test_seed(std::uint32_t stream = 0);

/// Prints the seed and has RapidCheck draw from it; for main. False, with a message on stderr, where the
/// environment's is no whole number below 2^32.
[[nodiscard]] bool take_test_seed();

}  // namespace candela
