#include "tests/study/json_line.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include <candela/tools/output_file.hpp>
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("JSON lines") {

using namespace candela::study;
using candela::sandbox::TemporaryFolder;

TEST_CASE("a line contains no line breaks and keeps the order of its members") {
    CHECK(to_line({{"b", 1}, {"a", {{"text", "two\nlines"}}}}) == R"({"b":1,"a":{"text":"two\nlines"}})");
}

TEST_CASE("a number that JSON cannot represent is refused by name, not written as null") {
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()}) {
        const Json json = {{"errors", {{"total", to_json(Errors{.rel_mse = value})}}}};
        CHECK_THROWS_AS(static_cast<void>(to_line(json)), std::domain_error);
        try {
            static_cast<void>(to_line(json));
        } catch (const std::domain_error& error) {
            CHECK(std::string(error.what()).starts_with("/errors/total/rel_mse is "));
        }
    }
    CHECK_THROWS_AS(static_cast<void>(to_line({0.0, std::numeric_limits<double>::infinity()})),
                    std::domain_error);
}

TEST_CASE("numbers are read back exactly") {
    const double third = 1.0 / 3.0;
    CHECK(Json::parse(to_line({{"x", third}})).at("x").get<double>() == third);
}

TEST_CASE("errors name files that cannot be read") {
    const TemporaryFolder folder;
    candela::tools::write_text(folder / "broken.json", "{");
    for (const char* name : {"none.json", "broken.json"}) {
        try {
            static_cast<void>(read_json(folder / name));
            FAIL("must not be read: ", name);
        } catch (const std::runtime_error& error) {
            CHECK(std::string(error.what()).find(name) != std::string::npos);
        }
    }
}

}  // TEST_SUITE("JSON lines")
