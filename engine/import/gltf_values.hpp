#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/json/json.hpp"

namespace candela::gltf {

// What a document that check_schema has accepted holds at a path, which is names of members joined by
// slashes.

/// The array at the path; empty if there is none.
[[nodiscard]] inline const Json& list_in(const Json& object, std::string_view path) {
    static const Json none = Json::array();
    const Json* const found = object.find_path(path);
    return found ? *found : none;
}

/// A whole number or not, as the type is.
template <class Number>
[[nodiscard]] Number number_in(const Json& object, std::string_view path, Number otherwise) {
    const Json* const found = object.find_path(path);
    if (!found) return otherwise;
    if constexpr (std::is_integral_v<Number>) {
        return found->whole<Number>();
    } else {
        return static_cast<Number>(found->number());
    }
}

/// An index into a list of the document; -1 for none.
[[nodiscard]] inline int index_in(const Json& object, std::string_view path) {
    return number_in(object, path, -1);
}

[[nodiscard]] inline bool flag_in(const Json& object, std::string_view path, bool otherwise) {
    const Json* const found = object.find_path(path);
    return found ? found->flag() : otherwise;
}

[[nodiscard]] inline std::string text_in(const Json& object, std::string_view path,
                                         std::string otherwise = {}) {
    const Json* const found = object.find_path(path);
    return found ? found->text() : otherwise;
}

/// As many numbers as the vector has components.
template <class Vector>
[[nodiscard]] Vector vector_in(const Json& object, std::string_view path, Vector otherwise) {
    const Json& numbers = list_in(object, path);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        otherwise[static_cast<typename Vector::length_type>(i)] =
            static_cast<typename Vector::value_type>(numbers[i].number());
    }
    return otherwise;
}

}  // namespace candela::gltf
