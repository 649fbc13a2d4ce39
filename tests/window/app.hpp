#pragma once

// Before X11's macros.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <X11/Xlib.h>
#include <X11/keysym.h>
#include <sys/types.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

/// A rectangle of the window, in pixels from its upper left corner.
struct Area {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

/// A part of the window's contents: the brightness of each pixel, which is the sum of its channels of 0 to
/// 255.
struct Shot {
    int width = 0;
    int height = 0;
    std::vector<int> pixels;  ///< row by row, the top row first
    [[nodiscard]] int at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    bool operator==(const Shot&) const = default;
};

/// The mean brightness.
[[nodiscard]] double mean(const Shot& shot);
/// The number of pixels whose brightness differs by more than `tolerance`.
[[nodiscard]] int changed_pixels(const Shot& a, const Shot& b, int tolerance);

/// Waits until the condition holds. False after a time that is long enough for a software driver that shares
/// two cores with a build.
[[nodiscard]] bool wait_until(const std::function<bool()>& condition);

[[nodiscard]] std::string text_of(const std::filesystem::path& path);

/// How the app is started.
struct Start {
    std::vector<std::string> flags{};
    int width = 480;       ///< of the picture while the panel is hidden
    int height = 360;      ///< the same; the status line comes in addition
    bool panel = false;    ///< the panel stays
    float scale = 1.0F;    ///< of the display
    std::string folder{};  ///< working directory; default: that of the test
};

/// The app in a window, used as a person would: by pointer and keyboard, by means of the X server's XTEST
/// extension. Knows from the app's --ui-log what the window shows and where its controls are.
class App {
 public:
    explicit App(Start start = {});
    App(const App&) = delete;
    App& operator=(const App&) = delete;
    ~App();

    /// The newest record of --ui-log.
    [[nodiscard]] nlohmann::json log() const;
    /// Waits for a record that meets the condition, and returns it; fails the test, with `what`, without one.
    nlohmann::json wait_for(std::string_view what,
                            const std::function<bool(const nlohmann::json&)>& condition);
    /// All records so far.
    [[nodiscard]] std::vector<nlohmann::json> history() const;
    /// What the app has written to stderr.
    [[nodiscard]] std::string errors() const;

    /// Where the picture is.
    [[nodiscard]] Area scene() const;
    /// Where a control is. Fails the test if it is not on the screen.
    [[nodiscard]] Area control(const std::string& label);
    [[nodiscard]] Shot shoot(const Area& area) const;
    [[nodiscard]] Shot shoot() const { return shoot(scene()); }
    /// Waits until the picture stops changing; returns it.
    [[nodiscard]] Shot settled();
    /// Writes the window's contents to CANDELA_WINDOW_SHOTS/name.png if that variable is set, to be looked
    /// at.
    void keep(const std::string& name) const;

    /// `x` and `y` are in pixels from the upper left corner of the picture.
    void drag(double from_x, double from_y, double to_x, double to_y, unsigned button = Button1);
    void press_button(double x, double y, unsigned button = Button1);
    void release_button(unsigned button = Button1);
    void move(double x, double y);
    /// Clicks on a control of the panel.
    void click(const std::string& label);
    /// Opens a tab of the panel, and waits for a control in it.
    void open_tab(const std::string& tab, const std::string& control);
    void press_key(KeySym key, std::vector<KeySym> modifiers = {});
    /// Holds a key until there is a record that meets the condition.
    void hold_key(KeySym key, std::string_view what,
                  const std::function<bool(const nlohmann::json&)>& condition);
    /// Types without waiting for the app, faster than it draws. Newlines are the key Return.
    void type(std::string_view text);
    /// Presses and releases a key with Control, in the same way.
    void type_with_control(KeySym key);

    void resize(int width, int height);
    /// Closes the app by keyboard; returns the exit status.
    int quit();
    /// Waits until the process has ended; returns the exit status.
    int wait_for_end();

    [[nodiscard]] Display* display() const { return display_.get(); }
    [[nodiscard]] Window window() const { return window_; }
    [[nodiscard]] pid_t process() const { return process_; }

 private:
    bool find_window(Window parent);
    bool is_app(Window candidate);
    void move_pointer(int x, int y);
    void button(unsigned button, bool down);
    void key(KeySym key, bool down);
    void await_answer();

    struct CloseDisplay {
        void operator()(Display* display) const { XCloseDisplay(display); }
    };
    TemporaryFolder folder_;
    std::unique_ptr<Display, CloseDisplay> display_;
    Window window_ = 0;
    pid_t process_ = 0;
    long questions_ = 0;
    std::chrono::steady_clock::time_point last_move_;
};

/// A file with this text, in a folder of its own.
class TextFile {
 public:
    TextFile(const std::string& name, const std::string& text) : path_((folder_ / name.c_str()).string()) {
        write(text);
    }
    void write(const std::string& text) const;
    [[nodiscard]] const std::string& path() const { return path_; }

 private:
    TemporaryFolder folder_;
    std::string path_;
};

}  // namespace candela::sandbox
