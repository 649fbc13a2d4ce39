#pragma once

#include "engine/graph/compile.hpp"

namespace candela::detail {

/// Fills in the lifetimes of the resources that the ordered passes use.
void plan_lifetimes(const Declaration& declared, Plan& plan);

/// Fills in the objects: transients of one kind and description whose lifetimes do not meet share one,
/// resources with a history have two, everything else has its own.
void plan_objects(const Declaration& declared, Plan& plan);

}  // namespace candela::detail
