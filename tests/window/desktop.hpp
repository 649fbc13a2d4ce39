#pragma once

// Before X11's macros.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <X11/Xlib.h>
#include <sys/types.h>

// What the desktop does around the app. The tests' X server has no window manager and no file manager: the
// test plays their parts.

namespace candela::sandbox {

/// Drags a file over the middle of the window and drops it there, by version 5 of the XDND protocol
/// (https://freedesktop.org/wiki/Specifications/XDND). Returns when the window has taken the file; fails the
/// test if it refuses it or does not answer.
void drop_file(Display* display, Window target, const std::filesystem::path& path);

/// The scale of the display, which desktops announce by the resource Xft.dpi, while this object lives.
/// Programs read it when they start.
class DisplayScale {
 public:
    explicit DisplayScale(float scale);
    DisplayScale(const DisplayScale&) = delete;
    DisplayScale& operator=(const DisplayScale&) = delete;
    ~DisplayScale();

 private:
    void set_resources(const std::string& resources) const;

    struct CloseDisplay {
        void operator()(Display* display) const { XCloseDisplay(display); }
    };
    // Its own connection: the server forgets the property when its last client leaves.
    std::unique_ptr<Display, CloseDisplay> display_;
    std::optional<std::string> before_;
};

/// Changes the state of a window as a window manager does (Inter-Client Communication Conventions
/// Manual, 4.1.4).
void minimise(Display* display, Window window);
void restore(Display* display, Window window);

/// The processor time that all threads of a process have used since its start.
[[nodiscard]] std::chrono::nanoseconds cpu_time(pid_t process);

}  // namespace candela::sandbox
