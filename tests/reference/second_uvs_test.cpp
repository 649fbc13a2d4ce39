// Images by second texture coordinates in the reference against the same images, moved.

#include <doctest/doctest.h>

#include <cstddef>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/second_uvs.hpp"

TEST_SUITE("reference: second texture coordinates") {

using namespace candela;
using reference::Estimate;

namespace {

Estimate traced(Moved moved) {
    Scene scene;
    add(scene.world, Transform{.scale = {-1, 1, 1}},
        MeshInstance{patch_of(*square(1.0F, nullptr), patterned(moved))});
    add(scene.world, Transform{}, PointLight{});
    add(scene.world, at({0.3F, 1.5F, 0.2F}), PointLight{.intensity = 3.0F});
    Environment sky;
    sky.radiance = glm::vec3(0.5F);
    add(scene.world, sky);
    scene.camera = add(scene.world, looking({0.4F, 2.0F, 1.2F}, {0, 0, 0}), Camera{});
    return trace(reference::Scene(scene.world), scene.camera, {.size = {16, 12}, .samples = 4});
}

/// The mean absolute difference of all light.
double distance(const Estimate& a, const Estimate& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.direct.pixels.size(); ++i) {
        const glm::dvec3 difference =
            glm::abs(glm::dvec3(a.direct.pixels[i]) - glm::dvec3(b.direct.pixels[i])) +
            glm::abs(glm::dvec3(a.indirect.pixels[i]) - glm::dvec3(b.indirect.pixels[i]));
        sum += (difference.r + difference.g + difference.b) / 3.0;
    }
    return sum / static_cast<double>(a.direct.pixels.size());
}

}  // namespace

TEST_CASE("every image lies where it belongs, also on a mirrored instance") {
    const Estimate expected = traced(Moved::by_images);
    // The same random numbers; positions in the images are rounded in another order, which rarely turns a
    // choice by chance.
    CHECK(distance(traced(Moved::by_second_uvs), expected) < 0.002);
    CHECK(distance(traced(Moved::not_at_all), expected) > 0.05);
}

}  // TEST_SUITE("reference: second texture coordinates")
