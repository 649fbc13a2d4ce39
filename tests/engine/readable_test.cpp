// Text from outside, as messages quote it.

#include <string>

#include <doctest/doctest.h>

#include "engine/readable.hpp"

TEST_SUITE("readable") {

using namespace candela;

TEST_CASE("what a terminal acts on is shown as bytes, all other characters as they are") {
    struct Example {
        std::string text, shown;
    };
    for (const auto& [text, shown] : {
             Example{"", ""},
             {"a room, ÄЖ好🙂", "a room, ÄЖ好🙂"},
             {"\x1B[2J\t\x7F", "\\x1B[2J\\x09\\x7F"},
             {"\u009B2J\u0085", "\\xC2\\x9B2J\\xC2\\x85"},
             {"\u202Egnp.exe", "\\xE2\\x80\\xAEgnp.exe"},
             {"\u200F\u2028\u2029\u2066\u2069",
              "\\xE2\\x80\\x8F\\xE2\\x80\\xA8\\xE2\\x80\\xA9\\xE2\\x81\\xA6\\xE2\\x81\\xA9"},
             {"\u00A0\u2030\u2065\u206A", "\u00A0\u2030\u2065\u206A"},  // next to those
             {"\xFF\xC0\x80 a\xC3", "\\xFF\\xC0\\x80 a\\xC3"},          // not UTF-8
             {std::string("a\0b", 3), "a\\x00b"},
             // The last characters of each length, then what is longer than needed, a surrogate, and
             // beyond Unicode.
             {"\u07FF\uFFFD\U0010FFFD", "\u07FF\uFFFD\U0010FFFD"},
             {"\xE0\x9F\xBF", "\\xE0\\x9F\\xBF"},
             {"\xF0\x8F\xBF\xBF", "\\xF0\\x8F\\xBF\\xBF"},
             {"\xED\xA0\x80", "\\xED\\xA0\\x80"},
             {"\xF4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"},
         }) {
        CHECK(readable(text) == shown);
        CHECK(readable(shown) == shown);
    }
}

TEST_CASE("long text is cut between characters") {
    CHECK(readable(std::string(200, 'x')) == std::string(200, 'x'));
    CHECK(readable(std::string(201, 'x')) == std::string(200, 'x') + "...");
    CHECK(readable("aÄb", 3) == "aÄ...");
    CHECK(readable("aÄb", 2) == "a...");
    CHECK(readable("aÄ", 3) == "aÄ");
}

}  // TEST_SUITE("readable")
