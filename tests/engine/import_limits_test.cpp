// Limits of imports: memory, files outside of the root, cancelling.

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <stb/stb_image_write.h>
#include <tiny_gltf.h>

#include <candela/scene/hierarchy.hpp>
#include "tests/engine/malformed_gltf.hpp"
#include "tests/memory.hpp"

TEST_SUITE("import limits") {

using namespace candela;
using namespace candela::test;

namespace {

/// The import's error; "imported" on success.
std::string outcome(const Bytes& file, const ImportOptions& options, const std::filesystem::path& base = {}) {
    World world;
    try {
        (void)import_gltf(file, base, "scene.gltf", world, options);
    } catch (const SceneError& error) {
        CHECK(world.size() == 0);
        return error.what();
    }
    return "imported";
}

/// Checks that an import with the limit `used` works, and that one less is refused with a message that names
/// it.
void check_limit(const Bytes& file, std::uint64_t ImportLimits::*limit, std::uint64_t used,
                 const std::string& name) {
    CAPTURE(name);
    ImportOptions options;
    options.limits.*limit = used + 1;
    CHECK(outcome(file, options) == "imported");
    options.limits.*limit = used;
    CHECK(outcome(file, options) == "imported");
    options.limits.*limit = used - 1;
    const std::string error = outcome(file, options);
    CHECK(error.starts_with("scene.gltf: "));
    CHECK(error.ends_with("(" + name + ")"));
}

/// Three grey pixels.
constexpr const char* three_pixels =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAMAAAABCAAAAAA+i0toAAAADElEQVR4nGMQaPgAAAIkAYFvkeRkAAAAAElFTkSuQmCC";

/// The bytes of sixteen_bit_png.
Bytes png() {
    Bytes bytes;
    std::string type;
    REQUIRE(tinygltf::DecodeDataURI(&bytes, type, sixteen_bit_png, 0, false));
    return bytes;
}

/// A chain of nodes, each the child of the one before, with the only mesh.
GltfBuilder chain(int count) {
    GltfBuilder file = complete_scene();
    Json& nodes = file.document["nodes"] = Json::array();
    for (int i = 0; i < count; ++i) {
        nodes.push_back(i + 1 < count ? Json{{"mesh", 0}, {"children", {i + 1}}} : Json{{"mesh", 0}});
    }
    return file;
}

/// A triangle whose buffer is in a file.
GltfBuilder with_buffer_file(const std::string& uri) {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0});
    file.document["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    return file;
}

std::string outcome_of_uri(const std::string& uri, const std::filesystem::path& folder,
                           const ImportOptions& options) {
    return outcome(to_bytes(with_buffer_file(uri).document.dump()), options, folder);
}

std::string refused(const std::string& uri) {
    return "scene.gltf: buffer 0: " + uri + " is outside of the folder that files are read from";
}

}  // namespace

TEST_CASE("each limit holds at, below and above what a file uses") {
    const Bytes file = complete_scene().gltf();
    check_limit(file, &ImportLimits::bytes, file.size(), "bytes");
    check_limit(file, &ImportLimits::image_pixels, 2, "image_pixels");
    // One picture of two pixels, once as colours and once as normals.
    check_limit(file, &ImportLimits::pixels, 2 + 2, "pixels");
    check_limit(file, &ImportLimits::nodes, 3, "nodes");
    check_limit(file, &ImportLimits::depth, 2, "depth");
    check_limit(file, &ImportLimits::triangles, 1, "triangles");
}

TEST_CASE("the pixels of all pictures count together") {
    GltfBuilder file = complete_scene();
    file.document["images"] = {{{"uri", sixteen_bit_png}}, {{"uri", three_pixels}}};
    file.document["textures"] = {{{"source", 0}}, {{"source", 1}}};
    file.document["materials"][0]["emissiveTexture"]["index"] = 1;
    check_limit(file.gltf(), &ImportLimits::pixels, 2 + 2 + 3, "pixels");
}

