#include <candela/tools/picture.hpp>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <stb/stb_image.h>

#include <candela/tools/output_file.hpp>
#include "tests/sandbox/picture_reader.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("picture") {

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// All pixels are different, and no row or column is the same when reversed.
tools::Picture gradient(glm::ivec2 size) {
    tools::Picture picture{size, {}};
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            picture.pixels.emplace_back(static_cast<float>(x), static_cast<float>(y) * 0.1F,
                                        static_cast<float>(x + y * size.x) * 1e-6F);
        }
    }
    return picture;
}

/// Compares bits, so that NaN equals itself and -0 does not equal 0.
bool same_bits(const tools::Picture& a, const tools::Picture& b) {
    return a.size == b.size && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

template <typename Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "no error";
}

bool names(const std::string& error, const fs::path& path) {
    return error.starts_with(path.string() + ": ");
}

}  // namespace

TEST_CASE("EXR and PFM keep every bit of pictures of every shape") {
    const TemporaryFolder folder;
    for (const glm::ivec2 size :
         {glm::ivec2(1, 1), glm::ivec2(7, 3), glm::ivec2(3, 70), glm::ivec2(4096, 1), glm::ivec2(1, 4097)}) {
        CAPTURE(size.x);
        const tools::Picture picture = gradient(size);
        tools::write_exr(folder / "a.exr", picture);
        CHECK(same_bits(read_exr(folder / "a.exr"), picture));
        tools::write_pfm(folder / "a.pfm", picture);
        CHECK(same_bits(read_pfm(folder / "a.pfm"), picture));
    }
}

TEST_CASE("values that no display can show are kept") {
    const TemporaryFolder folder;
    using Limits = std::numeric_limits<float>;
    const tools::Picture picture{{2, 2},
                                 {{Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()},
                                  {Limits::max(), Limits::denorm_min(), -0.0F},
                                  {-1.0F, 1e-20F, 1e20F},
                                  {0.0F, 65505.0F, 1.0F / 3.0F}}};
    tools::write_exr(folder / "a.exr", picture);
    CHECK(same_bits(read_exr(folder / "a.exr"), picture));
    tools::write_pfm(folder / "a.pfm", picture);
    CHECK(same_bits(read_pfm(folder / "a.pfm"), picture));
}

TEST_CASE("a PFM has the layout of its specification") {
    const TemporaryFolder folder;
    tools::write_pfm(folder / "a.pfm", tools::Picture{{1, 2}, {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}}});
    // The bottom row first, each float with its lowest byte first: 4 is 0x40800000, 1 is 0x3f800000.
    const std::string file = read(folder / "a.pfm");
    const std::string header = "PF\n1 2\n-1.0\n";
    REQUIRE(file.size() == header.size() + 24);
    CHECK(file.starts_with(header));
    CHECK(file.substr(header.size(), 4) == std::string("\x00\x00\x80\x40", 4));
    CHECK(file.substr(header.size() + 12, 4) == std::string("\x00\x00\x80\x3f", 4));
}

TEST_CASE("a PFM with a positive scale is read as big-endian") {
    const TemporaryFolder folder;
    // 1 is 0x3f800000, -2 is 0xc0000000, the smallest denormal is 0x00000001.
    write(folder / "a.pfm",
          std::string("PF\n1 1\n1.0\n") + std::string("\x3f\x80\0\0\xc0\0\0\0\0\0\0\1", 12));
    const tools::Picture expected{{1, 1}, {{1.0F, -2.0F, std::numeric_limits<float>::denorm_min()}}};
    CHECK(same_bits(read_pfm(folder / "a.pfm"), expected));
}

TEST_CASE("all channels of a grey PFM have its value") {
    const TemporaryFolder folder;
    // 1 is 0x3f800000, 2 is 0x40000000, -0 is 0x80000000; the row at the bottom is stored first.
    write(folder / "a.pfm",
          std::string("Pf\n2 2\n-1.0\n") + std::string("\0\0\x80\x3f\0\0\0\x80\0\0\0\x40\0\0\x80\x3f", 16));
    const std::vector<float> values{2.0F, 1.0F, 1.0F, -0.0F};
    tools::Picture expected{{2, 2}, {}};
    for (const float value : values) expected.pixels.emplace_back(value);
    CHECK(same_bits(read_pfm(folder / "a.pfm"), expected));
}

TEST_CASE("a truncated file is refused at every length") {
    const TemporaryFolder folder;
    tools::write_pfm(folder / "a.pfm", gradient({5, 3}));
    tools::write_exr(folder / "a.exr", gradient({5, 3}));
    const std::string pfm = read(folder / "a.pfm");
    const std::string exr = read(folder / "a.exr");
    const fs::path cut = folder / "cut";
    for (std::size_t length = 0; length < pfm.size(); ++length) {
        write(cut, pfm.substr(0, length));
        CHECK(names(error_of([&] { (void)read_pfm(cut); }), cut));
    }
    for (std::size_t length = 0; length < exr.size(); ++length) {
        CAPTURE(length);
        write(cut, exr.substr(0, length));
        CHECK(names(error_of([&] { (void)read_exr(cut); }), cut));
    }
}

