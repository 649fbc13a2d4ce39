// Opens the app's window, drags a light with the pointer like a user, and examines what the display shows.

// Before X11's macros.
#include <doctest/doctest.h>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/sandbox/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using candela::sandbox::TemporaryFolder;

constexpr int width = 480;
constexpr int height = 360;

// As in the file of the shipped Cornell box: a camera at (0, 1, 3.9) with this field of view looks along -Z
// at a back wall at z = -1; a light is at (0, 1.6, 0).
constexpr double vertical_fov = 0.685914;

/// Pixels per metre at this distance in front of the camera.
double pixels_per_metre(double depth) {
    return height / (2.0 * depth * std::tan(vertical_fov / 2.0));
}

bool wait_until(const std::function<bool()>& condition) {
    // Long enough for a software driver that shares two cores with a build.
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (std::chrono::steady_clock::now() < deadline) {
        if (condition()) return true;
        std::this_thread::sleep_for(100ms);
    }
    return false;
}

struct CloseDisplay {
    void operator()(Display* display) const { XCloseDisplay(display); }
};

/// The contents of the window: the brightness of each pixel, which is the sum of its channels of 0 to 255.
struct Shot {
    std::vector<int> pixels;
    [[nodiscard]] int at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
    }
    bool operator==(const Shot&) const = default;
};

double mean(const Shot& shot, int left, int right) {
    double sum = 0.0;
    for (int y = 0; y < height; ++y) {
        for (int x = left; x < right; ++x) sum += shot.at(x, y);
    }
    return sum / (height * (right - left));
}

/// The app in a window. Its panel covers part of the picture, so it is hidden immediately.
class App {
 public:
    /// The app's stderr goes to the file `errors`, or, if that is empty, to the test's stderr.
    explicit App(std::vector<std::string> flags, const fs::path& errors = {})
        : display_(XOpenDisplay(nullptr)) {
        REQUIRE_MESSAGE(display_, "no display: run under xvfb-run");
        flags.insert(flags.begin(), {CANDELA_APP, "--context", "window", "--size", "480x360"});
        std::vector<char*> arguments;
        arguments.reserve(flags.size() + 1);
        for (std::string& flag : flags) arguments.push_back(flag.data());
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        if (!errors.empty()) {
            posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(),
                                             O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
        }
        const int error = posix_spawn(&process_, CANDELA_APP, &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        REQUIRE(error == 0);
        REQUIRE_MESSAGE(wait_until([&] { return find_window(DefaultRootWindow(display_.get())); }),
                        "no window");
        // Before the picture there is text on black, which is darker.
        REQUIRE_MESSAGE(wait_until([&] { return mean(shoot(), 0, width) > 30.0; }), "no picture");
        move_pointer(width / 2.0, height - 10.0);
        press_key(XK_F1);
    }
    App(const App&) = delete;
    App& operator=(const App&) = delete;
    ~App() {
        if (process_ == 0) return;
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }

    [[nodiscard]] Shot shoot() {
        XImage* image = XGetImage(display_.get(), window_, 0, 0, width, height, AllPlanes, ZPixmap);
        REQUIRE(image != nullptr);
        Shot shot;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const unsigned long rgb = XGetPixel(image, x, y);
                shot.pixels.push_back(
                    static_cast<int>((rgb & 0xFFU) + ((rgb >> 8U) & 0xFFU) + ((rgb >> 16U) & 0xFFU)));
            }
        }
        XDestroyImage(image);
        return shot;
    }

    /// Waits until the picture stops changing; returns it.
    [[nodiscard]] Shot settled() {
        Shot last = shoot();
        int equal = 0;
        const bool rested = wait_until([&] {
            std::this_thread::sleep_for(200ms);
            Shot now = shoot();
            equal = now == last ? equal + 1 : 0;
            last = std::move(now);
            return equal >= 3;
        });
        REQUIRE_MESSAGE(rested, "the picture never comes to rest");
        return last;
    }

    void drag(double from_x, double from_y, double to_x, double to_y) {
        move_pointer(from_x, from_y);
        button(true);
        constexpr int steps = 8;
        for (int step = 1; step <= steps; ++step) {
            const double part = static_cast<double>(step) / steps;
            move_pointer(from_x + part * (to_x - from_x), from_y + part * (to_y - from_y));
        }
        button(false);
    }

    void press_key(KeySym key) {
        const KeyCode code = XKeysymToKeycode(display_.get(), key);
        XTestFakeKeyEvent(display_.get(), code, True, CurrentTime);
        XTestFakeKeyEvent(display_.get(), code, False, CurrentTime);
        pause();
    }

    /// Closes the app by keyboard; returns the exit status.
    int quit() {
        press_key(XK_Escape);
        int status = -1;
        const bool ended = wait_until([&] { return waitpid(process_, &status, WNOHANG) == process_; });
        REQUIRE_MESSAGE(ended, "Escape does not end the app");
        process_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

 private:
    bool find_window(Window parent) {
        Window root = 0;
        Window ignored = 0;
        Window* children = nullptr;
        unsigned count = 0;
        if (XQueryTree(display_.get(), parent, &root, &ignored, &children, &count) == 0) return false;
        const std::unique_ptr<Window, decltype(&XFree)> owner(children, &XFree);
        return std::any_of(children, children + count, [&](Window child) { return is_app(child); });
    }

    bool is_app(Window candidate) {
        XWindowAttributes attributes{};
        char* name = nullptr;
        if (XFetchName(display_.get(), candidate, &name) == 0) return false;
        const std::unique_ptr<char, decltype(&XFree)> owner(name, &XFree);
        XGetWindowAttributes(display_.get(), candidate, &attributes);
        const bool found = std::string(name) == "Candela" && attributes.map_state == IsViewable;
        if (found) window_ = candidate;
        return found;
    }

    void move_pointer(double x, double y) {
        int left = 0;
        int top = 0;
        Window child = 0;
        XTranslateCoordinates(display_.get(), window_, DefaultRootWindow(display_.get()), 0, 0, &left, &top,
                              &child);
        XTestFakeMotionEvent(display_.get(), -1, left + static_cast<int>(std::lround(x)),
                             top + static_cast<int>(std::lround(y)), CurrentTime);
        pause();
    }

    void button(bool down) {
        XTestFakeButtonEvent(display_.get(), 1, down ? True : False, CurrentTime);
        pause();
    }

    /// Waits a little, like a user.
    void pause() {
        XSync(display_.get(), False);
        std::this_thread::sleep_for(30ms);
    }

    std::unique_ptr<Display, CloseDisplay> display_;
    Window window_ = 0;
    pid_t process_ = 0;
};

