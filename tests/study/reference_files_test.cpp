#include "tests/study/reference_files.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include <candela/tools/output_file.hpp>
#include "tests/sandbox/temporary_folder.hpp"
#include "tests/study/scene_hash.hpp"

TEST_SUITE("reference files") {

using namespace candela;
using namespace candela::study;
using sandbox::TemporaryFolder;
using tools::Picture;

namespace {

constexpr glm::ivec2 size(3, 2);

Picture picture_of(glm::vec3 colour) {
    return {size, std::vector<glm::vec3>(6, colour)};
}

/// Halves of 1 and 3 with a mean of 2; the last pixel shows no surface.
Reference sample() {
    Reference reference;
    reference.request = {.scene_hash = "0123456789abcdef",
                         .tracer = "fedcba9876543210",
                         .size = glm::uvec2(size),
                         .samples = 64,
                         .bounces = 3,
                         .seed = 7};
    reference.estimate.direct = picture_of({0.5F, 1.0F, 0.1F});
    reference.estimate.indirect = picture_of(glm::vec3(2.0F));
    reference.estimate.halves = {picture_of(glm::vec3(1.0F)), picture_of(glm::vec3(3.0F))};
    reference.estimate.hit = {1, 1, 1, 1, 1, 0};
    reference.estimate.edge = {0, 1, 0, 0, 1, 0};
    reference.estimate.seconds = 0.25;
    reference.direct_fine = picture_of({0.4F, 0.9F, 0.2F});
    return reference;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("a reference is read back as it was written") {
    const TemporaryFolder folder;
    for (const std::optional<std::uint32_t> bounces : {std::optional(3U), std::optional<std::uint32_t>()}) {
        Reference written = sample();
        written.request.bounces = bounces;
        write_reference(folder / "reference", "a.gltf", written);
        const Reference read = read_reference(folder / "reference");
        CHECK(read.request == written.request);
        CHECK(read.estimate.direct.pixels == written.estimate.direct.pixels);
        CHECK(read.estimate.indirect.pixels == written.estimate.indirect.pixels);
        CHECK(read.estimate.halves[0].pixels == written.estimate.halves[0].pixels);
        CHECK(read.estimate.halves[1].pixels == written.estimate.halves[1].pixels);
        CHECK(read.estimate.hit == written.estimate.hit);
        CHECK(read.estimate.edge == written.estimate.edge);
        CHECK(read.estimate.seconds == written.estimate.seconds);
        CHECK(read.direct_fine.pixels == written.direct_fine.pixels);
    }
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a pixel of a scaled-down picture is the mean of a square") {
    Picture picture{{4, 2}, {}};
    for (int i = 0; i < 8; ++i) {
        picture.pixels.emplace_back(static_cast<float>(i), 1.0F, 0.0F);
    }
    const Picture small = scaled_down(picture, 2);
    CHECK(small.size == glm::ivec2(2, 1));
    // (0 + 1 + 4 + 5) / 4 and (2 + 3 + 6 + 7) / 4, all of them exact.
    CHECK(small.pixels == std::vector<glm::vec3>{{2.5F, 1.0F, 0.0F}, {4.5F, 1.0F, 0.0F}});
}

TEST_CASE("a difference undoes a sum") {
    const Picture a = picture_of({0.5F, 1.0F, 0.25F});
    CHECK(difference(sum(a, picture_of(glm::vec3(2.0F))), a).pixels == picture_of(glm::vec3(2.0F)).pixels);
}

TEST_CASE("the noise of the mean is a quarter of the halves' relMSE") {
    // Each pixel differs by 2 in every channel from 3, the mean of the picture. The noise is a quarter of
    // 2² / (3² + 0.01 · 3²).
    CHECK(noise(sample().estimate).indirect == doctest::Approx(4.0 / (9.0 * 1.01) / 4.0));
    // With direct light, the same difference is divided by a larger value.
    CHECK(noise(sample().estimate).total < noise(sample().estimate).indirect);
}

TEST_CASE("a folder matches only the request that it was made for") {
    const TemporaryFolder folder;
    const Reference reference = sample();
    CHECK_FALSE(holds(folder / "reference", reference.request));
    write_reference(folder / "reference", "a.gltf", reference);
    CHECK(holds(folder / "reference", reference.request));
    const auto other = [&](auto change) {
        Request request = reference.request;
        change(request);
        return holds(folder / "reference", request);
    };
    CHECK_FALSE(other([](Request& r) { r.scene_hash[0] = '1'; }));
    CHECK_FALSE(other([](Request& r) { r.tracer[0] = '1'; }));
    CHECK_FALSE(other([](Request& r) { r.size.x = 4; }));
    CHECK_FALSE(other([](Request& r) { r.samples = 128; }));
    CHECK_FALSE(other([](Request& r) { r.bounces = 4; }));
    CHECK_FALSE(other([](Request& r) { r.bounces.reset(); }));
    CHECK_FALSE(other([](Request& r) { r.seed = 8; }));
    CHECK_FALSE(other([](Request& r) { r.caustics = false; }));
}

TEST_CASE("a folder with a missing file or a broken description is invalid, and can be written again") {
    const TemporaryFolder folder;
    const Reference reference = sample();
    write_reference(folder / "reference", "a.gltf", reference);
    SUBCASE("a picture is missing") {
        std::filesystem::remove(folder / "reference" / "half1.pfm");
    }
    SUBCASE("the description is cut short") {
        tools::write_text(folder / "reference" / "reference.json", "{\"scene\":");
    }
    SUBCASE("the description is of another version") {
        tools::write_text(folder / "reference" / "reference.json", "{\"scene\":\"a.gltf\"}");
    }
    CHECK_FALSE(holds(folder / "reference", reference.request));
    write_reference(folder / "reference", "a.gltf", reference);
    CHECK(holds(folder / "reference", reference.request));
}

TEST_CASE("if replacing a folder fails, the old one is kept, and nothing else is left") {
    const TemporaryFolder folder;
    const auto fail_half_way = [](const std::filesystem::path& fresh) {
        tools::write_text(fresh / "a", "new");
        throw std::runtime_error("the disc is full");
    };
    CHECK_THROWS(replace_folder(folder / "result", fail_half_way));
    CHECK(folder.file_count() == 0);
    replace_folder(folder / "result", [](const std::filesystem::path& fresh) {
        tools::write_text(fresh / "a", "old");
        tools::write_text(fresh / "b", "old");
    });
    CHECK_THROWS(replace_folder(folder / "result", fail_half_way));
    CHECK(folder.file_count() == 1);
    CHECK(read_text(folder / "result" / "a") == "old");
}

TEST_CASE("a new folder replaces all of the old one") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name) {
        replace_folder(folder / "result/", [&](const std::filesystem::path& fresh) {
            CHECK_FALSE(std::filesystem::exists(folder / "result" / name));
            tools::write_text(fresh / name, name);
        });
    };
    write("a");
    write("b");
    CHECK(folder.file_count() == 1);
    CHECK_FALSE(std::filesystem::exists(folder / "result" / "a"));
    CHECK(read_text(folder / "result" / "b") == "b");
}

TEST_CASE("a reference never replaces a file or folder that is not a reference") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "empty");
    write_reference(folder / "empty", "a.gltf", sample());
    CHECK(holds(folder / "empty", sample().request));
    std::filesystem::create_directory(folder / "mine");
    tools::write_text(folder / "mine" / "letter.txt", "dear reader");
    tools::write_text(folder / "file", "x");
    for (const char* name : {"mine", "file"}) {
        CHECK_THROWS_AS(static_cast<void>(holds(folder / name, sample().request)), std::runtime_error);
        CHECK_THROWS_AS(write_reference(folder / name, "a.gltf", sample()), std::runtime_error);
    }
    CHECK(read_text(folder / "mine" / "letter.txt") == "dear reader");
    CHECK(read_text(folder / "file") == "x");
}