TEST_CASE("memory may be 64 MiB, or a multiple of the bytes of the files") {
    // Quads without normals that share accessors: 3 · 48 bytes for the vertices of each triangle alone.
    GltfBuilder file;
    file.add_primitive(std::vector<float>(9 * 20'000, 0.5F));
    const Json primitive = file.primitive();
    for (int i = 1; i < 40; ++i) {
        file.document["meshes"][0]["primitives"].push_back(primitive);
    }
    const Bytes bytes = file.glb();
    ImportOptions options;
    CHECK(outcome(bytes, options).ends_with("(growth)"));
    options.limits.growth = 1000;
    CHECK(outcome(bytes, options) == "imported");
    options.limits.growth = 0;
    CHECK(outcome(complete_scene().gltf(), options) == "imported");
}

TEST_CASE("memory for tangents that are to be derived counts") {
    // 200 primitives share 3,000 vertices: 29 MB as they are, and more than 64 MiB if each may be split.
    GltfBuilder file = complete_scene();
    std::vector<float> positions(3 * 3000, 0.5F);
    positions[3] = positions[7] = 1.5F;  // a triangle that has an area
    Json primitive = file.add_primitive(positions);
    primitive["attributes"]["NORMAL"] = file.add_vectors(std::vector<float>(3 * 3000, 1.0F));
    file.document["meshes"][0]["primitives"] = std::vector<Json>(200, primitive);
    CHECK(outcome(file.glb(), {}) == "imported");
    for (Json& each : file.document["meshes"][0]["primitives"]) each["material"] = 0;
    CHECK(outcome(file.glb(), {}).ends_with("(growth)"));
}

TEST_CASE("8,000 buffers that name one file read it once") {
    const TemporaryDirectory folder;
    write_file(folder / "same.bin", Bytes(256 * 1024));
    GltfBuilder file;
    file.document["buffers"] = Json::array();
    for (int i = 0; i < 8000; ++i) {
        file.document["buffers"].push_back(
            {{"byteLength", 1}, {"uri", i % 2 == 0 ? "same.bin" : "./same%2Ebin"}});
    }
    const std::uint64_t before = resident_bytes();
    ImportOptions options;
    options.limits.bytes = 1024 * 1024;  // of both files; counted each time, they would be 2 GB
    CHECK(outcome(to_bytes(file.document.dump()), options, folder / "") == "imported");
    if (!is_sanitized) CHECK(resident_bytes() < before + (64U << 20U));
}

TEST_CASE("what the scene does not use is not read") {
    GltfBuilder file = complete_scene();
    file.add("images", {{"uri", "../nowhere.png"}});
    file.add("textures", {{"source", 1}});
    file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
    const Json primitive{{"attributes", {{"POSITION", 0}}}, {"material", 1}};
    file.add("meshes", {{"primitives", std::vector<Json>(2000, primitive)}});
    ImportOptions options;
    options.limits.triangles = 1;
    CHECK(outcome(file.gltf(), options) == "imported");
    file.document["nodes"][1]["mesh"] = 1;
    CHECK(outcome(file.gltf(), {}) ==
          "scene.gltf: image 1: ../nowhere.png is outside of the folder that files are read from");
}

TEST_CASE("a few vertices of a large accessor are read, and sparse ones among them") {
    GltfBuilder file;
    std::vector<float> positions(3000, 0.0F);
    positions[3 * 700] = 1.0F;      // vertex 700
    positions[3 * 900 + 1] = 1.0F;  // vertex 900
    file.add_primitive(positions);
    const std::size_t indices = file.add_view(std::vector<std::uint32_t>{10, 900, 950});
    const std::size_t values = file.add_view(std::vector<float>{0, 0, 5, 0, 2, 0, 7, 7, 7});
    file.document["accessors"][0]["sparse"] = {
        {"count", 3},
        {"indices", {{"bufferView", indices}, {"componentType", 5125}}},
        {"values", {{"bufferView", values}}}};
    file.primitive()["indices"] = file.add_indices({700, 900, 10});
    World world;
    const ImportReport report = import_gltf(file.gltf(), {}, "few.gltf", world);
    REQUIRE(report.triangles == 1);
    const Primitive& read = world.get<MeshInstance>(report.entities[0]).mesh->primitives[0];
    REQUIRE(read.vertices.size() == 3);
    const auto corner = [&](std::size_t i) { return read.vertices[read.indices[i]].position; };
    CHECK(corner(0) == glm::vec3(1, 0, 0));
    CHECK(corner(1) == glm::vec3(0, 2, 0));
    CHECK(corner(2) == glm::vec3(0, 0, 5));
}

TEST_CASE("images of the same file are decoded once and shared") {
    GltfBuilder file = complete_scene();
    const TemporaryDirectory folder;
    write_file(folder / "two.png", png());
    file.document["images"] = {{{"uri", "two.png"}}, {{"uri", "./two.png"}}};
    file.document["textures"] = {{{"source", 0}}, {{"source", 1}}};
    file.document["materials"][0]["emissiveTexture"]["index"] = 1;
    file.document["materials"][0].erase("normalTexture");  // which is decoded as other values
    ImportOptions options;
    options.limits.pixels = 2;
    World world;
    const ImportReport report = import_gltf(file.gltf(), folder / "", "scene.gltf", world, options);
    const Material& material = *world.get<MeshInstance>(report.entities[0]).mesh->primitives[0].material;
    CHECK(material.base_colour_texture != nullptr);
    CHECK(material.base_colour_texture == material.emissive_texture);
}

TEST_CASE("what a PNG claims to hold is checked before memory is allocated for it") {
    const auto warning_of = [](const Bytes& image) -> std::string {
        const TemporaryDirectory folder;
        write_file(folder / "a.png", image);
        GltfBuilder file = complete_scene();
        file.document["images"] = {{{"uri", "a.png"}}};
        const Imported imported(file.gltf(), folder / "");
        return imported.report.warnings.empty() ? "" : imported.report.warnings.front();
    };
    CHECK(warning_of(png()).empty());

    SUBCASE("a chunk of 1.9 GB in a file of less than 100 bytes") {
        Bytes cut = png();
        const std::string_view type = "IDAT";
        const auto chunk = std::search(cut.begin(), cut.end(), type.begin(), type.end()) - 4;
        chunk[0] = 0x78;
        const std::string warning = warning_of(cut);  // which of the two depends on the version of libpng
        CHECK((warning.starts_with("image 0: a.png: it cannot be decoded: IDAT: chunk data is too large;") ||
               warning.starts_with("image 0: a.png: it is cut short;")));
    }

    SUBCASE("data of 4,096 x 4,096 pixels where the header says 2 x 1") {
        constexpr int side = 4096;
        const std::vector<unsigned char> black(std::size_t{side} * side);
        Bytes large;
        REQUIRE(stbi_write_png_to_func(append, &large, side, side, 1, black.data(), side) != 0);
        REQUIRE(large.size() < 200'000);
        constexpr std::size_t header = 33;  // bytes of the signature and the chunk IHDR
        const Bytes small = png();
        std::ranges::copy(std::span(small).first(header), large.begin());
        CHECK(warning_of(large).starts_with(
            "image 0: a.png: it cannot be decoded: IDAT: Too much image data;"));
    }
}

TEST_CASE("only files inside the root are read") {
    const TemporaryDirectory outer;
    std::filesystem::create_directories(outer / "root/inner");
    std::filesystem::create_directories(outer / "rooted");
    const Bytes corners(36);
    for (const char* name : {"secret.bin", "root/beside.bin", "root/inner/own.bin", "rooted/x.bin"}) {
        write_file(outer / name, corners);
    }
    const std::filesystem::path scene = outer / "root/inner";
    CHECK(outcome_of_uri("own.bin", scene, {}) == "imported");
    CHECK(outcome_of_uri("../inner/own.bin", scene, {}) == "imported");
    const std::string absolute = (outer / "secret.bin").string();
    for (const std::string& uri : {std::string("../beside.bin"), std::string("..%2Fbeside.bin"), absolute,
                                   std::string("//server/share.bin")}) {
        CAPTURE(uri);
        CHECK(outcome_of_uri(uri, scene, {}) == refused(uri));
    }
    ImportOptions wider;
    wider.root = outer / "root";
    CHECK(outcome_of_uri("../beside.bin", scene, wider) == "imported");
    CHECK(outcome_of_uri("../../secret.bin", scene, wider) == refused("../../secret.bin"));
    CHECK(outcome_of_uri("../../rooted/x.bin", scene, wider) == refused("../../rooted/x.bin"));
}

TEST_CASE("neither links nor devices lead out of the root" * doctest::test_suite("posix")) {
    const TemporaryDirectory outer;
    std::filesystem::create_directories(outer / "root");
    write_file(outer / "secret.bin", Bytes(36));
    std::filesystem::create_symlink(outer / "secret.bin", outer / "root/link.bin");
    std::filesystem::create_directory_symlink(outer / "", outer / "root/up");
    for (const char* uri : {"link.bin", "up/secret.bin"}) {
        CAPTURE(uri);
        CHECK(outcome_of_uri(uri, outer / "root", {}) == refused(uri));
    }
    ImportOptions widest;
    widest.root = "/";
    CHECK(outcome_of_uri((outer / "secret.bin").string(), outer / "root", widest) == "imported");
    CHECK(outcome_of_uri("/dev/zero", outer / "root", widest) ==
          "scene.gltf: buffer 0: /dev/zero is not a file");
}

TEST_CASE("a NUL in a name is refused, and control characters are made visible") {
    CHECK(outcome_of_uri("a%00.bin", ".", {}) == "scene.gltf: buffer 0: a%00.bin contains a NUL character");
    CHECK(outcome_of_uri(std::string("a\0.bin", 6), ".", {}) ==
          "scene.gltf: buffer 0: a\\x00.bin contains a NUL character");
    CHECK(outcome_of_uri("\x1B[2J.bin", ".", {}) == "scene.gltf: buffer 0: \\x1B[2J.bin does not exist");
}

TEST_CASE("messages quote no content of files") {
    const TemporaryDirectory folder;
    write_file(folder / "secret.bin", to_bytes("root:x:0:0:"));
    CHECK(outcome(to_bytes("root:x:0:0:"), {}).find("root") == std::string::npos);
    GltfBuilder file = complete_scene();
    file.document["images"] = {{{"uri", "secret.bin"}}};
    const Imported imported(file.gltf(), folder / "");
    REQUIRE(imported.report.warnings.size() == 1);
    CHECK(imported.report.warnings[0].find("root") == std::string::npos);
    file.document["buffers"] = {{{"uri", "secret.bin"}, {"byteLength", 11}}};
    const std::string error = outcome(to_bytes(file.document.dump()), {}, folder / "");
    CHECK(error != "imported");
    CHECK(error.find("root") == std::string::npos);
}

TEST_CASE("long names are cut and warnings are readable") {
    GltfBuilder file = complete_scene();
    file.document["extensionsUsed"].push_back("\x1B]0;" + std::string(5'000'000, 'x'));
    World world;
    const ImportReport report = import_gltf(file.gltf(), {}, "scene.gltf", world);
    CHECK(std::ranges::all_of(report.warnings, [](const std::string& warning) {
        return warning.size() < 300 && warning.find('\x1B') == std::string::npos;
    }));
}

TEST_CASE("a chain of 100,000 nodes takes seconds at most") {
    const Bytes file = chain(100'000).gltf();
    const auto start = std::chrono::steady_clock::now();
    World world;
    const ImportReport report = import_gltf(file, {}, "scene.gltf", world);
    // Takes 0.5 s, 5 s with sanitizers; in quadratic time it would take minutes.
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(30));
    REQUIRE(report.entities.size() == 100'000);
    CHECK(world_matrix(world, report.entities.back()) == glm::mat4(1.0F));
    ImportOptions options;
    options.limits.depth = 99'999;
    CHECK(outcome(file, options).ends_with("(depth)"));
}

TEST_CASE("progress rises, and can cancel at each step without a change of the world") {
    const Bytes file = complete_scene().gltf();
    std::vector<std::string> steps;
    ImportOptions options;
    options.progress = [&](const ImportProgress& progress) {
        steps.emplace_back(progress.doing);
        CHECK(progress.share >= 0.0);
        CHECK(progress.share <= 1.0);
        return true;
    };
    CHECK(outcome(file, options) == "imported");
    CHECK(steps == std::vector<std::string>{"reading files", "reading nodes", "reading materials and images",
                                            "reading meshes", "creating entities"});
    for (std::size_t last = 1; last <= steps.size(); ++last) {
        std::size_t calls = 0;
        options.progress = [&](const ImportProgress&) { return ++calls < last; };
        World world;
        CHECK_THROWS_AS((void)import_gltf(file, {}, "scene.gltf", world, options), ImportCancelled);
        CHECK(world.size() == 0);
        CHECK(calls == last);
    }
}

}  // TEST_SUITE("import limits")
