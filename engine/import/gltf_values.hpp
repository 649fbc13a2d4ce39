#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/read_json.hpp"

namespace candela::gltf {

using Json = nlohmann::json;

// What a document that check_schema has accepted holds at a path, which is as find_member takes it.

/// The array at the path; empty if there is none.
[[nodiscard]] inline const Json& list_in(const Json& object, std::string_view path) {
    static const Json none = Json::array();
    const Json* const found = find_member(object, path);
    return found ? *found : none;
}

/// A number, text or flag.
template <class Value>
[[nodiscard]] Value value_in(const Json& object, std::string_view path, Value otherwise) {
    const Json* const found = find_member(object, path);
    return found ? found->get<Value>() : otherwise;
}

/// An index into a list of the document; -1 for none.
[[nodiscard]] inline int index_in(const Json& object, std::string_view path) {
    return value_in(object, path, -1);
}

[[nodiscard]] inline std::string text_in(const Json& object, std::string_view path,
                                         std::string otherwise = {}) {
    return value_in(object, path, std::move(otherwise));
}

/// As many numbers as the vector has components.
template <class Vector>
[[nodiscard]] Vector vector_in(const Json& object, std::string_view path, Vector otherwise) {
    const Json& numbers = list_in(object, path);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        otherwise[static_cast<typename Vector::length_type>(i)] =
            numbers[i].get<typename Vector::value_type>();
    }
    return otherwise;
}

}  // namespace candela::gltf