TEST_CASE("a PNG contains the given bytes, with the top row first") {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> rgb{255, 0, 0, 0, 255, 0, 1, 2, 3, 10, 20, 30, 40, 50, 60, 70, 80, 90};
    tools::write_png(folder / "a.png", {2, 3}, rgb);
    int width = 0;
    int height = 0;
    int channels = 0;
    unsigned char* pixels = stbi_load((folder / "a.png").c_str(), &width, &height, &channels, 0);
    REQUIRE(pixels != nullptr);
    CHECK(width == 2);
    CHECK(height == 3);
    REQUIRE(channels == 3);
    CHECK(std::vector<std::uint8_t>(pixels, pixels + rgb.size()) == rgb);
    stbi_image_free(pixels);
}

TEST_CASE("pixels that do not match the size are refused") {
    const TemporaryFolder folder;
    const fs::path path = folder / "a.png";
    const std::vector<std::uint8_t> rgb(11);
    CHECK(names(error_of([&] { tools::write_png(path, {2, 2}, rgb); }), path));
    CHECK(names(error_of([&] { tools::write_png(path, {0, 0}, {}); }), path));
    CHECK(names(error_of([&] {
                    tools::write_exr(path, tools::Picture{{2, 2}, std::vector<glm::vec3>(3)});
                }),
                path));
    CHECK(names(error_of([&] {
                    tools::write_pfm(path, tools::Picture{{-1, -1}, std::vector<glm::vec3>(1)});
                }),
                path));
    CHECK(folder.file_count() == 0);
}

TEST_CASE("errors name files that cannot be written, and keep what exists there") {
    const TemporaryFolder folder;
    const tools::Picture picture = gradient({4, 4});
    const fs::path lost = folder / "no-such-folder" / "a.pfm";
    const std::string error = error_of([&] { tools::write_pfm(lost, picture); });
    CHECK(names(error, lost));
    CHECK(error.find("No such file or directory") != std::string::npos);

    const fs::path directory = folder / "folder.png";
    fs::create_directory(directory);
    CHECK(names(error_of([&] { tools::write_pfm(directory, picture); }), directory));
    CHECK(fs::is_directory(directory));
    CHECK(folder.file_count() == 1);

    // A device that is always full simulates a full disk.
    const std::string full = error_of([&] { tools::write_pfm("/dev/full", picture); });
    CHECK(full == "/dev/full: cannot be written: No space left on device");
}

TEST_CASE("a file is replaced as a whole and through a link") {
    const TemporaryFolder folder;
    write(folder / "a.pfm", "old");
    fs::create_symlink("a.pfm", folder / "link.pfm");
    tools::write_pfm(folder / "link.pfm", gradient({3, 2}));
    CHECK(fs::is_symlink(folder / "link.pfm"));
    CHECK(same_bits(read_pfm(folder / "a.pfm"), gradient({3, 2})));
    CHECK(folder.file_count() == 2);
}

TEST_CASE("files that are not pictures are refused by name") {
    const TemporaryFolder folder;
    const fs::path path = folder / "a.pfm";
    CHECK(names(error_of([&] { (void)read_pfm(path); }), path));
    for (const char* text :
         {"", "PF", "Pg\n1 1\n-1.0\n000000000000", "Pf\n1 1\n-1.0\n000000000000", "PF\n0 0\n-1.0\n",
          "PF\n-1 -1\n-1.0\n000000000000", "PF\n1 1\n0.0\n000000000000", "PF\n1 1\nnan\n000000000000",
          "PF\n1 1\n-1.0\n00000000000", "PF\n1 1\n-1.0\n0000000000000",
          "PF\n2147483647 2147483647\n-1.0\n000000000000", "PF\n1 1\n-1.0", "PF\n1 1\n-1.00",
          "PF\n1 1\n-1.0x000000000000", "PF\n99999999999 1\n-1.0\n"}) {
        CAPTURE(text);
        write(path, text);
        CHECK(names(error_of([&] { (void)read_pfm(path); }), path));
        CHECK(names(error_of([&] { (void)read_exr(path); }), path));
    }
    CHECK(names(error_of([&] { (void)read_exr(folder / ""); }), folder / ""));
}

TEST_CASE("a file's name may be as long as the file system allows") {
    const TemporaryFolder folder;
    const fs::path longest = folder / (std::string(251, 'n') + ".txt").c_str();  // 255 bytes: NAME_MAX
    tools::write_text(longest, "first");
    tools::write_text(longest, "second");
    CHECK(read(longest) == "second");
    CHECK(folder.file_count() == 1);
}
}  // TEST_SUITE("picture")

}  // namespace candela::sandbox
