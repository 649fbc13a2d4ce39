#include "sandbox/headless/report.hpp"

#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <candela/tools/run_report.hpp>
#include "tests/throws.hpp"

namespace candela::sandbox {

TEST_SUITE("report") {

namespace {

EnergyAccount balanced() {
    return {.emitted = {10.0, 20.0, 40.0},
            .absorbed = {5.0, 10.0, 20.0},
            .escaped = {2.0, 5.0, 10.0},
            .truncated = {2.0, 4.0, 9.0},
            .roulette = {1.0, 1.0, 1.0},
            .roulette_error = {0.5, 0.25, 0.125}};
}

tools::RunReport some_run() {
    tools::RunReport run{"EGL surfaceless", "a/\xFF.gltf", "orbit.json", {640, 480}, {}, {}, {}};
    run.frames.push_back({.index = 3,
                          .cpu_ms = 1.5,
                          .gpu_ms = 2.5,
                          .passes = {{"gbuffer", true, 0.5, 1.0}, {"vpl-trace", false, 0.0, 0.0}}});
    run.state.gl_renderer = "a driver";
    run.state.triangles = 36;
    run.state.vpls =
        VplReport{.requested = 256, .alive = 251, .paths = 120, .flux = balanced(), .estimated_error = 0.25};
    run.state.lights = {
        .count = 300, .with_map = 2, .without_map = 1, .global = 4, .tile_max = 19, .tile_mean = 6.5};
    run.state.memory = {
        .texture_bytes = 7, .buffer_bytes = 8, .shared_by_aliasing_bytes = 9, .free_pool_bytes = 0};
    return run;
}

}  // namespace

TEST_CASE("report.json has the members that scripts use") {
    const auto json = nlohmann::json::parse(to_json(some_run()));
    CHECK(json["gl_renderer"] == "a driver");
    CHECK(json["context"] == "EGL surfaceless");
    CHECK(json["animation"] == "orbit.json");
    CHECK(json["triangles"] == 36);
    CHECK(json["size"] == nlohmann::json::array({640, 480}));
    CHECK(json["config"]["vpls"]["count"] == Configuration{}.vpls.count);
    CHECK(json["frames"][0]["index"] == 3);
    CHECK(json["frames"][0]["passes"][0]["name"] == "gbuffer");
    CHECK(json["frames"][0]["passes"][0]["gpu_ms"] == 1.0);
    CHECK(json["frames"][0]["passes"][1]["ran"] == false);
    CHECK(json["vpls"]["alive"] == 251);
    CHECK(json["vpls"]["estimated_error"] == 0.25);
    CHECK(json["vpls"]["flux"]["truncated"] == nlohmann::json::array({2.0, 4.0, 9.0}));
    CHECK(json["vpls"]["flux"]["roulette_error"] == nlohmann::json::array({0.5, 0.25, 0.125}));
    CHECK(json["lights"]["with_map"] == 2);
    CHECK(json["lights"]["without_map"] == 1);
    CHECK(json["lights"]["global"] == 4);
    CHECK(json["lights"]["tile_max"] == 19);
    CHECK(json["lights"]["tile_mean"] == 6.5);
    CHECK(json["lights"]["overflowed_tiles"] == 0);
    CHECK(json["memory"]["shared_by_aliasing_bytes"] == 9);
}

TEST_CASE("the sky is in the report, if there is one") {
    tools::RunReport run = some_run();
    CHECK(nlohmann::json::parse(to_json(run))["environment"].is_null());
    run.environment = {.radiance = {1.0F, 0.5F, 0.25F}, .picture = nullptr, .rotation = 0.5F};
    const auto plain = nlohmann::json::parse(to_json(run))["environment"];
    CHECK(plain["radiance"] == nlohmann::json::array({1.0, 0.5, 0.25}));
    CHECK(plain["picture"].is_null());
    CHECK(plain["rotation"] == 0.5);
    run.environment.picture = std::make_shared<const SkyPicture>(SkyPicture{4, 2, {}});
    CHECK(nlohmann::json::parse(to_json(run))["environment"]["picture"] == nlohmann::json::array({4, 2}));
}

TEST_CASE("without indirect light there is no energy account") {
    tools::RunReport run = some_run();
    run.state.vpls.reset();
    CHECK(nlohmann::json::parse(to_json(run))["vpls"].is_null());
    CHECK(to_table(run.frames[0], run.state).find("emitted") == std::string::npos);
}

TEST_CASE("an error that nobody asked for is not in the report") {
    tools::RunReport run = some_run();
    run.state.vpls->estimated_error.reset();
    CHECK(nlohmann::json::parse(to_json(run))["vpls"]["estimated_error"].is_null());
    CHECK(to_table(run.frames[0], run.state).find("relMSE") == std::string::npos);
}

TEST_CASE("the table mentions light lists only if there are any") {
    tools::RunReport run = some_run();
    CHECK(to_table(run.frames[0], run.state).find("6.5 in the mean, 19 at most") != std::string::npos);
    run.state.lights.tile_max = 0;
    CHECK(to_table(run.frames[0], run.state).find("in a list") == std::string::npos);
}

TEST_CASE("the residual is the relative loss of the worst channel") {
    CHECK(relative_residual(balanced()) < 1e-12);
    EnergyAccount lossy = balanced();
    lossy.absorbed.g -= 2.0;
    CHECK(relative_residual(lossy) == doctest::Approx(0.1));
    CHECK(relative_residual({}) == 0.0);
    lossy.escaped.b = std::numeric_limits<double>::quiet_NaN();
    CHECK(relative_residual(lossy) == std::numeric_limits<double>::infinity());
}

TEST_CASE("lost energy is an error that names the scene") {
    Report state;
    check_energy("a.gltf", state);  // without VPLs there is no account
    state.vpls.emplace();
    state.vpls->paths = 1;
    state.vpls->flux = balanced();
    check_energy("a.gltf", state);
    state.vpls->flux.absorbed.g -= 2.0;
    CHECK_THROWS_WITH_AS(check_energy("a.gltf", state),
                         "a.gltf: 10 % of the emitted flux is unaccounted for: the picture is wrong",
                         PictureError);
    // With surfels, which have no paths, the account is only as accurate as they are dense.
    state.vpls->paths = 0;
    check_energy("a.gltf", state);
    state.vpls->flux.absorbed.g = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(check_energy("a.gltf", state), PictureError);
}

TEST_CASE("pixels that are not finite are an error that tells how many and where the first is") {
    tools::Picture picture{{3, 2}, std::vector<glm::vec3>(6, glm::vec3(1.0F))};
    CHECK_NOTHROW(check_finite(picture, 7));
    picture.pixels[4].g = std::numeric_limits<float>::quiet_NaN();
    picture.pixels[5].b = std::numeric_limits<float>::infinity();
    CHECK(throws<PictureError>([&] { check_finite(picture, 7); },
                               "frame 7: 2 pixels are not finite, the first in column 1 of row 1"));
}

TEST_CASE("the table names every pass and tells which ones ran") {
    const tools::RunReport run = some_run();
    const std::string table = to_table(run.frames[0], run.state);
    for (const char* word :
         {"gbuffer", "vpl-trace", "yes", "emitted", "251 alive of 256", "120 paths", "relMSE 0.25", "36"}) {
        CHECK_MESSAGE(table.find(word) != std::string::npos, word);
    }
}
}  // TEST_SUITE("report")

}  // namespace candela::sandbox
