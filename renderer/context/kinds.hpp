#pragma once

#include <memory>

#include <candela/headless_context.hpp>

// What HeadlessContext::create calls for each kind. Both functions throw ContextError.

namespace candela {

[[nodiscard]] std::unique_ptr<HeadlessContext> create_egl_context(const ContextOptions& options);
[[nodiscard]] std::unique_ptr<HeadlessContext> create_osmesa_context(const ContextOptions& options);

/// Whether GL/osmesa.h was found when the library was built. Otherwise create_osmesa_context always throws.
[[nodiscard]] bool has_osmesa();

}  // namespace candela
