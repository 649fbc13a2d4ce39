#pragma once

#include <memory>

#include "renderer/context/headless.hpp"

// The kinds of headless context behind HeadlessContext::create. Both throw ContextError.

namespace candela {

[[nodiscard]] std::unique_ptr<HeadlessContext> create_egl_context(const ContextOptions& options);
[[nodiscard]] std::unique_ptr<HeadlessContext> create_osmesa_context(const ContextOptions& options);

}  // namespace candela
