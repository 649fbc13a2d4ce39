// What a user does with pointer and keyboard, and what the window shows.

#include "tests/window/app.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace candela::sandbox {

TEST_SUITE("session") {

namespace {

using Json = nlohmann::json;

constexpr int width = 480;
constexpr int height = 360;

// As in the file of the shipped Cornell box: a camera at (0, 1, 3.9) with this field of view looks along -Z
// at a back wall at z = -1; a light is at (0, 1.6, 0).
constexpr double vertical_fov = 0.685914;
constexpr double light_depth = 3.9;
constexpr double moved_by = 0.4;  // metres, to the right

/// Pixels per metre at this distance in front of the camera.
double pixels_per_metre(double depth) {
    return height / (2.0 * depth * std::tan(vertical_fov / 2.0));
}

glm::vec3 to_point(const Json& json) {
    return {json[0], json[1], json[2]};
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

/// The irradiance I·d/r³ on the wall is largest at the foot of the perpendicular from a light at `x` metres.
/// About 20 pixels of the wall are rounded to the same brightness; their middle is accurate to a few pixels.
void check_light_at(double x, const Shot& shot) {
    constexpr double tolerance = 4.0;
    CHECK(std::abs(brightest_column(shot) - (width / 2.0 + x * pixels_per_metre(4.9))) < tolerance);
}

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

constexpr int rounding = 9;  // of the sum of three channels

/// Flies forwards, and goes back to the scene's camera.
void fly_and_return(App& app, const Shot& before) {
    const glm::vec3 start = to_point(app.log()["eye"]);
    app.hold_key(XK_w, "a flight along -z",
                 [&](const Json& record) { return to_point(record["eye"]).z < start.z - 0.05F; });
    CHECK(std::abs(to_point(app.log()["eye"]).x - start.x) < 1e-4F);
    app.press_key(XK_Home);
    app.wait_for("the start", [&](const Json& record) { return to_point(record["eye"]) == start; });
    CHECK(changed_pixels(before, app.settled(), rounding) == 0);
}

/// Turns the view and turns it back, which does not move the light.
void orbit_and_return(App& app, const Shot& before) {
    app.drag(240.0, 300.0, 200.0, 290.0);
    const Shot turned = app.settled();
    CHECK_FALSE(before == turned);
    app.drag(200.0, 290.0, 240.0, 300.0);
    // Except where rounding of the pose moves an edge across a pixel.
    CHECK(changed_pixels(before, app.settled(), 6) < 50);
    CHECK(app.log()["undo"] == 0);
    app.press_key(XK_Home);
}

void drag_light(App& app, const Shot& before) {
    const double x = width / 2.0;
    const double y = height / 2.0 - 0.6 * pixels_per_metre(light_depth);
    app.drag(x, y, x + moved_by * pixels_per_metre(light_depth), y);
    const Json dragged = app.wait_for("an edit", [](const Json& record) { return record["undo"] == 1; });
    CHECK(dragged["selected"] == "ceiling light");
    // The grabbed point stays under the pointer, which is at a whole pixel.
    CHECK(glm::distance(to_point(dragged["position"]), {moved_by, 1.6F, 0.0F}) <
          1.0 / pixels_per_metre(light_depth));
    const Shot moved = app.settled();
    app.keep("dragged");
    check_light_at(moved_by, moved);
    CHECK(changed_pixels(before, moved, rounding) > width * height / 10);
    check_same_beside_the_box(before, moved);
}

void undo_and_redo(App& app, const Shot& before) {
    app.press_key(XK_z, {XK_Control_L});
    const Json undone =
        app.wait_for("the undone edit", [](const Json& record) { return record["redo"] == 1; });
    CHECK(glm::distance(to_point(undone["position"]), {0.0F, 1.6F, 0.0F}) < 1e-6F);
    app.press_key(XK_Escape);  // deselects
    app.wait_for("no selection", [](const Json& record) { return record["selected"].is_null(); });
    CHECK(changed_pixels(before, app.settled(), rounding) == 0);
    app.press_key(XK_y, {XK_Control_L});
    app.wait_for("the edit again", [](const Json& record) { return record["undo"] == 1; });
}

/// One configuration, its preset chosen by key, and what of its light is shown, beside a second one.
void compare(App& app) {
    const auto press_preset = [&](KeySym key, const char* name) {
        app.press_key(key);
        app.wait_for(name, [&](const Json& record) { return record["configuration"] == name; });
    };
    press_preset(XK_1, "draft");
    const Shot total = app.settled();
    app.open_tab("Light", "direct");
    app.click("direct");
    app.wait_for("the direct light", [](const Json& record) { return record["show"] == "direct"; });
    CHECK(mean(app.settled()) < mean(total));
    app.click("total");
    app.wait_for("all light", [](const Json& record) { return record["show"] == "total"; });

    // Two equal configurations differ nowhere; a paths preset differs from surfels.
    app.click("divider");
    app.wait_for("the divider", [](const Json& record) { return record["compare"] == "divider"; });
    app.click("difference");
    app.wait_for("the difference", [](const Json& record) { return record["compare"] == "difference"; });
    const Area scene = app.scene();
    // Without markers, and below the names of the two.
    const Area left{scene.x, scene.y + scene.height / 2, scene.width / 3, scene.height / 2};
    static_cast<void>(app.settled());
    CHECK(mean(app.shoot(left)) == 0.0);
    press_preset(XK_4, "report");
    static_cast<void>(app.settled());
    app.keep("difference");
    CHECK(mean(app.shoot(left)) > 0.0);
}

/// Resources of the frame graph instead of the picture.
void inspect(App& app) {
    app.open_tab("Graph", "gbuffer");
    // Beside the controls: their tooltips cover some of the picture.
    const auto uncovered = [&] {
        app.move(10.0, 10.0);
        return app.settled();
    };
    const Shot picture = uncovered();
    Shot last = picture;
    const auto check_shown = [&](const std::string& name) {
        const Shot shown = uncovered();
        app.keep("resource-" + name);
        CHECK_MESSAGE(changed_pixels(last, shown, rounding) > 1000, name);
        CHECK(app.log()["errors"].empty());
        last = shown;
    };
    app.click("gbuffer");
    for (const char* resource : {"albedo", "normal", "depth"}) {
        app.click(resource);
        app.wait_for(resource, [&](const Json& newest) { return newest["view"] == resource; });
        check_shown(resource);
    }
    for (int i = 0; i < 2; ++i) {
        const Json view = app.log()["view"];
        app.press_key(XK_n);
        const Json next =
            app.wait_for("the next resource", [&](const Json& newest) { return newest["view"] != view; });
        check_shown(next["view"]);
    }
    app.press_key(XK_Escape);
    app.wait_for("the picture", [](const Json& record) { return record["view"].is_null(); });
    CHECK(changed_pixels(picture, uncovered(), rounding) == 0);
}

}  // namespace

TEST_CASE("pointer and keys fly, orbit, drag a light, undo, play a script, delete and add lights") {
    // Dark enough that nothing is clipped to white, where differences vanish. Without refinement, so that
    // the picture stops changing as soon as nothing moves.
    const TextFile dark("dark.json",
                        R"({"tone_map": {"exposure_ev": -3}, "refinement": {"enabled": false}})");
    const TextFile script("script.json", R"({"frames": 2, "tracks": [{"node": "ceiling light",
            "interpolation": "step", "translation": [[0, [-0.4, 1.6, 0]], [1, [0, 1.6, 0]]]}]})");
    App app({.flags = {"--indirect", "off", "--config", dark.path(), "--animate", script.path()},
             .width = width,
             .height = height});
    const Shot before = app.settled();
    check_light_at(0.0, before);  // where the script ends
    fly_and_return(app, before);
    orbit_and_return(app, before);
    drag_light(app, before);
    undo_and_redo(app, before);

    app.press_key(XK_period);
    check_light_at(-0.4, app.settled());  // where the script begins
    app.press_key(XK_space);
    check_light_at(0.0, app.settled());

    app.press_key(XK_Delete);
    app.wait_for("the deleted light", [](const Json& record) { return record["undo"] == 2; });
    const Shot unlit = app.settled();
    CHECK(mean(unlit) < 0.05 * mean(before));
    app.press_key(XK_l);
    app.wait_for("another light", [](const Json& record) { return record["undo"] == 3; });
    CHECK(mean(app.settled()) > 10.0 * mean(unlit));
    CHECK(app.errors().empty());
    CHECK(app.quit() == 0);
}

TEST_CASE("resources are seen instead of the picture, and presets, views and comparisons are chosen") {
    const TextFile still("still.json",
                         R"({"refinement": {"enabled": false}, "tone_map": {"exposure_ev": -2}})");
    App app({.flags = {"--config", still.path(), "--vpls", "16", "--path", "tiled-deferred"},
             .width = 720,
             .height = 800,  // the graph panel lists all passes
             .panel = true});
    static_cast<void>(app.settled());
    inspect(app);
    compare(app);
    app.click("panel");
    app.wait_for("no panel", [](const Json& record) { return record["scene"][2] == 720; });
    app.click("panel");
    app.wait_for("the panel", [](const Json& record) { return record["scene"][2] == 480; });
    CHECK(app.quit() == 0);
}
}  // TEST_SUITE("session")

}  // namespace candela::sandbox
