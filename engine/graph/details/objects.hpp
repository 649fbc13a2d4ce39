#pragma once

#include "engine/graph/details/plan.hpp"

namespace candela::detail {

/// Fills in the lifetimes of the resources that the ordered passes use.
void plan_lifetimes(const Declaration& declared, Plan& plan);

/// Fills in the objects. Transients of the same kind and description share an object if their lifetimes do
/// not overlap; a resource with a history has two objects; every other resource has its own.
void plan_objects(const Declaration& declared, Plan& plan);

}  // namespace candela::detail
