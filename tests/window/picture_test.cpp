// Drags, scripts and saved configurations, and what the picture shows.

#include "tests/window/app.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr int width = 480;
constexpr int height = 360;

// As in the file of the shipped Cornell box: a camera at (0, 1, 3.9) with this field of view looks along -Z
// at a back wall at z = -1; a light is at (0, 1.6, 0).
constexpr double vertical_fov = 0.685914;

/// Pixels per metre at this distance in front of the camera.
double pixels_per_metre(double depth) {
    return height / (2.0 * depth * std::tan(vertical_fov / 2.0));
}

/// Dark enough that nothing is clipped to white, where differences vanish. Without refinement, so that the
/// picture stops changing as soon as nothing moves.
TextFile dark_configuration() {
    return {"dark.json", R"({"tone_map": {"exposure_ev": -3}, "refinement": {"enabled": false}})"};
}

/// The middle of the brightest part of the back wall, in a row above the blocks and below the marker of the
/// light.
double brightest_column(const Shot& shot) {
    const int row = static_cast<int>(std::lround(height / 2.0 - 0.4 * pixels_per_metre(4.9)));
    const int left = static_cast<int>(width / 2.0 - 0.95 * pixels_per_metre(4.9));
    int most = 0;
    for (int x = left; x < width - left; ++x) most = std::max(most, shot.at(x, row));
    double sum = 0.0;
    int count = 0;
    for (int x = left; x < width - left; ++x) {
        if (shot.at(x, row) < most - 3) continue;  // a rounding step in each channel
        sum += x + 0.5;
        ++count;
    }
    return sum / count;
}

constexpr double light_depth = 3.9;
constexpr double moved_by = 0.4;  // metres, to the right

double light_x() {
    return width / 2.0;
}
double light_y() {
    return height / 2.0 - 0.6 * pixels_per_metre(light_depth);
}

void drag_light(App& app) {
    app.drag(light_x(), light_y(), light_x() + moved_by * pixels_per_metre(light_depth), light_y());
}

/// Where the wall is brightest with the light at `x` metres and the camera at `camera_x` metres, in pixels.
double column_of(double x, double camera_x = 0.0) {
    return width / 2.0 + (x - camera_x) * pixels_per_metre(4.9);
}

/// About 20 pixels of the wall are rounded to the same brightness; their middle is accurate to a few pixels.
constexpr double column_tolerance = 4.0;

/// To the left and right of the box nothing is ever lit.
void check_same_beside_the_box(const Shot& before, const Shot& after) {
    const int edge = static_cast<int>(width / 2.0 - 1.02 * pixels_per_metre(2.9));
    REQUIRE(edge > 10);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < edge; ++x) {
            REQUIRE(before.at(x, y) == after.at(x, y));
            REQUIRE(before.at(width - 1 - x, y) == after.at(width - 1 - x, y));
        }
    }
}

}  // namespace

