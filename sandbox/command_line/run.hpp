#pragma once

#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/command_line/options.hpp"
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// Runs what the command line asks for, in a window or headless. Each error prints one line to stderr.
[[nodiscard]] ExitStatus run(const Options& options, const MakeReference& make_reference = {});

}  // namespace candela::sandbox
