// What is seen of small files, each of which tells something in a way of its own.

#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/renderer/exhibits.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("gallery") {

using namespace candela;
using namespace candela::test;

namespace {

constexpr glm::uvec2 size{48, 48};

class Gallery : public RenderFixture {
 protected:
    /// A file's scene, seen along -z and lit from there. A Lambertian surface that faces the viewer shows its
    /// albedo.
    Picture picture_of(const GltfBuilder& file) {
        Scene scene;
        warnings = import_gltf(file.gltf(), {}, "exhibit.gltf", scene.world).warnings;
        // Pixel centres are off all corners and edges of the tick.
        scene.camera = add(scene.world, at({0.003F, 0.0017F, 5.0F}), seen_in_parallel());
        add(scene.world, Transform{}, DirectionalLight{.illuminance = 3.14159274F});
        Configuration configuration = linear_configuration();
        configuration.indirect = false;
        configure(configuration);
        return render(scene, size);
    }

    static Camera seen_in_parallel() {
        Camera camera;
        camera.projection = Camera::Projection::orthographic;
        camera.half_height = 1.0F;
        camera.far_plane = 20.0F;
        return camera;
    }

    std::vector<std::string> warnings;
};

/// Pixels that differ by more than rounding.
std::size_t different_pixels(const Picture& a, const Picture& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (glm::distance(a.pixels[i], b.pixels[i]) > 1e-3F) ++count;
    }
    return count;
}

std::size_t pixels_of_colour(const Picture& picture, glm::vec3 colour) {
    return static_cast<std::size_t>(std::ranges::count_if(
        picture.pixels, [&](glm::vec3 pixel) { return glm::distance(pixel, colour) < 1e-3F; }));
}

constexpr glm::vec3 green{0.0F, 1.0F, 0.0F};

/// A file that is changed so that the tick looks the same.
struct Variation {
    const char* name;
    std::function<void(GltfBuilder&)> change;
    std::size_t warnings = 0;
};

Json& material_of(GltfBuilder& file) {
    return file.document["materials"][0];
}

void use_extension(GltfBuilder& file, const char* name) {
    file.document["extensionsUsed"].push_back(name);
}

void turn_around(GltfBuilder& file) {
    file.primitive().erase("indices");
    file.primitive()["indices"] = file.add_indices({1, 0, 2, 3, 1, 2, 3, 2, 4, 5, 3, 4});
    file.primitive()["attributes"].erase("NORMAL");
}

const std::vector<Variation>& variations() {
    static const std::vector<Variation> all{
        {"unlit",
         [](GltfBuilder& file) {
             material_of(file)["extensions"]["KHR_materials_unlit"] = Json::object();
             use_extension(file, "KHR_materials_unlit");
         }},
        {"emission",
         [](GltfBuilder& file) {
             Json& material = material_of(file);
             material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 1};
             material["emissiveFactor"] = {0, 0.5F, 0};
             material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 2;
             use_extension(file, "KHR_materials_emissive_strength");
         }},
        {"back of a double-sided surface",
         [](GltfBuilder& file) {
             turn_around(file);
             material_of(file)["doubleSided"] = true;
         }},
        {"no normals", [](GltfBuilder& file) { file.primitive()["attributes"].erase("NORMAL"); }},
        {"opaque, whatever alpha is",
         [](GltfBuilder& file) {
             material_of(file)["pbrMetallicRoughness"]["baseColorFactor"] = {0, 1, 0, 0.25F};
         }},
        {"blended, all of it", [](GltfBuilder& file) { material_of(file)["alphaMode"] = "BLEND"; }},
        {"occlusion, which is for indirect light",
         [](GltfBuilder& file) {
             Bytes png;
             const Bytes black(16, 0);
             stbi_write_png_to_func(append, &png, 2, 2, 4, black.data(), 8);
             file.add("images", {{"bufferView", file.add_view(png)}, {"mimeType", "image/png"}});
             file.add("textures", {{"source", 0}});
             material_of(file)["occlusionTexture"] = {{"index", 0}};
             file.primitive()["attributes"]["TEXCOORD_0"] =
                 file.add_accessor(std::vector<float>(12, 0.5F), 5126, "VEC2", 2);
         }},
        {"other materials to choose from",
         [](GltfBuilder& file) {
             file.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
             file.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
             file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {
                 {{"material", 1}, {"variants", {0}}}};
             use_extension(file, "KHR_materials_variants");
         }},
        {"an extension that nobody knows",
         [](GltfBuilder& file) {
             use_extension(file, "EXT_of_nobody");
             file.document["extensionsRequired"] = {"EXT_of_nobody"};
         },
         1},
        {"points and lines beside it",
         [](GltfBuilder& file) {
             for (const int mode : {0, 1, 3}) {
                 file.add_primitive({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0})["mode"] = mode;
             }
         },
         1},
    };
    return all;
}

}  // namespace

