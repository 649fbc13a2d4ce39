#pragma once

#include "renderer/configuration/configuration.hpp"
#include "sandbox/options.hpp"

namespace candela::sandbox {

/// The defaults, overridden by the configuration file, overridden by flags. In a window, refinement is on by
/// default: a picture that stands still is looked at. Throws std::runtime_error whose one line names the file
/// and all faults.
[[nodiscard]] Configuration choose_configuration(const Options& options, bool in_window);

/// The named configurations, a line each, for --list-configs.
[[nodiscard]] std::string list_configurations();

}  // namespace candela::sandbox
