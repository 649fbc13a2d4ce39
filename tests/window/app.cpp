#include "tests/window/app.hpp"

#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>
#include <thread>

#include <candela/tools/picture.hpp>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;

using Clock = std::chrono::steady_clock;

constexpr int status_height = 22;  // at a scale of 1

struct DestroyImage {
    void operator()(XImage* image) const { XDestroyImage(image); }
};
using Image = std::unique_ptr<XImage, DestroyImage>;

Image get_image(Display* display, Window window, const Area& area) {
    Image image(XGetImage(display, window, area.x, area.y, static_cast<unsigned>(area.width),
                          static_cast<unsigned>(area.height), AllPlanes, ZPixmap));
    REQUIRE(image);
    return image;
}

std::array<std::uint8_t, 3> channels(unsigned long pixel) {
    return {static_cast<std::uint8_t>(pixel >> 16U), static_cast<std::uint8_t>(pixel >> 8U),
            static_cast<std::uint8_t>(pixel)};
}

}  // namespace

double mean(const Shot& shot) {
    return std::reduce(shot.pixels.begin(), shot.pixels.end(), 0.0) / static_cast<double>(shot.pixels.size());
}

int changed_pixels(const Shot& a, const Shot& b, int tolerance) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    int changed = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        changed += std::abs(a.pixels[i] - b.pixels[i]) > tolerance ? 1 : 0;
    }
    return changed;
}

