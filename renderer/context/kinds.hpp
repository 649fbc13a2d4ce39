#pragma once

#include <memory>

#include "renderer/context/headless.hpp"

// The kinds of headless context behind HeadlessContext::create. Both throw ContextError.

namespace candela {

[[nodiscard]] std::unique_ptr<HeadlessContext> create_egl_context(const ContextOptions& options);
[[nodiscard]] std::unique_ptr<HeadlessContext> create_osmesa_context(const ContextOptions& options);

/// Whether OSMesa's header was there when the library was built. Without it create_osmesa_context always
/// throws.
[[nodiscard]] bool has_osmesa();

}  // namespace candela
