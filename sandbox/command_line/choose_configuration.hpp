#pragma once

#include <string>
#include <string_view>

#include <candela/configuration.hpp>
#include "sandbox/command_line/options.hpp"

namespace candela::sandbox {

/// The defaults, overridden by the configuration file or the named configuration, which are overridden by the
/// flags. The exposure is automatic by default, as lights of files may have any brightness. In a window the
/// default frame budget is "auto", and refinement is on by default because users look at still pictures.
/// Refinement is also on by default if many frames of a still scene are rendered into one picture. Throws
/// std::runtime_error with a one-line message that names the file and all errors.
[[nodiscard]] Configuration choose_configuration(const Options& options, bool in_window);

/// A named configuration with the refinement, the frame budget, the tone map and the view of `present`: its
/// name only says how a frame is computed.
[[nodiscard]] Configuration choose_named(const Configuration& present, const NamedConfiguration& named);
/// The named configuration of this name; null if there is none.
[[nodiscard]] const NamedConfiguration* find_named(std::string_view name);

/// The name of the named configuration that this one is; "custom" if it is none of them.
[[nodiscard]] std::string_view name_of(const Configuration& configuration);

/// The named configurations for --list-configs, one per line.
[[nodiscard]] std::string list_configurations();

}  // namespace candela::sandbox
