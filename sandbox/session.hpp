#pragma once

#include "sandbox/options.hpp"
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// Runs what the command line asks for, in a window or headless. Returns the exit status: 0 on success, 2 for
/// invalid input, 3 without a driver or enough memory, 4 if a picture is wrong: its light is unaccounted for,
/// or pixels are not finite. Each error prints one line to stderr.
[[nodiscard]] int run(const Options& options, const MakeReference& make_reference = {});

}  // namespace candela::sandbox