/// Dark enough that nothing is clipped to white, where differences vanish. Without refinement, so that the
/// picture stops changing as soon as nothing moves.
class DarkConfiguration {
 public:
    DarkConfiguration() {
        std::ofstream(path()) << R"({"tone_map": {"exposure_ev": -3}, "refinement": {"enabled": false}})";
    }
    [[nodiscard]] std::string path() const { return (folder_ / "dark.json").string(); }

 private:
    TemporaryFolder folder_;
};

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
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

/// A script in a temporary file.
class ScriptFile {
 public:
    explicit ScriptFile(const std::string& json) { std::ofstream(path()) << json; }
    [[nodiscard]] std::string path() const { return (folder_ / "script.json").string(); }

 private:
    TemporaryFolder folder_;
};

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
        const DarkConfiguration dark;
        App app({"--indirect", "off", "--config", dark.path()});
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
        const DarkConfiguration dark;
        App app({"--show", "indirect", "--vpls", "32", "--bounces", "1", "--config", dark.path()});
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
        const DarkConfiguration dark;
        App app({"--indirect", "off", "--config", dark.path()});
        const Shot before = app.settled();
        app.drag(240.0, 300.0, 200.0, 290.0);
        const Shot turned = app.settled();
        CHECK_FALSE(before == turned);
        app.drag(200.0, 290.0, 240.0, 300.0);
        const Shot back = app.settled();
        // Except where rounding of the pose moves an edge across a pixel.
        int changed = 0;
        for (std::size_t i = 0; i < before.pixels.size(); ++i)
            changed += std::abs(before.pixels[i] - back.pixels[i]) > 6 ? 1 : 0;
        CHECK(changed < 50);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("a script plays to its end, and keys step it and play it again") {
        const DarkConfiguration dark;
        const ScriptFile script(R"({"frames": 20, "tracks": [{"node": "ceiling light",
            "translation": [[0, [-0.4, 1.6, 0]], [19, [0.4, 1.6, 0]]]}]})");
        App app({"--indirect", "off", "--config", dark.path(), "--animate", script.path()});
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
        const DarkConfiguration dark;
        const ScriptFile script(R"({"frames": 2, "tracks": [{"node": "ceiling light",
            "interpolation": "step", "translation": [[0, [-0.4, 1.6, 0]], [1, [0, 1.6, 0]]]}]})");
        App app({"--indirect", "off", "--config", dark.path(), "--animate", script.path()});
        const auto column = [&] { return brightest_column(app.settled()); };
        CHECK(std::abs(column() - column_of(0.0)) < column_tolerance);
        drag_light(app);
        CHECK(std::abs(column() - column_of(moved_by)) < column_tolerance);
        app.press_key(XK_period);
        CHECK(std::abs(column() - column_of(-0.4)) < column_tolerance);
        CHECK(app.quit() == 0);
    }

    TEST_CASE("the view follows a camera that a script moves, and can be orbited after the end") {
        const DarkConfiguration dark;
        const ScriptFile script(R"({"frames": 10, "tracks": [{"node": "camera",
            "translation": [[0, [0, 1, 3.9]], [9, [0.3, 1, 3.9]]]}]})");
        App app({"--indirect", "off", "--config", dark.path(), "--animate", script.path()});
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
        const fs::path errors = folder / "errors.txt";
        std::ofstream(config) << R"({"path": "deferred"})";
        App app({"--indirect", "off", "--config", config.string(), "--report", report.string(),
                 "--describe-graph", graph.string()},
                errors);
        // All paths show the same picture, so the exposure shows which configuration is active.
        const double before = mean(app.settled(), 0, width);
        std::ofstream(config) << R"({"path": "forward+", "tone_map": {"exposure_ev": -3}})";
        CHECK(wait_until([&] { return mean(app.shoot(), 0, width) < 0.7 * before; }));
        const Shot switched = app.settled();

        std::ofstream(config) << R"({"path": "fastest", "tone_map": {"exposure_ev": 3}})";
        CHECK(wait_until([&] { return text_of(errors).find("config.json: path: ") != std::string::npos; }));
        CHECK(app.settled() == switched);

        CHECK(app.quit() == 0);
        CHECK(nlohmann::json::parse(text_of(report))["config"]["path"] == "forward+");
        CHECK(text_of(graph).find("depth-prepass") != std::string::npos);
        CHECK(text_of(graph).find("gbuffer") == std::string::npos);
        const std::string said = text_of(errors);
        CHECK_MESSAGE(said.find("fastest") == said.rfind("fastest"), said);
        CHECK_MESSAGE(std::count(said.begin(), said.end(), '\n') == 1, said);
    }
}
