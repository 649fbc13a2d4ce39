// The app among other programs: what the desktop hands to it, and what it takes from the machine.

#include "tests/window/desktop.hpp"
#include "tests/window/app.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Without refinement: the picture comes to rest at once.
TextFile resting_configuration() {
    return {"resting.json", R"({"refinement": {"enabled": false}, "tone_map": {"exposure_ev": -2}})"};
}

/// More frames of refinement than a test has time for.
TextFile refining_configuration() {
    return {"refining.json", R"({"refinement": {"enabled": true, "frames": 65536}})"};
}

/// The app's list of recent files is kept in a folder of the test while this object lives.
class OwnRecentFiles {
 public:
    OwnRecentFiles() {
        setenv("XDG_STATE_HOME", (folder_ / "").c_str(), 1);
    }  // NOLINT(concurrency-mt-unsafe)
    OwnRecentFiles(const OwnRecentFiles&) = delete;
    OwnRecentFiles& operator=(const OwnRecentFiles&) = delete;
    ~OwnRecentFiles() { unsetenv("XDG_STATE_HOME"); }  // NOLINT(concurrency-mt-unsafe)

 private:
    TemporaryFolder folder_;
};

/// Drops a file that cannot be opened. Returns the message.
std::string drop_bad_file(App& app, const fs::path& file) {
    const std::string name = file.filename().string();
    drop_file(app.display(), app.window(), file);
    const Json record = app.wait_for("an error that names " + name, [&](const Json& newest) {
        const Json& errors = newest["errors"];
        return errors.size() == 1 && errors[0].get<std::string>().find(name) != std::string::npos;
    });
    return record["errors"][0];
}

/// The share of one core that a process uses over two seconds.
double load_of(pid_t process) {
    constexpr auto time = 2s;
    const std::chrono::nanoseconds before = cpu_time(process);
    std::this_thread::sleep_for(time);
    return Seconds(cpu_time(process) - before) / Seconds(time);
}

/// Waits until a process has used next to nothing for a fifth of a second: until the frame that was on its
/// way is done.
bool comes_to_rest(pid_t process) {
    return wait_until([&] {
        const std::chrono::nanoseconds before = cpu_time(process);
        std::this_thread::sleep_for(200ms);
        return cpu_time(process) - before < 10ms;
    });
}

int range_of(const Shot& shot) {
    const auto [least, most] = std::ranges::minmax(shot.pixels);
    return most - least;
}

/// The largest difference between horizontal neighbours.
int sharpest_step(const Shot& shot) {
    int step = 0;
    for (int y = 0; y < shot.height; ++y) {
        for (int x = 1; x < shot.width; ++x)
            step = std::max(step, std::abs(shot.at(x, y) - shot.at(x - 1, y)));
    }
    return step;
}

/// Pixels that are nearer to the brightness of the letters than to that of their background.
int ink(const Shot& shot) {
    const int threshold = std::ranges::min(shot.pixels) + range_of(shot) / 2;
    return static_cast<int>(std::ranges::count_if(shot.pixels, [&](int pixel) { return pixel > threshold; }));
}

/// Whether the pixels of each block of 2 x 2 are equal, if the first block begins there.
bool is_doubled(const Shot& shot, int left, int top) {
    for (int y = top; y + 1 < shot.height; y += 2) {
        for (int x = left; x + 1 < shot.width; x += 2) {
            const int first = shot.at(x, y);
            if (shot.at(x + 1, y) != first || shot.at(x, y + 1) != first || shot.at(x + 1, y + 1) != first)
                return false;
        }
    }
    return true;
}

/// Whether the picture is one of half the size with each of its pixels doubled, wherever the doubled pixels
/// begin.
bool is_doubled(const Shot& shot) {
    return is_doubled(shot, 0, 0) || is_doubled(shot, 1, 0) || is_doubled(shot, 0, 1) ||
           is_doubled(shot, 1, 1);
}

/// A control that is only text on a plain ground, and the picture of it.
struct Label {
    Area at;
    Shot shot;
};

Label label_at_scale(float scale) {
    const DisplayScale announced(scale);
    const TextFile resting = resting_configuration();
    const auto pixels = [&](int length) { return static_cast<int>(static_cast<float>(length) * scale); };
    App app({.flags = {"--config", resting.path()},
             .width = pixels(600),
             .height = pixels(300),
             .panel = true,
             .scale = scale});
    static_cast<void>(app.settled());
    CHECK(app.log()["scale"] == scale);
    app.keep("scale");
    const Area at = app.control("open");
    // Without the rounded corners of the button.
    const int margin = pixels(3);
    const Area text = {at.x + margin, at.y + margin, at.width - 2 * margin, at.height - 2 * margin};
    Label label{at, app.shoot(text)};
    CHECK(app.quit() == 0);
    return label;
}