bool wait_until(const std::function<bool()>& condition) {
    const auto deadline = Clock::now() + 60s;
    while (Clock::now() < deadline) {
        if (condition()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return false;
}

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

void TextFile::write(const std::string& text) const {
    std::ofstream(path_) << text;
}

App::App(Start start) : display_(XOpenDisplay(nullptr)) {
    REQUIRE_MESSAGE(display_, "no display: run under xvfb-run");
    // That a window is gone shows when it does not answer; Xlib would end the test without a word.
    XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
    XSelectInput(display_.get(), DefaultRootWindow(display_.get()), SubstructureNotifyMask);
    const auto pixels = [&](int length) {
        return static_cast<int>(std::lround(start.scale * static_cast<float>(length)));
    };
    const int height = start.height + pixels(status_height);
    std::vector<std::string> flags = {CANDELA_APP,
                                      "--context",
                                      "window",
                                      "--size",
                                      std::to_string(start.width) + "x" + std::to_string(height),
                                      "--ui-log",
                                      (folder_ / "log.jsonl").string()};
    flags.insert(flags.end(), start.flags.begin(), start.flags.end());
    std::vector<char*> arguments;
    arguments.reserve(flags.size() + 1);
    for (std::string& flag : flags) arguments.push_back(flag.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, (folder_ / "stderr").c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
    if (!start.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, start.folder.c_str());
    // What the app remembers of recent files is none of the user's.
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const int error = posix_spawn(&process_, CANDELA_APP, &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    REQUIRE(error == 0);
    REQUIRE_MESSAGE(wait_until([&] { return find_window(DefaultRootWindow(display_.get())); }), "no window");
    wait_for("a picture", [](const Json& record) { return record["picture"] > 0; });
    move_pointer(10, height - 10);
    if (start.panel) return;
    press_key(XK_F1);
    wait_for("no panel", [&](const Json& record) { return record["scene"][2] == start.width; });
}

App::~App() {
    if (process_ == 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
}

std::vector<Json> App::history() const {
    std::vector<Json> records;
    std::ifstream file(folder_ / "log.jsonl");
    std::string line;
    while (std::getline(file, line)) {
        // The last line may not be complete yet.
        Json record = Json::parse(line, nullptr, false);
        if (!record.is_discarded()) records.push_back(std::move(record));
    }
    return records;
}

Json App::log() const {
    const std::string lines = text_of(folder_ / "log.jsonl");
    // The last line may not be complete yet.
    const std::size_t end = lines.rfind('\n');
    if (end == std::string::npos) return {};
    const std::size_t before = end == 0 ? std::string::npos : lines.rfind('\n', end - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return Json::parse(lines.substr(begin, end - begin));
}

Json App::wait_for(std::string_view what, const std::function<bool(const Json&)>& condition) {
    Json record;
    const bool met = wait_until([&] {
        record = log();
        return !record.is_null() && condition(record);
    });
    REQUIRE_MESSAGE(met, "waited in vain for ", what, "; last: ", record.dump(), "; stderr: ", errors());
    return record;
}

std::string App::errors() const {
    return text_of(folder_ / "stderr");
}

Area App::scene() const {
    const Json at = log()["scene"];
    return {at[0], at[1], at[2], at[3]};
}

Area App::control(const std::string& label) {
    const Json record = wait_for("the control '" + label + "'",
                                 [&](const Json& newest) { return newest["controls"].contains(label); });
    const Json& at = record["controls"][label];
    return {at[0], at[1], at[2], at[3]};
}

Shot App::shoot(const Area& area) const {
    const Image image = get_image(display_.get(), window_, area);
    Shot shot{area.width, area.height, {}};
    for (int y = 0; y < area.height; ++y) {
        for (int x = 0; x < area.width; ++x) {
            const auto rgb = channels(XGetPixel(image.get(), x, y));
            shot.pixels.push_back(rgb[0] + rgb[1] + rgb[2]);
        }
    }
    return shot;
}

Shot App::settled() {
    // While only the pointer moves, the app draws no more often than 20 times per second.
    std::this_thread::sleep_until(last_move_ + 60ms);
    Shot last;
    const bool rested = wait_until([&] {
        // The second answer comes after the frame that the input before the first one has asked for.
        await_answer();
        await_answer();
        // In this order: what the log calls settled is on the screen already.
        const bool rests = log()["settled"];
        Shot now = shoot();
        const bool same = rests && now == last;
        last = std::move(now);
        return same;
    });
    REQUIRE_MESSAGE(rested, "the picture never comes to rest");
    return last;
}

void App::keep(const std::string& name) const {
    const char* folder = std::getenv("CANDELA_WINDOW_SHOTS");  // NOLINT(concurrency-mt-unsafe)
    if (folder == nullptr) return;
    XWindowAttributes attributes{};
    XGetWindowAttributes(display_.get(), window_, &attributes);
    const Image image = get_image(display_.get(), window_, {0, 0, attributes.width, attributes.height});
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < attributes.height; ++y) {
        for (int x = 0; x < attributes.width; ++x) {
            const auto pixel = channels(XGetPixel(image.get(), x, y));
            rgb.insert(rgb.end(), pixel.begin(), pixel.end());
        }
    }
    tools::write_png(fs::path(folder) / (name + ".png"), {attributes.width, attributes.height}, rgb);
}

void App::press_button(double x, double y, unsigned pressed) {
    move(x, y);
    button(pressed, true);
}

void App::release_button(unsigned released) {
    button(released, false);
}

void App::move(double x, double y) {
    const Area at = scene();
    move_pointer(at.x + static_cast<int>(std::lround(x)), at.y + static_cast<int>(std::lround(y)));
}

void App::drag(double from_x, double from_y, double to_x, double to_y, unsigned pressed) {
    press_button(from_x, from_y, pressed);
    constexpr int steps = 8;
    for (int step = 1; step <= steps; ++step) {
        const double part = static_cast<double>(step) / steps;
        move(from_x + part * (to_x - from_x), from_y + part * (to_y - from_y));
    }
    release_button(pressed);
}

void App::click(const std::string& label) {
    const Area at = control(label);
    // Sliders and fields stand at the left of their labels.
    move_pointer(at.x + std::min(at.width / 2, 30), at.y + at.height / 2);
    button(Button1, true);
    button(Button1, false);
}

void App::open_tab(const std::string& tab, const std::string& expected) {
    click(tab);
    static_cast<void>(control(expected));
}

void App::press_key(KeySym pressed, std::vector<KeySym> modifiers) {
    for (const KeySym modifier : modifiers) key(modifier, true);
    key(pressed, true);
    await_answer();
    key(pressed, false);
    for (const KeySym modifier : modifiers) key(modifier, false);
    await_answer();
}

void App::hold_key(KeySym held, std::string_view what, const std::function<bool(const Json&)>& condition) {
    key(held, true);
    wait_for(what, condition);
    key(held, false);
    await_answer();
}

void App::type(std::string_view text) {
    for (const char letter : text) {
        const KeySym symbol = letter == '\n' ? XK_Return : static_cast<KeySym>(letter);
        key(symbol, true);
        key(symbol, false);
    }
}

void App::type_with_control(KeySym symbol) {
    for (const bool down : {true, false}) {
        key(XK_Control_L, down);
        key(symbol, down);
    }
}

void App::resize(int width, int height) {
    XResizeWindow(display_.get(), window_, static_cast<unsigned>(width), static_cast<unsigned>(height));
    await_answer();
}

int App::quit() {
    type_with_control(XK_q);
    return wait_for_end();
}

int App::wait_for_end() {
    int status = -1;
    const bool ended = wait_until([&] { return waitpid(process_, &status, WNOHANG) == process_; });
    REQUIRE_MESSAGE(ended, "the app does not end");
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool App::find_window(Window parent) {
    Window root = 0;
    Window ignored = 0;
    Window* children = nullptr;
    unsigned count = 0;
    if (XQueryTree(display_.get(), parent, &root, &ignored, &children, &count) == 0) return false;
    const std::unique_ptr<Window, decltype(&XFree)> owner(children, &XFree);
    return std::any_of(children, children + count, [&](Window child) { return is_app(child); });
}

bool App::is_app(Window candidate) {
    XWindowAttributes attributes{};
    char* name = nullptr;
    if (XFetchName(display_.get(), candidate, &name) == 0) return false;
    const std::unique_ptr<char, decltype(&XFree)> owner(name, &XFree);
    XGetWindowAttributes(display_.get(), candidate, &attributes);
    const bool found = std::string_view(name).starts_with("Candela") && attributes.map_state == IsViewable;
    if (found) window_ = candidate;
    return found;
}

void App::move_pointer(int x, int y) {
    int left = 0;
    int top = 0;
    Window child = 0;
    XTranslateCoordinates(display_.get(), window_, DefaultRootWindow(display_.get()), 0, 0, &left, &top,
                          &child);
    XTestFakeMotionEvent(display_.get(), -1, left + x, top + y, CurrentTime);
    await_answer();
    last_move_ = Clock::now();
}

void App::button(unsigned number, bool down) {
    XTestFakeButtonEvent(display_.get(), number, down ? True : False, CurrentTime);
    await_answer();
}

void App::key(KeySym symbol, bool down) {
    XTestFakeKeyEvent(display_.get(), XKeysymToKeycode(display_.get(), symbol), down ? True : False,
                      CurrentTime);
    XSync(display_.get(), False);
}

/// Waits until the app has taken all input so far from its queue. Window managers ask programs in this way
/// whether they are alive: _NET_WM_PING in the Extended Window Manager Hints.
void App::await_answer() {
    XSync(display_.get(), False);
    const Window root = DefaultRootWindow(display_.get());
    XEvent question{};
    question.xclient.type = ClientMessage;
    question.xclient.window = window_;
    question.xclient.message_type = XInternAtom(display_.get(), "WM_PROTOCOLS", False);
    question.xclient.format = 32;
    question.xclient.data.l[0] = static_cast<long>(XInternAtom(display_.get(), "_NET_WM_PING", False));
    question.xclient.data.l[1] = ++questions_;
    question.xclient.data.l[2] = static_cast<long>(window_);
    XSendEvent(display_.get(), window_, False, NoEventMask, &question);
    XFlush(display_.get());
    const bool answered = wait_until([&] {
        XEvent answer{};
        while (XCheckTypedWindowEvent(display_.get(), root, ClientMessage, &answer) == True) {
            if (answer.xclient.data.l[1] == questions_) return true;
        }
        return false;
    });
    REQUIRE_MESSAGE(answered, "the window does not answer; stderr: ", errors());
}

}  // namespace candela::sandbox
