#pragma once

#include <string_view>
#include <typeindex>
#include <vector>

#include <candela/inspection.hpp>

namespace candela {

/// The fields of the elements of a buffer of this type; empty if the type is not one of the renderer's.
[[nodiscard]] std::vector<ElementField> fields_of(std::type_index element);

/// The fields of a struct in GLSL source, by the rules of std430, without members whose names begin with
/// "pad". Empty if there is no such struct, or if a member is of a type that none in shaders/types.glsl has.
[[nodiscard]] std::vector<ElementField> fields_of_struct(std::string_view source, std::string_view name);

}  // namespace candela
