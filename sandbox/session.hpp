#pragma once

#include "sandbox/options.hpp"

namespace candela::sandbox {

/// Does what the command line asks for, in a window or without one. The exit status: 0, or 2 for faulty
/// input, or 3 without a driver, each with one line on stderr.
[[nodiscard]] int run(const Options& options);

}  // namespace candela::sandbox
