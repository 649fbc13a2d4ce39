#include "tests/study/points.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

TEST_SUITE("points") {

using namespace candela::study;

namespace {

std::vector<Point> points_of(const char* text) {
    return read_points(Json::parse(text), "points.json");
}

std::string error_of(const char* text) {
    try {
        static_cast<void>(points_of(text));
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("a point has a name, a part of a configuration, and seeds") {
    const auto points = points_of(
        R"([{"id": "a", "config": {"path": "forward"}, "seeds": [3, 4294967295]}, {"id": "forward+-16"}])");
    REQUIRE(points.size() == 2);
    CHECK(points[0].id == "a");
    CHECK(Json::parse(points[0].request) == Json({{"path", "forward"}}));
    CHECK(points[0].seeds == std::vector<std::uint32_t>{3, 4294967295U});
    CHECK(points[1].id == "forward+-16");
    CHECK(points[1].request == "{}");
    CHECK(points[1].seeds == std::vector<std::uint32_t>{0});
}

TEST_CASE("seeds are the same in all frames, unless fresh ones are requested") {
    const auto points = points_of(R"([{"id": "a"}, {"id": "b", "fresh_seeds": true}])");
    REQUIRE(points.size() == 2);
    CHECK_FALSE(points[0].fresh_seeds);
    CHECK(points[1].fresh_seeds);
    CHECK(error_of(R"([{"id": "a", "fresh_seeds": 1}])") ==
          "points.json: point 0: \"fresh_seeds\" is neither true nor false");
}

TEST_CASE("the configuration is passed on unchanged, even with unknown members") {
    CHECK(points_of(R"([{"id": "a", "config": {"lever": {"x": 1}}}])")[0].request == R"({"lever":{"x":1}})");
}

TEST_CASE("errors name the list, the point and the cause") {
    CHECK(error_of("{}") == "points.json: is not a list of points");
    CHECK(error_of("[1]") == "points.json: point 0: is not an object");
    CHECK(error_of(R"([{"id": "a"}, {}])") == "points.json: point 1: \"id\" is not a text");
    CHECK(error_of(R"([{"id": "a"}, {"id": "a"}])") == "points.json: \"a\" is the id of two points");
    CHECK(error_of(R"([{"id": "a", "sedes": [1]}])") == "points.json: point 0: \"sedes\" is unknown");
    CHECK(error_of(R"([{"id": "a", "config": "x"}])") == "points.json: point 0: \"config\" is not an object");
}

TEST_CASE("an id that is not a valid file name is an error") {
    for (const char* text :
         {R"([{"id": ""}])", R"([{"id": "../a"}])", R"([{"id": "a/b"}])", R"([{"id": ".a"}])"}) {
        CAPTURE(text);
        CHECK(error_of(text).starts_with("points.json: point 0: \"id\""));
    }
}

TEST_CASE("seeds are whole numbers of 32 bits, and at least one") {
    for (const char* text :
         {R"([{"id": "a", "seeds": []}])", R"([{"id": "a", "seeds": 1}])", R"([{"id": "a", "seeds": [-1]}])",
          R"([{"id": "a", "seeds": [0.5]}])", R"([{"id": "a", "seeds": [4294967296]}])"}) {
        CAPTURE(text);
        CHECK(error_of(text).starts_with("points.json: point 0: \"seeds\""));
    }
}

}  // TEST_SUITE("points")
