#pragma once

#include "renderer/configuration/configuration.hpp"
#include "sandbox/options.hpp"

namespace candela::sandbox {

/// The defaults, overridden by the configuration file, overridden by flags. In a window the frame budget is
/// "auto" by default, and refinement on, as a picture that stands still is looked at; it is also on where
/// many frames of a still scene are for one picture. Throws std::runtime_error whose one line names the file
/// and all faults.
[[nodiscard]] Configuration choose_configuration(const Options& options, bool in_window);

/// The named configurations, a line each, for --list-configs.
[[nodiscard]] std::string list_configurations();

}  // namespace candela::sandbox
