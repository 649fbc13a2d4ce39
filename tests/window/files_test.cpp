// Files that the desktop hands to the app, and files that change while it runs.

#include "tests/window/app.hpp"
#include "tests/window/desktop.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <candela/tools/output_file.hpp>
#include "sandbox/files/shipped_file.hpp"

namespace candela::sandbox {

TEST_SUITE("files") {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int width = 400;
constexpr int height = 300;
constexpr int rounding = 9;  // of the sum of three channels

/// The user's files, in the folder that the app runs in. Pictures are compared at rest, so none is refined.
struct Files {
    TemporaryFolder folder;
    fs::path config = folder / "config.json";
    fs::path tone_map = folder / "shaders/output/tone_map.frag";
    fs::path report = folder / "report.json";
    fs::path graph = folder / "graph.txt";
    fs::path out = folder / "out.pfm";

    Files() {
        fs::copy(shipped_file("shaders", ""), folder / "shaders", fs::copy_options::recursive);
        save_configuration("deferred", -2);
    }
    void save_configuration(const std::string& path, int exposure_ev) const {
        const Json text = {{"path", path},
                           {"refinement", {{"enabled", false}}},
                           {"tone_map", {{"exposure_ev", exposure_ev}}}};
        tools::write_text(config, text.dump());
    }
    [[nodiscard]] std::vector<std::string> flags() const {
        return {"--config", config.string(), "--shaders",        (folder / "shaders").string(),
                "--report", report.string(), "--describe-graph", graph.string(),
                "--out",    out.string(),    "--vpls",           "16"};
    }
};

/// Drops a file that cannot be opened. Returns the message.
std::string drop_bad_file(App& app, const fs::path& file) {
    const std::string name = file.filename().string();
    drop_file(app.display(), app.window(), file);
    const Json record = app.wait_for("an error that names " + name, [&](const Json& newest) {
        const Json& errors = newest["errors"];
        return errors.size() == 1 && errors[0].get<std::string>().find(name) != std::string::npos;
    });
    CHECK(app.errors().find(record["errors"][0].get<std::string>()) != std::string::npos);
    return record["errors"][0];
}

void drop_scenes(App& app) {
    // Its name needs percent signs in a URI.
    const TextFile note("a note, 100 % \xC3\xA4.txt", "no scene");
    const TextFile broken("broken.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"scenes\": [}");
    const fs::path rooms = shipped_file("scenes", "two-rooms.gltf");
    const Shot first = app.settled();
    drop_file(app.display(), app.window(), rooms);
    app.wait_for("the dropped scene",
                 [&](const Json& record) { return record["scene_file"] == rooms.string(); });
    const Shot second = app.settled();
    // Another room in other colours: more than an edge here and there changes.
    CHECK(changed_pixels(first, second, 10) > width * height / 4);
    CHECK(app.errors().empty());

    static_cast<void>(drop_bad_file(app, note.path()));
    // The fault is the brace at the end of the second line.
    CHECK(drop_bad_file(app, broken.path()).find("line 2") != std::string::npos);
    app.keep("bad-file");
    CHECK(app.log()["scene_file"] == rooms.string());
    app.press_key(XK_Escape);
    app.wait_for("no message", [](const Json& record) { return record["errors"].empty(); });
    CHECK(app.settled() == second);
}

void save_configurations(App& app, const Files& files) {
    // All paths show the same picture, so the exposure shows which configuration is active.
    const double before = mean(app.settled());
    files.save_configuration("forward+", -3);
    CHECK(wait_until([&] { return mean(app.shoot()) < 0.7 * before; }));
    const Shot switched = app.settled();

    const std::size_t said = app.errors().size();
    files.save_configuration("fastest", 3);
    app.wait_for("the fault", [](const Json& record) { return record["errors"].size() == 1; });
    const std::string fault = app.errors().substr(said);
    CHECK_MESSAGE(fault.find("config.json: path: ") != std::string::npos, fault);
    CHECK_MESSAGE(std::ranges::count(fault, '\n') == 1, fault);
    // The message covers the lower edge of the picture.
    static_cast<void>(app.settled());
    const Area scene = app.scene();
    const Shot now = app.shoot({scene.x, scene.y, scene.width, scene.height / 2});
    CHECK(std::equal(now.pixels.begin(), now.pixels.end(), switched.pixels.begin()));
    app.press_key(XK_Escape);
    app.wait_for("no message", [](const Json& record) { return record["errors"].empty(); });
}

void save_shaders(App& app, const Files& files) {
    const Shot before = app.settled();
    const std::string good = text_of(files.tone_map);
    tools::write_text(files.tone_map, good + "this is no GLSL\n");
    app.wait_for("a fault", [](const Json& record) { return record["errors"].size() == 1; });
    CHECK(app.errors().find("tone_map.frag") != std::string::npos);
    CHECK(changed_pixels(before, app.shoot(), rounding) < width * height / 2);
    // Half as bright.
    std::string dim = good;
    const std::string line = "colour = vec4(shown,";
    REQUIRE(dim.find(line) != std::string::npos);
    dim.replace(dim.find(line), line.size(), "colour = vec4(0.5 * shown,");
    tools::write_text(files.tone_map, dim);
    app.wait_for("no fault", [](const Json& record) { return record["errors"].empty(); });
    CHECK(std::abs(mean(app.settled()) / mean(before) - 0.5) < 0.02);
}

void save_and_open(App& app, const Files& files) {
    app.press_key(XK_l);
    app.wait_for("another light", [](const Json& record) { return record["undo"] == 1; });
    app.press_key(XK_Escape);  // its name would be shown
    const Shot before = app.settled();
    app.press_key(XK_s, {XK_Control_L});
    REQUIRE(wait_until([&] { return fs::exists(files.folder / "candela-001.gltf"); }));
    // All at once, before the app can draw anything. Typed letters go into the field: none of them flies,
    // changes presets or deletes anything.
    const Json record = app.log();
    app.type_with_control(XK_o);
    app.type("candela-0");
    app.press_key(XK_Tab);  // completes the name
    app.keep("open");
    app.press_key(XK_Return);
    app.wait_for("the saved scene", [](const Json& newest) {
        return newest["scene_file"].get<std::string>().ends_with("candela-001.gltf");
    });
    CHECK(changed_pixels(before, app.settled(), rounding) == 0);
    CHECK(app.log()["configuration"] == record["configuration"]);
    CHECK(app.log()["eye"] == record["eye"]);
    CHECK(app.log()["undo"] == 0);
    // A field that has the keyboard lets the app be closed.
    app.type_with_control(XK_o);
    app.type("c");
    static_cast<void>(app.control("file name"));
    app.keep("open");
}

void check_results(const Files& files) {
    CHECK(Json::parse(text_of(files.report))["config"]["path"] == "forward+");
    CHECK(text_of(files.graph).find("depth-prepass") != std::string::npos);
    CHECK(text_of(files.graph).find("gbuffer") == std::string::npos);
    CHECK(text_of(files.out).size() > width * height * 12);
}

}  // namespace

TEST_CASE("dropped, opened and saved files take effect, and faulty ones change nothing") {
    const Files files;
    App app(
        {.flags = files.flags(), .width = width, .height = height, .folder = (files.folder / "").string()});
    drop_scenes(app);
    save_configurations(app, files);
    save_shaders(app, files);
    save_and_open(app, files);
    const std::string said = app.errors();
    CHECK_MESSAGE(said.find("fastest") == said.rfind("fastest"), said);
    CHECK(app.quit() == 0);
    check_results(files);
}
}  // TEST_SUITE("files")

}  // namespace candela::sandbox
