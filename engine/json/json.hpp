#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace candela {

/// What is wrong with a text that could not be parsed, in one line: "invalid JSON: parse error at line 2,
/// column 7: ..." and what was expected there. It does not quote the text, except a number too large for a
/// double, which has no place. Also thrown by `Json::dump` for strings that are not UTF-8.
class JsonError : public std::runtime_error {
 public:
    using runtime_error::runtime_error;
};

class Json;
struct JsonMember;

/// The members of an object. See Json.
struct JsonObject {
    // Written in json.cpp, where a member is a complete type.
    JsonObject();
    JsonObject(const JsonObject& other);
    JsonObject(JsonObject&& other) noexcept;
    JsonObject& operator=(const JsonObject& other);
    JsonObject& operator=(JsonObject&& other) noexcept;
    ~JsonObject();

    std::vector<JsonMember> members;
    bool sorted = true;  ///< by name
};

/// A JSON value: null, true or false, a number, a string, an array or an object. Members of an object keep
/// the order in which they were added; those of a parsed text are sorted by name, so that looking up one of
/// many is fast.
///
/// Only json.cpp includes the library that parses: its headers take seconds to compile.
class Json {
 public:
    /// What becomes of strings that are not UTF-8.
    enum class Faulty { refused, replaced };

    Json() = default;
    Json(std::nullptr_t) {}
    template <std::same_as<bool> T>
    Json(T flag) : value_(flag) {}
    template <std::unsigned_integral T>
    requires(!std::same_as<T, bool>) Json(T number) : value_(std::uint64_t{number}) {}
    template <std::signed_integral T>
    Json(T number) {
        // A number from 0 is unsigned, wherever it comes from.
        if (number < 0) {
            value_ = std::int64_t{number};
        } else {
            value_ = static_cast<std::uint64_t>(number);
        }
    }
    Json(double number) : value_(number) {}
    Json(std::string text) : value_(std::move(text)) {}
    Json(std::string_view text) : value_(std::string(text)) {}
    Json(const char* text) : value_(std::string(text)) {}
    /// An object of members if each item is a name and a value, else an array: {{"x", 1}, {"y", 2}}, {1, 2}.
    Json(std::initializer_list<Json> items);

    [[nodiscard]] static Json array(std::vector<Json> items = {});
    [[nodiscard]] static Json object();

    /// The value of a whole text. Throws JsonError; also if arrays and objects are nested more than 256 deep.
    [[nodiscard]] static Json parse(std::string_view text);

    /// The text of the value; on several lines with so many spaces for each level unless `indent` is
    /// negative.
    [[nodiscard]] std::string dump(int indent = -1, Faulty faulty = Faulty::refused) const;

    [[nodiscard]] bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    [[nodiscard]] bool is_boolean() const { return std::holds_alternative<bool>(value_); }
    [[nodiscard]] bool is_number() const { return is_whole() || std::holds_alternative<double>(value_); }
    [[nodiscard]] bool is_whole() const {
        return is_not_negative() || std::holds_alternative<std::int64_t>(value_);
    }
    /// A whole number from 0.
    [[nodiscard]] bool is_not_negative() const { return std::holds_alternative<std::uint64_t>(value_); }
    [[nodiscard]] bool is_string() const { return std::holds_alternative<std::string>(value_); }
    [[nodiscard]] bool is_array() const { return std::holds_alternative<Array>(value_); }
    [[nodiscard]] bool is_object() const { return std::holds_alternative<JsonObject>(value_); }

    // Reading a value of another kind throws std::bad_variant_access: callers check first.

    [[nodiscard]] bool flag() const { return std::get<bool>(value_); }
    [[nodiscard]] double number() const;
    /// A number, converted like a static_cast.
    template <std::integral T>
    [[nodiscard]] T whole() const {
        const auto* const positive = std::get_if<std::uint64_t>(&value_);
        return positive ? static_cast<T>(*positive) : static_cast<T>(std::get<std::int64_t>(value_));
    }
    [[nodiscard]] const std::string& text() const { return std::get<std::string>(value_); }
    /// Whether it is this string.
    [[nodiscard]] bool is(std::string_view text) const { return is_string() && this->text() == text; }

    /// The items of an array; none of other values.
    [[nodiscard]] std::span<const Json> items() const;
    [[nodiscard]] std::span<Json> items();
    /// The members of an object; none of other values.
    [[nodiscard]] std::span<const JsonMember> members() const;
    /// How many items or members it has.
    [[nodiscard]] std::size_t size() const { return items().size() + members().size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }

    [[nodiscard]] const Json& operator[](std::size_t item) const { return items()[item]; }
    [[nodiscard]] Json& operator[](std::size_t item) { return items()[item]; }
    /// The member of this name; null if there is none, or if this is no object.
    [[nodiscard]] const Json* find(std::string_view name) const;
    [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }
    /// The member that a path of names joined by slashes leads to: "extensions/KHR_lights_punctual". Null if
    /// there is none.
    [[nodiscard]] const Json* find_path(std::string_view names) const;
    /// The member of this name. Throws std::out_of_range if there is none.
    [[nodiscard]] const Json& at(std::string_view name) const;

    /// The member of this name, which is added if it is missing: references to other members are then
    /// invalid. Null becomes an object.
    Json& operator[](std::string_view name);
    /// Null becomes an array.
    void push_back(Json item);
    void erase(std::string_view name);
    /// Adds the members of another object, which replace those with the same name.
    void update(const Json& other);

 private:
    friend class JsonBuilder;
    friend class JsonWriter;

    using Array = std::vector<Json>;

    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array, JsonObject>
        value_;
};

struct JsonMember {
    std::string name;
    Json value;
};

}  // namespace candela
