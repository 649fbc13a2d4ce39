#include <candela/headless_context.hpp>

#include "renderer/context/kinds.hpp"

namespace candela {

std::string_view to_string(ContextKind kind) {
    return kind == ContextKind::egl ? "egl" : "osmesa";
}

std::unique_ptr<HeadlessContext> HeadlessContext::create(ContextKind kind, const ContextOptions& options) {
    return kind == ContextKind::egl ? create_egl_context(options) : create_osmesa_context(options);
}

bool HeadlessContext::is_built(ContextKind kind) {
    return kind == ContextKind::egl || has_osmesa();
}

}  // namespace candela
