#include "sandbox/files/numbered_file.hpp"

#include <fstream>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("numbered file") {

TEST_CASE("the next file has the number after the highest one of its kind") {
    const TemporaryFolder folder;
    const auto next = [&](const char* ending) { return next_numbered_file(ending, folder / "").filename(); };
    const auto touch = [&](const char* name) { std::ofstream file(folder / name); };
    CHECK(next(".png") == "candela-001.png");
    for (const char* other : {"candela-007.json", "candela-.png", "candela-x8.png", "candela-9x.png",
                              "my-candela-010.png", "candela-011.png.part", "candela.png",
                              "candela-99999999999999.png", "candela-2147483647.png", "candela--3.png"}) {
        touch(other);
    }
    CHECK(next(".png") == "candela-001.png");
    touch("candela-001.png");
    touch("candela-003.png");
    CHECK(next(".png") == "candela-004.png");  // a deleted number is not used again
    CHECK(next(".json") == "candela-008.json");
    touch("candela-999.png");
    CHECK(next(".png") == "candela-1000.png");
}

TEST_CASE("the current folder is the default, and a folder that is not there is no error") {
    CHECK(next_numbered_file(".none").parent_path() == ".");
    CHECK(next_numbered_file(".png", "/none") == "/none/candela-001.png");
}
}  // TEST_SUITE("numbered file")

}  // namespace candela::sandbox