TEST_SUITE("window") {
    TEST_CASE("a wall is brightest right behind the light, also after the light is dragged") {
        const TextFile dark = dark_configuration();
        App app({.flags = {"--indirect", "off", "--config", dark.path()}});
        // The irradiance I·d/r³ on the wall is largest at the foot of the perpendicular.
        const Shot before = app.settled();
        CHECK(std::abs(brightest_column(before) - column_of(0.0)) < column_tolerance);
        drag_light(app);
        const Shot after = app.settled();
        CHECK(std::abs(brightest_column(after) - column_of(moved_by)) < column_tolerance);
        check_same_beside_the_box(before, after);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("indirect light moves with the light") {
        const TextFile dark = dark_configuration();
        App app({.flags = {"--show", "indirect", "--vpls", "32", "--bounces", "1", "--config", dark.path()}});
        const Shot before = app.settled();
        drag_light(app);
        const Shot after = app.settled();
        // VPLs concentrate on the wall that the light has approached, and leave the one that it moved away
        // from.
        CHECK(mean(after, width / 2, width) > mean(before, width / 2, width));
        CHECK(mean(after, 0, width / 2) < mean(before, 0, width / 2));
        check_same_beside_the_box(before, after);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("a drag on empty space turns the view and does not move the light") {
        const TextFile dark = dark_configuration();
        App app({.flags = {"--indirect", "off", "--config", dark.path()}});
        const Shot before = app.settled();
        app.drag(240.0, 300.0, 200.0, 290.0);
        const Shot turned = app.settled();
        CHECK_FALSE(before == turned);
        app.drag(200.0, 290.0, 240.0, 300.0);
        const Shot back = app.settled();
        // Except where rounding of the pose moves an edge across a pixel.
        CHECK(changed_pixels(before, back, 6) < 50);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("a script plays to its end, and keys step it and play it again") {
        const TextFile dark = dark_configuration();
        const TextFile script("script.json", R"({"frames": 20, "tracks": [{"node": "ceiling light",
            "translation": [[0, [-0.4, 1.6, 0]], [19, [0.4, 1.6, 0]]]}]})");
        App app({.flags = {"--indirect", "off", "--config", dark.path(), "--animate", script.path()}});
        const auto column = [&] { return brightest_column(app.settled()); };
        CHECK(std::abs(column() - column_of(0.4)) < column_tolerance);
        app.press_key(XK_period);
        CHECK(std::abs(column() - column_of(-0.4)) < column_tolerance);
        for (int step = 0; step < 5; ++step) app.press_key(XK_period);
        CHECK(std::abs(column() - column_of(-0.4 + 5 * 0.8 / 19)) < column_tolerance);
        app.press_key(XK_space);
        CHECK(std::abs(column() - column_of(0.4)) < column_tolerance);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("after a script has ended its light can be dragged, and a step moves it back") {
        const TextFile dark = dark_configuration();
        const TextFile script("script.json", R"({"frames": 2, "tracks": [{"node": "ceiling light",
            "interpolation": "step", "translation": [[0, [-0.4, 1.6, 0]], [1, [0, 1.6, 0]]]}]})");
        App app({.flags = {"--indirect", "off", "--config", dark.path(), "--animate", script.path()}});
        const auto column = [&] { return brightest_column(app.settled()); };
        CHECK(std::abs(column() - column_of(0.0)) < column_tolerance);
        drag_light(app);
        CHECK(std::abs(column() - column_of(moved_by)) < column_tolerance);
        app.press_key(XK_period);
        CHECK(std::abs(column() - column_of(-0.4)) < column_tolerance);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("the view follows a camera that a script moves, and can be orbited after the end") {
        const TextFile dark = dark_configuration();
        const TextFile script("script.json", R"({"frames": 10, "tracks": [{"node": "camera",
            "translation": [[0, [0, 1, 3.9]], [9, [0.3, 1, 3.9]]]}]})");
        App app({.flags = {"--indirect", "off", "--config", dark.path(), "--animate", script.path()}});
        const Shot ended = app.settled();
        CHECK(std::abs(brightest_column(ended) - column_of(0.0, 0.3)) < column_tolerance);
        app.drag(240.0, 300.0, 200.0, 290.0);
        CHECK_FALSE(app.settled() == ended);
        app.press_key(XK_period);
        CHECK(std::abs(brightest_column(app.settled()) - column_of(0.0)) < column_tolerance);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("written pictures have full quality, however small the frame budget is") {
        const TemporaryFolder folder;
        const auto written = [&](const std::string& budget_ms) {
            const fs::path config = folder / "config.json";
            const fs::path out = folder / "out.pfm";
            std::ofstream(config) << R"({"refinement": {"enabled": false}, "frame_budget_ms": )" << budget_ms
                                  << "}";
            const std::string command =
                std::string(CANDELA_APP) +
                " --context window --size 160x120 --vpls 64 --animate orbit-camera --frames 6"
                " --config " +
                config.string() + " --out " + out.string() + " > /dev/null";
            REQUIRE(std::system(command.c_str()) == 0);
            return text_of(out);
        };
        const std::string whole = written("0");
        CHECK(whole.size() > 160 * 120 * 12);
        CHECK((written("0.001") == whole));
    }

    TEST_CASE("a saved configuration takes effect, and an invalid one changes nothing") {
        const TemporaryFolder folder;
        const fs::path config = folder / "config.json";
        const fs::path report = folder / "report.json";
        const fs::path graph = folder / "graph.txt";
        std::ofstream(config) << R"({"path": "deferred"})";
        App app({.flags = {"--indirect", "off", "--config", config.string(), "--report", report.string(),
                           "--describe-graph", graph.string()}});
        // All paths show the same picture, so the exposure shows which configuration is active.
        const double before = mean(app.settled(), 0, width);
        std::ofstream(config) << R"({"path": "forward+", "tone_map": {"exposure_ev": -3}})";
        CHECK(wait_until([&] { return mean(app.shoot(), 0, width) < 0.7 * before; }));
        const Shot switched = app.settled();

        std::ofstream(config) << R"({"path": "fastest", "tone_map": {"exposure_ev": 3}})";
        CHECK(wait_until([&] { return app.errors().find("config.json: path: ") != std::string::npos; }));
        // The message covers the lower edge of the picture.
        const Area scene = app.scene();
        static_cast<void>(app.settled());
        const Shot now = app.shoot({scene.x, scene.y, scene.width, scene.height / 2});
        CHECK(std::equal(now.pixels.begin(), now.pixels.end(), switched.pixels.begin()));

        const std::string said = app.errors();
        CHECK(app.quit() == 0);
        CHECK(nlohmann::json::parse(text_of(report))["config"]["path"] == "forward+");
        CHECK(text_of(graph).find("depth-prepass") != std::string::npos);
        CHECK(text_of(graph).find("gbuffer") == std::string::npos);
        CHECK_MESSAGE(said.find("fastest") == said.rfind("fastest"), said);
        CHECK_MESSAGE(std::count(said.begin(), said.end(), '\n') == 1, said);
    }
}

}  // namespace candela::sandbox