/// Seconds from the key to the end of the process.
double seconds_to_quit(App& app) {
    const Clock::time_point start = Clock::now();
    CHECK(app.quit() == 0);
    return Seconds(Clock::now() - start).count();
}

// Seconds. What the app promises.
constexpr double most_to_quit = 0.5;

}  // namespace

TEST_SUITE("desktop") {
    TEST_CASE("a dropped scene is opened, and a bad file leaves the scene as it is") {
        const OwnRecentFiles recent;
        const TextFile resting = resting_configuration();
        // Its name needs percent signs in a URI.
        const TextFile note("a note, 100 % \xC3\xA4.txt", "no scene");
        const TextFile broken("broken.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"scenes\": [}");
        const fs::path rooms = fs::path(CANDELA_SHIPPED) / "scenes" / "two-rooms.gltf";
        App app({.flags = {"--config", resting.path()}});
        const Shot first = app.settled();

        drop_file(app.display(), app.window(), rooms);
        app.wait_for("the dropped scene",
                     [&](const Json& record) { return record["scene_file"] == rooms.string(); });
        const Shot second = app.settled();
        // Another room in other colours: more than an edge here and there changes.
        CHECK(changed_pixels(first, second, 10) > 480 * 360 / 4);
        CHECK(app.errors().empty());

        const std::string no_scene = drop_bad_file(app, note.path());
        CHECK(app.errors().find(no_scene) != std::string::npos);
        const std::string bad_text = drop_bad_file(app, broken.path());
        CHECK(app.errors().find(bad_text) != std::string::npos);
        // The fault is the brace at the end of the second line.
        CHECK(bad_text.find("line 2") != std::string::npos);
        app.keep("bad-file");
        CHECK(app.log()["scene_file"] == rooms.string());
        app.press_key(XK_Escape);
        app.wait_for("no message", [](const Json& record) { return record["errors"].empty(); });
        CHECK(app.settled() == second);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("controls and text have the size of the display's scale, and are drawn at it") {
        const Label once = label_at_scale(1.0F);
        const Label twice = label_at_scale(2.0F);
        // Sizes are rounded to whole pixels, before or after the scaling.
        CHECK(std::abs(twice.at.height - 2 * once.at.height) <= 2);
        // The same letters with strokes of twice the length and twice the width. Strokes of one to two pixels
        // are rounded to whole ones by much.
        const double more_ink = static_cast<double>(ink(twice.shot)) / ink(once.shot);
        CHECK(more_ink > 2.5);
        CHECK(more_ink < 6.0);
        // A copy without interpolation consists of doubled pixels, and linear interpolation halves each step.
        CHECK_FALSE(is_doubled(twice.shot));
        CHECK(sharpest_step(twice.shot) > 0.75 * range_of(twice.shot));
    }

    TEST_CASE("a minimised window rests, and goes on refining when it is restored") {
        const TextFile refining = refining_configuration();
        App app({.flags = {"--config", refining.path()}});
        app.wait_for("refinement", [](const Json& record) { return record["refined"] > 1; });
        minimise(app.display(), app.window());
        REQUIRE(comes_to_rest(app.process()));
        // The window looks for saved files five times per second; a busy loop would use all of a core.
        CHECK(load_of(app.process()) < 0.02);
        const int refined = app.log()["refined"];
        restore(app.display(), app.window());
        app.wait_for("more refinement", [&](const Json& record) { return record["refined"] > refined + 3; });
        CHECK(app.errors().empty());
        CHECK(seconds_to_quit(app) < most_to_quit);
    }

    TEST_CASE("a window at rest uses next to nothing, and closes at once") {
        const TextFile resting = resting_configuration();
        App app({.flags = {"--config", resting.path()}, .width = 700, .panel = true});
        static_cast<void>(app.settled());
        REQUIRE(comes_to_rest(app.process()));
        CHECK(load_of(app.process()) < 0.01);
        CHECK(seconds_to_quit(app) < most_to_quit);
    }

    TEST_CASE("a window that was as small as can be is as before when it has its size again") {
        const TextFile resting = resting_configuration();
        App app({.flags = {"--config", resting.path()}, .width = 700, .height = 300, .panel = true});
        const Shot picture = app.settled();
        const Json before = app.log();
        REQUIRE(before["controls"].contains("open"));
        XWindowAttributes attributes{};
        XGetWindowAttributes(app.display(), app.window(), &attributes);
        app.resize(1, 1);
        app.wait_for("the smallest window", [](const Json& record) { return record["scene"][2] == 1; });
        app.resize(attributes.width, attributes.height);
        const Json after = app.wait_for("the controls", [&](const Json& record) {
            return record["controls"] == before["controls"] && record["scene"] == before["scene"];
        });
        CHECK(app.settled() == picture);
        CHECK(app.errors().empty());
        CHECK(app.quit() == 0);
    }
}

}  // namespace candela::sandbox