TEST_CASE("if a picture's size differs from the description, the error names the picture") {
    const TemporaryFolder folder;
    write_reference(folder / "reference", "a.gltf", sample());
    tools::write_pfm(folder / "reference" / "indirect.pfm", {{1, 1}, {glm::vec3(1.0F)}});
    try {
        static_cast<void>(read_reference(folder / "reference"));
        FAIL("sizes differ");
    } catch (const std::runtime_error& error) {
        CHECK(std::string(error.what()).find("indirect.pfm: is 1x1") != std::string::npos);
    }
}

TEST_CASE("a reference of an earlier version of the scene is refused") {
    const TemporaryFolder folder;
    const auto text = [](const char* name) {
        return fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"name": "{}"}}]}})",
                           name);
    };
    tools::write_text(folder / "scene.gltf", text("before"));
    Reference reference = sample();
    reference.request.scene_hash = scene_hash(folder / "scene.gltf");
    write_reference(folder / "reference", "scene.gltf", reference);
    const auto read = [&] { return read_reference_of(folder / "scene.gltf", folder / "reference"); };
    CHECK(read().request == reference.request);
    tools::write_text(folder / "scene.gltf", text("after"));
    CHECK_THROWS_AS(static_cast<void>(read()), std::runtime_error);
}

}  // TEST_SUITE("reference files")
