#pragma once

#include <candela/configuration.hpp>
#include "sandbox/options.hpp"

namespace candela::sandbox {

/// The defaults, overridden by the configuration file, which is overridden by the flags. In a window the
/// default frame budget is "auto", and refinement is on by default because users look at still pictures.
/// Refinement is also on by default if many frames of a still scene are rendered into one picture. Throws
/// std::runtime_error with a one-line message that names the file and all errors.
[[nodiscard]] Configuration choose_configuration(const Options& options, bool in_window);

/// The named configurations for --list-configs, one per line.
[[nodiscard]] std::string list_configurations();

}  // namespace candela::sandbox
