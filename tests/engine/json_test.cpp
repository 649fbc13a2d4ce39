// JSON: what is written and read, against a second implementation.

#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "engine/json/json.hpp"

TEST_SUITE("JSON") {

using namespace candela;

namespace {

/// The same value of the library's own type.
nlohmann::json other(const std::string& text) {
    return nlohmann::json::parse(text);
}

std::string fault_of(const std::string& text) {
    try {
        static_cast<void>(Json::parse(text));
    } catch (const JsonError& error) {
        return error.what();
    }
    return "none";
}

std::string nested(int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']');
}

}  // namespace

TEST_CASE("what is parsed and written again is the same value, on one line or several") {
    for (const char* text : {
             "null",
             "[]",
             "{}",
             R"([true, false, null, 0, -1, 1.5, -2e-7, 1e300, 18446744073709551615, -9223372036854775808])",
             R"({"b": [1, {"c": ""}], "a": {"x": [[]], "": 0.1}})",
             R"(["\"\\\/\b\f\n\r\t\u0001\u001f", "ÄЖ好🙂", "\ud83d\ude42\u007f"])",
         }) {
        const Json json = Json::parse(text);
        CHECK(other(json.dump()) == other(text));
        CHECK(other(json.dump(2)) == other(text));
        CHECK(Json::parse(json.dump(2)).dump() == json.dump());
    }
}

TEST_CASE("every number is written so that it is read back, and with its kind") {
    constexpr double least = std::numeric_limits<double>::denorm_min();
    for (const double number : {0.1, -1.0 / 3.0, 3.0, 1e17, 1e-300, least, 1.7976931348623157e308, -0.0}) {
        const Json read = Json::parse(Json(number).dump());
        CHECK(read.number() == number);
        CHECK(std::signbit(read.number()) == std::signbit(number));
        CHECK_FALSE(read.is_whole());
    }
    CHECK(Json(std::nan("")).dump() == "null");
    CHECK(Json::parse("7").whole<int>() == 7);
    CHECK(Json::parse("-7").whole<int>() == -7);
    CHECK_FALSE(Json::parse("-7").is_not_negative());
}

TEST_CASE(
    "members keep their order when they are added, and the last of the same name counts when they are "
    "read") {
    Json json = {{"z", 1}, {"a", 2}};
    json["m"] = 3;
    CHECK(json.dump() == R"({"z":1,"a":2,"m":3})");
    json["a"] = Json::array();
    json.erase("z");
    CHECK(json.dump() == R"({"a":[],"m":3})");
    CHECK(Json::parse(R"({"b": 1, "a": 2, "b": 3})").dump() == R"({"a":2,"b":3})");
    CHECK(json.find("z") == nullptr);
    CHECK(Json::parse(R"({"a": {"b": 5}})").find_path("a/b")->whole<int>() == 5);
    CHECK_THROWS_AS(static_cast<void>(json.at("z")), std::out_of_range);
}

TEST_CASE("strings that are not UTF-8 are refused, or their bytes replaced") {
    for (const std::string text : {"\xFF", "a\xC3", "\xE0\x80\x80z", "\xED\xA0\x80", "\xF5\x80\x80\x80"}) {
        CHECK_THROWS_AS(static_cast<void>(Json(text).dump()), JsonError);
        CHECK_THROWS_AS(static_cast<void>(nlohmann::json(text).dump()), nlohmann::json::type_error);
        const std::string replaced = Json(text).dump(-1, Json::Faulty::replaced);
        CHECK(other(replaced).get<std::string>().find("\uFFFD") != std::string::npos);
    }
}

TEST_CASE("a fault is said with its place, and nesting has a limit") {
    CHECK(fault_of("{\n  \"a\": }").starts_with("invalid JSON: parse error at line 2, column 8"));
    CHECK(fault_of("[1, 2").find("expected") != std::string::npos);
    CHECK(fault_of("[1] 2") != "none");
    CHECK(fault_of("") != "none");
    CHECK(fault_of("1e400") != "none");
    CHECK(fault_of(nested(256)) == "none");
    CHECK(fault_of(nested(257)) == "its JSON is nested too deeply");
}

}  // TEST_SUITE("JSON")
