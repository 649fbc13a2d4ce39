#include "tests/study/compare.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <stb/stb_image.h>

#include <candela/tools/picture.hpp>
#include "tests/sandbox/temporary_folder.hpp"
#include "tests/study/reference_files.hpp"
#include "tests/study/test_pictures.hpp"

namespace candela::study {

TEST_SUITE("compare") {

using sandbox::TemporaryFolder;
using tools::Picture;
using tools::write_exr;
using tools::write_pfm;

namespace {

std::string error_of(const Comparison& comparison) {
    try {
        return "no error, but " + compare(comparison);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

}  // namespace

TEST_CASE("all measures are printed, for PFM and EXR files") {
    const TemporaryFolder folder;
    write_pfm(folder / "a.pfm", constant({5, 3}, glm::vec3(0.75F)));
    write_exr(folder / "b.exr", constant({5, 3}, glm::vec3(0.5F)));
    // 0.25² / (0.5² · 1.01), √(3 · 0.25²), 0.25 / 0.5, 0.75 / 0.5; FLIP has its own tests.
    const std::string text = compare({folder / "a.pfm", folder / "b.exr", {}, {}, {}});
    CHECK(text.starts_with(
        "relMSE   0.247525\nRMSE     0.433013\nbias     0.5\nspikes   1.5\nblotch   0.247525\nFLIP     0."));
}

TEST_CASE("a mask excludes pixels, and the heat map shows them grey") {
    const TemporaryFolder folder;
    Picture picture = constant({2, 2}, glm::vec3(1.0F));
    write_pfm(folder / "b.pfm", picture);
    picture.pixels[1] = glm::vec3(1.5F);
    picture.pixels[3] = glm::vec3(9.0F);
    write_pfm(folder / "a.pfm", picture);
    Picture mask = constant({2, 2}, glm::vec3(1.0F));
    mask.pixels[3] = glm::vec3(0.0F);
    write_pfm(folder / "mask.pfm", mask);
    const std::string text =
        compare({folder / "a.pfm", folder / "b.pfm", folder / "mask.pfm", folder / "heat.png", {}});
    // 0.25 / 1.01 / 3, and the square root of the pixel's own 0.25 / 1.01.
    CHECK(text.starts_with("relMSE   0.0825083\n"));
    CHECK(text.ends_with("heat     0.497519\n"));

    glm::ivec2 size(0);
    int channels = 0;
    unsigned char* png = stbi_load((folder / "heat.png").c_str(), &size.x, &size.y, &channels, 3);
    REQUIRE(png != nullptr);
    const std::vector<int> bytes(png, png + 12);
    stbi_image_free(png);
    CHECK(size == glm::ivec2(2, 2));
    CHECK(bytes[0] < 10);   // no error: black
    CHECK(bytes[3] > 240);  // the largest: pale yellow
    CHECK(std::vector<int>(bytes.begin() + 9, bytes.end()) == std::vector<int>{128, 128, 128});
}

TEST_CASE("against a folder of a reference, its background and its noise do not count") {
    const TemporaryFolder folder;
    const glm::ivec2 size{2, 2};
    const auto grey = [&](float value) { return constant(size, glm::vec3(value)); };
    Reference reference;
    reference.request.size = glm::uvec2(size);
    reference.estimate = {.direct = grey(0.5F),
                          .indirect = grey(2.0F),
                          .halves = {grey(1.0F), grey(3.0F)},
                          .hit = {1, 1, 1, 0},
                          .edge = {0, 0, 0, 0}};
    reference.direct_fine = grey(0.5F);
    write_reference(folder / "reference", "a.gltf", reference);
    Picture picture = grey(4.5F);
    picture.pixels[3] = glm::vec3(9.0F);
    write_pfm(folder / "a.pfm", picture);
    const auto error = [&](const char* light) {
        return compare({folder / "a.pfm", folder / "reference", {}, {}, {}, light});
    };
    // (4.5 - 1.5) (4.5 - 3.5) / (2.5² · 1.01), (4.5 - 1) (4.5 - 3) / (2² · 1.01), (4.5 - 0.5)² / (0.5²
    // · 1.01)
    CHECK(error("total").starts_with("relMSE   0.475248\n"));
    CHECK(error("indirect").starts_with("relMSE   1.2995\n"));
    CHECK(error("direct").starts_with("relMSE   63.3663\n"));
    write_pfm(folder / "wide.pfm", constant({3, 2}, glm::vec3(1.0F)));
    CHECK(error_of({folder / "wide.pfm", folder / "reference", {}, {}, {}}) ==
          (folder / "reference").string() + ": is 2x2, not 3x2 as the picture to compare");
    std::filesystem::create_directory(folder / "empty");
    CHECK(error_of({folder / "a.pfm", folder / "empty", {}, {}, {}}).find("is it a folder of `reference`?") !=
          std::string::npos);
}

TEST_CASE("errors name the file, and nothing is written") {
    const TemporaryFolder folder;
    const auto a = folder / "a.pfm";
    write_pfm(a, constant({4, 3}, glm::vec3(1.0F)));
    write_pfm(folder / "wide.pfm", constant({5, 3}, glm::vec3(1.0F)));
    write_pfm(folder / "black.pfm", constant({4, 3}, glm::vec3(0.0F)));
    Picture bad = constant({4, 3}, glm::vec3(1.0F));
    bad.pixels[6].b = std::nanf("");
    write_exr(folder / "nan.exr", bad);
    std::ofstream(folder / "text.exr") << "no picture";
    std::ofstream(folder / "a.txt") << "no picture";
    const auto heat = folder / "heat.png";
    const auto error = [&](const char* name) { return error_of({a, folder / name, {}, heat, {}}); };
    const auto at = [&](const char* name) { return (folder / name).string(); };

    CHECK(error("gone.pfm") == at("gone.pfm") + ": cannot be read: No such file or directory");
    CHECK(error("wide.pfm") == at("wide.pfm") + ": is 5x3, not 4x3 as the picture to compare");
    CHECK(error("nan.exr") == at("nan.exr") + ": pixel (2, 1) is not finite");
    CHECK(error("text.exr").starts_with(at("text.exr") + ": cannot be read as OpenEXR"));
    CHECK(error("a.txt") == at("a.txt") + ": is named neither .pfm nor .exr");
    CHECK(error_of({folder / "nan.exr", a, {}, heat, {}}).starts_with(at("nan.exr") + ": "));
    CHECK(error_of({a, a, folder / "black.pfm", heat, {}}) == at("black.pfm") + ": masks every pixel");
    CHECK(error_of({a, a, folder / "wide.pfm", heat, {}}).starts_with(at("wide.pfm") + ": is 5x3"));
    CHECK(error_of({a, a, {}, folder / "heat.jpg", {}}).starts_with(at("heat.jpg") + ": "));
    CHECK(error_of({a, a, {}, folder / "no-folder/heat.png", {}}) ==
          at("no-folder/heat.png") + ": cannot be written: No such file or directory");
    CHECK(error_of({a, a, {}, heat, -1.0}) == "--scale: -1 is no relative error above 0");
    CHECK(folder.file_count() == 6);
}
}  // TEST_SUITE("compare")

}  // namespace candela::study