TEST_CASE_FIXTURE(Gallery, "the plain file shows a green tick on black") {
    const Picture tick = picture_of(Exhibit{}.file());
    // Its area, by the corners of its triangles, is 0.625 m² of 4 m².
    const double share = 0.625 / 4.0;
    const auto pixels = static_cast<double>(tick.pixels.size());
    const auto seen = static_cast<double>(pixels_of_colour(tick, green));
    CHECK(seen == doctest::Approx(share * pixels).epsilon(0.05));  // a tenth of its pixels is at an edge
    CHECK(pixels_of_colour(tick, glm::vec3(0.0F)) == tick.pixels.size() - static_cast<std::size_t>(seen));
}

TEST_CASE_FIXTURE(Gallery, "each pair of ways to tell the same shows the same") {
    const Picture tick = picture_of(Exhibit{}.file());
    for (const Exhibit& exhibit : all_exhibits()) {
        CAPTURE(static_cast<int>(exhibit.order));
        CAPTURE(static_cast<int>(exhibit.layout));
        CAPTURE(static_cast<int>(exhibit.place));
        CAPTURE(static_cast<int>(exhibit.colour));
        CAPTURE(static_cast<int>(exhibit.motion));
        const Picture shown = picture_of(exhibit.file());
        CHECK(warnings.empty());
        // Transforms round positions: by 1e-4 of a pixel's width, or a hundredth for integers.
        CHECK(different_pixels(shown, tick) <= 1);
    }
}

TEST_CASE_FIXTURE(Gallery, "materials, and what is skipped, leave the tick as it is") {
    const Picture tick = picture_of(Exhibit{}.file());
    for (const Variation& variation : variations()) {
        CAPTURE(variation.name);
        GltfBuilder file = Exhibit{}.file();
        variation.change(file);
        const Picture shown = picture_of(file);
        CHECK(warnings.size() == variation.warnings);
        CHECK(different_pixels(shown, tick) == 0);
    }
}

TEST_CASE_FIXTURE(Gallery, "nothing is seen of a single-sided back, or of what is blended away") {
    GltfBuilder back = Exhibit{}.file();
    turn_around(back);
    GltfBuilder clear = Exhibit{}.file();
    material_of(clear)["alphaMode"] = "BLEND";
    material_of(clear)["pbrMetallicRoughness"]["baseColorFactor"] = {0, 1, 0, 0};
    for (const GltfBuilder& file : {back, clear}) {
        const Picture shown = picture_of(file);
        CHECK(pixels_of_colour(shown, glm::vec3(0.0F)) == shown.pixels.size());
    }
}

TEST_CASE_FIXTURE(Gallery, "in place of a missing picture a checker is seen, with one warning") {
    GltfBuilder file = Exhibit{.colour = Exhibit::Colour::texture}.file();
    file.document["images"][0] = {{"uri", "missing.png"}};
    // All of the picture once over the tick.
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor(
        std::vector<float>{0.2F, 0.3F, 0, 0.5F, 0.4F, 0.5F, 0.4F, 1, 0.8F, 0, 1, 0.2F}, 5126, "VEC2", 2);
    const Picture shown = picture_of(file);
    CHECK(warnings.size() == 1);
    const auto magenta = static_cast<std::size_t>(std::ranges::count_if(
        shown.pixels, [](glm::vec3 pixel) { return pixel.r > 0.5F && pixel.g == 0.0F && pixel.b > 0.5F; }));
    const std::size_t tick = pixels_of_colour(picture_of(Exhibit{}.file()), green);
    CHECK(magenta > tick / 4);
    CHECK(magenta < 3 * tick / 4);
}

}  // TEST_SUITE("gallery")
