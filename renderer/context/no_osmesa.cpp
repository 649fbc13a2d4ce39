// Built in place of osmesa.cpp where GL/osmesa.h is missing: Mesa removed OSMesa in 25.1.

#include "renderer/context/kinds.hpp"

namespace candela {

std::unique_ptr<HeadlessContext> create_osmesa_context(const ContextOptions&) {
    throw ContextError("no OSMesa context: this build of Candela is without OSMesa");
}

bool has_osmesa() {
    return false;
}

}  // namespace candela
