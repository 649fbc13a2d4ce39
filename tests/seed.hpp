#pragma once

#include <cstdint>

/// Random tests use one seed: CANDELA_TEST_SEED from the environment, or 1 if it is not set. So they are the
/// same in every run, and other seeds can be requested.
namespace candela {

/// A seed that differs for each `stream`, so that different tests do not draw the same numbers.
[[nodiscard]] std::uint32_t test_seed(std::uint32_t stream = 0);

/// Prints the seed and passes it to RapidCheck; for main. Returns false, with a message on stderr, if the
/// environment's seed is not an integer in [0, 2^32).
[[nodiscard]] bool take_test_seed();

}  // namespace candela
