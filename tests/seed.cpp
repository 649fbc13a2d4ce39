#include "tests/seed.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace candela {
namespace {

std::uint32_t taken_seed = 1;

std::string_view environment(const char* variable) {
    const char* const value = std::getenv(variable);
    return value ? value : "";
}

}  // namespace

std::uint32_t test_seed(std::uint32_t stream) {
    // Multiples of an odd number differ for all 2^32 streams.
    return taken_seed + stream * 0x9e37'79b9U;
}

bool take_test_seed() {
    const std::string_view given = environment("CANDELA_TEST_SEED");
    if (!given.empty()) {
        const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), taken_seed);
        if (error != std::errc{} || end != given.data() + given.size()) {
            fmt::print(stderr, "CANDELA_TEST_SEED='{}' is no whole number below 2^32\n", given);
            return false;
        }
    }
    fmt::print(stderr, "random tests draw from seed {} (CANDELA_TEST_SEED)\n",
               taken_seed);  // stdout is for the list of tests
    // By default RapidCheck uses a random seed.
    static std::string parameters;  // becomes a part of the environment
    parameters = fmt::format("RC_PARAMS={} seed={}", environment("RC_PARAMS"), taken_seed);
    return putenv(parameters.data()) == 0;
}

}  // namespace candela
