#pragma once

namespace candela {

/// For main: runs the test cases that the arguments of doctest choose, and returns the exit status. A run
/// that chooses none fails: a test whose name was misread on the way would otherwise pass without running.
[[nodiscard]] int run_tests(int argc, const char* const* argv);

}  // namespace candela
