#include "tests/reference/closed_forms.hpp"

#include <doctest/doctest.h>

TEST_SUITE("reference: closed forms") {

using namespace candela::reference;

TEST_CASE("a plane under a point light") {
    CHECK(plane_under_point_light());
}
TEST_CASE("a plane under a light of limited range") {
    CHECK(plane_under_ranged_light());
}
TEST_CASE("a plane under a spot light") {
    CHECK(plane_under_spot_light());
}
TEST_CASE("a plane under a directional light") {
    CHECK(plane_under_directional_light());
}

TEST_CASE("a plane under a rectangle that emits light") {
    CHECK(plane_under_rectangle());
    CHECK(plane_under_half_a_rectangle());
}
TEST_CASE("a plane under the sky: uniform, beside a wall, and of one bright texel") {
    CHECK(plane_under_uniform_sky());
    CHECK(plane_beside_wall());
    CHECK(plane_under_bright_texel());
}

TEST_CASE("a sphere that emits light everywhere is equally bright everywhere") {
    for (const double albedo : {0.2, 0.8}) {
        CAPTURE(albedo);
        CHECK(glowing_sphere(albedo));
    }
}

TEST_CASE("a sphere lit from its centre is equally bright everywhere") {
    for (const double albedo : {0.2, 0.5, 0.9, 0.99}) {
        CAPTURE(albedo);
        CHECK(sphere_furnace(albedo));
    }
}

TEST_CASE("a closed box receives the light's flux / (1 - albedo)") {
    for (const double albedo : {0.3, 0.6, 0.8}) {
        CAPTURE(albedo);
        CHECK(box_furnace(albedo));
    }
}

TEST_CASE("a disc is lit according to the form factor of the lit disc opposite") {
    CHECK(parallel_discs());
}
TEST_CASE("the difference of the halves gives the noise of their mean") {
    CHECK(noise_of_discs());
}

}  // TEST_SUITE("reference: closed forms")

TEST_SUITE("reference: errors in the tracer are detected") {

using namespace candela::reference;

TEST_CASE("without the cosine") {
    CHECK_FALSE(plane_under_point_light(Defect::drop_cosine));
    CHECK_FALSE(plane_under_ranged_light(Defect::drop_cosine));
    CHECK_FALSE(plane_under_spot_light(Defect::drop_cosine));
    CHECK_FALSE(plane_under_directional_light(Defect::drop_cosine));
    CHECK_FALSE(box_furnace(0.6, Defect::drop_cosine));
    CHECK_FALSE(parallel_discs(Defect::drop_cosine));
}

TEST_CASE("without the π") {
    CHECK_FALSE(plane_under_point_light(Defect::drop_pi));
    CHECK_FALSE(plane_under_ranged_light(Defect::drop_pi));
    CHECK_FALSE(plane_under_spot_light(Defect::drop_pi));
    CHECK_FALSE(plane_under_directional_light(Defect::drop_pi));
    CHECK_FALSE(sphere_furnace(0.5, Defect::drop_pi));
    CHECK_FALSE(box_furnace(0.6, Defect::drop_pi));
    CHECK_FALSE(parallel_discs(Defect::drop_pi));
}

TEST_CASE("without a bounce") {
    CHECK_FALSE(sphere_furnace(0.5, Defect::drop_bounce));
    CHECK_FALSE(box_furnace(0.6, Defect::drop_bounce));
    CHECK_FALSE(parallel_discs(Defect::drop_bounce));
}

}  // TEST_SUITE("reference: errors in the tracer are detected")
