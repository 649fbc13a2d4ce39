#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>
#include <typeindex>

#include <candela/api.hpp>

namespace candela {

/// What a World can store: any copyable type except `bool`, because std::vector packs bools into bits.
template <class C>
concept Component = std::copyable<C> && !std::same_as<C, bool>;

namespace detail {

template <class T>
consteval std::string_view signature() {
    return __PRETTY_FUNCTION__;
}

/// GCC and Clang put a fixed text before and after the type's name in the signature. A type with a known name
/// gives the lengths of both.
inline constexpr std::string_view known_name = "double";
inline constexpr std::size_t prefix = signature<double>().find(known_name);
inline constexpr std::size_t suffix = signature<double>().size() - prefix - known_name.size();

/// The index of a component type. Thread-safe.
[[nodiscard]] CANDELA_API std::size_t component_index(std::type_index type);

}  // namespace detail

/// The type's name without its namespaces: "PointLight" for candela::PointLight. Points into static storage.
template <class C>
[[nodiscard]] consteval std::string_view component_name() {
    std::string_view name = detail::signature<C>();
    name.remove_prefix(detail::prefix);
    name.remove_suffix(detail::suffix);
    const auto scope = name.substr(0, name.find('<')).rfind("::");
    return scope == std::string_view::npos ? name : name.substr(scope + 2);
}

/// A small number that only this type has in the process: types are counted from 0, as they are first used.
/// Shared libraries that use one engine library get the same number for one type.
template <Component C>
[[nodiscard]] std::size_t component_index() {
    static const std::size_t index = detail::component_index(typeid(C));
    return index;
}

}  // namespace candela
