#pragma once

#include "sandbox/options.hpp"

namespace candela::sandbox {

/// Does what the command line asks for, in a window or without one. The exit status: 0, or 2 for faulty
/// input, 3 without a driver, 4 where light is lost unaccounted for, each with one line on stderr.
[[nodiscard]] int run(const Options& options);

}  // namespace candela::sandbox
