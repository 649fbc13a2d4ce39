#include "tests/window/desktop.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <string_view>
#include <thread>

#include <X11/Xatom.h>
#include <X11/Xutil.h>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

Atom atom(Display* display, const char* name) {
    return XInternAtom(display, name, False);
}

/// RFC 3986: all but the unreserved characters, and the slashes between folders, as two hexadecimal digits.
std::string uri_of(const fs::path& path) {
    constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
    std::string uri = "file://";
    for (const char letter : fs::absolute(path).string()) {
        uri += plain.find(letter) != std::string_view::npos
                   ? std::string(1, letter)
                   : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    return uri;
}

/// The side of a drag from which the file comes, with a window of its own.
class DragSource {
 public:
    DragSource(Display* display, Window target, std::string uri)
        : display_(display),
          target_(target),
          uri_(std::move(uri)),
          window_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {}
    DragSource(const DragSource&) = delete;
    DragSource& operator=(const DragSource&) = delete;
    ~DragSource() { XDestroyWindow(display_, window_); }

    void drop() {
        require_version();
        XSetSelectionOwner(display_, atom(display_, "XdndSelection"), window_, CurrentTime);
        send("XdndEnter", {version << 24, static_cast<long>(list_), None, None});
        send("XdndPosition",
             {0, position(), CurrentTime, static_cast<long>(atom(display_, "XdndActionCopy"))});
        const XClientMessageEvent status = wait_for("XdndStatus");
        REQUIRE_MESSAGE((status.data.l[1] & 1) == 1, "the window refuses ", uri_);
        send("XdndDrop", {0, CurrentTime});
        const XClientMessageEvent finished = wait_for("XdndFinished");
        // Bit 0 says whether the file was taken; GLFW 3.3 sends the length of the list of files instead.
        CHECK_MESSAGE(finished.data.l[1] != 0, "the window has not taken ", uri_);
    }

 private:
    static constexpr long version = 5;

    void require_version() const {
        Atom type = None;
        int format = 0;
        unsigned long count = 0;
        unsigned long rest = 0;
        unsigned char* data = nullptr;
        XGetWindowProperty(display_, target_, atom(display_, "XdndAware"), 0, 1, False, XA_ATOM, &type,
                           &format, &count, &rest, &data);
        const std::unique_ptr<unsigned char, decltype(&XFree)> owner(data, &XFree);
        REQUIRE_MESSAGE(count == 1, "the window takes no files: it has no property XdndAware");
        // Properties of 32 bits arrive as longs.
        CHECK(*reinterpret_cast<const Atom*>(data) >= version);
    }

    /// The middle of the window, in the coordinates of the root window.
    [[nodiscard]] long position() const {
        XWindowAttributes attributes{};
        XGetWindowAttributes(display_, target_, &attributes);
        int x = 0;
        int y = 0;
        Window child = 0;
        XTranslateCoordinates(display_, target_, attributes.root, attributes.width / 2, attributes.height / 2,
                              &x, &y, &child);
        return (static_cast<long>(x) << 16) | y;
    }

    /// The first of a message's five numbers is always the source.
    void send(const char* message, std::array<long, 4> numbers) const {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(display_, message);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(window_);
        for (std::size_t i = 0; i < numbers.size(); ++i) event.xclient.data.l[i + 1] = numbers.at(i);
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    /// Answers what the target asks for in the meantime.
    [[nodiscard]] XClientMessageEvent wait_for(const char* message) {
        // The app answers between two of its frames, each of which takes a fraction of a second; the rest is
        // for machines that do other work at the same time.
        const auto deadline = std::chrono::steady_clock::now() + 20s;
        const Atom wanted = atom(display_, message);
        while (std::chrono::steady_clock::now() < deadline) {
            XEvent event{};
            if (XCheckTypedWindowEvent(display_, window_, SelectionRequest, &event) == True) {
                answer(event.xselectionrequest);
            }
            if (XCheckTypedWindowEvent(display_, window_, ClientMessage, &event) == True &&
                event.xclient.message_type == wanted) {
                return event.xclient;
            }
            std::this_thread::sleep_for(5ms);
        }
        FAIL("the window sends no ", message, " for ", uri_);
        return {};
    }

    void answer(const XSelectionRequestEvent& request) const {
        const std::string lines = uri_ + "\r\n";
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(lines.data()), static_cast<int>(lines.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.target == list_ ? request.property : None;
        event.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_;
    Window target_;
    std::string uri_;
    Window window_;
    Atom list_ = atom(display_, "text/uri-list");
};

void set_state(Display* display, Window window, long state) {
    const Atom wm_state = atom(display, "WM_STATE");
    const std::array<long, 2> state_and_icon = {state, None};
    XChangeProperty(display, window, wm_state, wm_state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(state_and_icon.data()),
                    static_cast<int>(state_and_icon.size()));
    XSync(display, False);
}

std::optional<std::string> resources_of(Display* display) {
    Atom type = None;
    int format = 0;
    unsigned long count = 0;
    unsigned long rest = 0;
    unsigned char* data = nullptr;
    constexpr long most = 1 << 20;
    XGetWindowProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, 0, most, False, XA_STRING,
                       &type, &format, &count, &rest, &data);
    const std::unique_ptr<unsigned char, decltype(&XFree)> owner(data, &XFree);
    if (type == None) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(data), count);
}

}  // namespace

void drop_file(Display* display, Window target, const fs::path& path) {
    DragSource(display, target, uri_of(path)).drop();
}

DisplayScale::DisplayScale(float scale) : display_(XOpenDisplay(nullptr)) {
    REQUIRE_MESSAGE(display_, "no display: run under xvfb-run");
    before_ = resources_of(display_.get());
    // The last of several lines for a resource counts.
    set_resources(fmt::format("{}\nXft.dpi:\t{}\n", before_.value_or(""), std::lround(96.0F * scale)));
}

DisplayScale::~DisplayScale() {
    if (before_) {
        set_resources(*before_);
    } else {
        XDeleteProperty(display_.get(), DefaultRootWindow(display_.get()), XA_RESOURCE_MANAGER);
    }
    XSync(display_.get(), False);
}

void DisplayScale::set_resources(const std::string& resources) const {
    XChangeProperty(display_.get(), DefaultRootWindow(display_.get()), XA_RESOURCE_MANAGER, XA_STRING, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(resources.data()),
                    static_cast<int>(resources.size()));
    XSync(display_.get(), False);
}

void minimise(Display* display, Window window) {
    XUnmapWindow(display, window);
    set_state(display, window, IconicState);
}

void restore(Display* display, Window window) {
    XMapWindow(display, window);
    set_state(display, window, NormalState);
}

std::chrono::nanoseconds cpu_time(pid_t process) {
    clockid_t clock{};
    REQUIRE(clock_getcpuclockid(process, &clock) == 0);
    timespec time{};
    REQUIRE(clock_gettime(clock, &time) == 0);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace candela::sandbox
