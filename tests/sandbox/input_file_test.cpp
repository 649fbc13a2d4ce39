#include "sandbox/files/input_file.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>

#include "tests/engine/gltf_builder.hpp"
#include "tests/throws.hpp"

TEST_SUITE("input files") {

using namespace candela;
using namespace candela::sandbox;

TEST_CASE("only regular files of a limited size are read") {
    const test::TemporaryDirectory folder;
    std::ofstream(folder / "text") << "{}";
    CHECK(read_file(folder / "text") == "{}");
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    for (const std::filesystem::path& path :
         {folder / "pipe", folder / "", std::filesystem::path("/dev/zero")}) {
        CAPTURE(path);
        CHECK(throws<std::runtime_error>([&] { (void)read_file(path); },
                                         path.string() + ": is not a regular file"));
    }
    CHECK(
        throws<std::runtime_error>([&] { (void)read_file(folder / "nothing"); }, "nothing: cannot be read"));
    std::filesystem::resize_file(folder / "text", largest_text + 1);  // sparse
    CHECK(throws<std::runtime_error>([&] { (void)read_file(folder / "text"); },
                                     "67108865 bytes; 67108864 are read at most"));
}

}  // TEST_SUITE("input files")
