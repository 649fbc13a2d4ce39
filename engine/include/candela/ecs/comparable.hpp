#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

namespace candela {

namespace detail {

/// The standard library declares == of containers for elements of every type, and fails to compile it for
/// those that have none: the elements have to be asked.
template <class T>
struct HasEqual : std::bool_constant<std::equality_comparable<T>> {};

template <class T>
requires(std::equality_comparable<T>&& requires { typename T::value_type; } &&
         !std::same_as<T, typename T::value_type>) struct HasEqual<T> : HasEqual<typename T::value_type> {
};

template <class First, class Second>
struct HasEqual<std::pair<First, Second>>
    : std::bool_constant<HasEqual<std::remove_cv_t<First>>::value && HasEqual<Second>::value> {};

template <class... T>
struct HasEqual<std::tuple<T...>> : std::bool_constant<(HasEqual<T>::value && ...)> {};

}  // namespace detail

/// A type whose objects can be compared by ==, and their elements, too, if it is a container.
template <class T>
concept Comparable = detail::HasEqual<T>::value;

}  // namespace candela
