#include "sandbox/window/input_pace.hpp"

#include <doctest/doctest.h>

#include <GLFW/glfw3.h>

#include <vector>

namespace candela::sandbox {

TEST_SUITE("input pace") {

namespace {

using Kind = InputEvent::Kind;

InputEvent event(Kind kind, int code = 0, int modifiers = 0) {
    InputEvent made;
    made.kind = kind;
    made.code = code;
    made.modifiers = modifiers;
    return made;
}

/// Tells events in order, with the frames that they need; returns how many these are.
int frames_of(InputPace& pace, const std::vector<InputEvent>& events) {
    int frames = 0;
    for (const InputEvent& told : events) {
        for (; pace.needs_frame_before(told); ++frames) {
            REQUIRE(frames < 100);
            pace.draw();
        }
        pace.tell(told);
    }
    return frames;
}

int frames_of(const std::vector<InputEvent>& events) {
    InputPace pace;
    return frames_of(pace, events);
}

}  // namespace

TEST_CASE("a key that is pressed and released at once is seen in a frame") {
    CHECK(frames_of({event(Kind::key, GLFW_KEY_ENTER), event(Kind::key_release, GLFW_KEY_ENTER)}) == 1);
    // Twice: down, up, down.
    CHECK(frames_of({event(Kind::key, GLFW_KEY_BACKSPACE), event(Kind::key_release, GLFW_KEY_BACKSPACE),
                     event(Kind::key, GLFW_KEY_BACKSPACE), event(Kind::key_release, GLFW_KEY_BACKSPACE)}) ==
          3);
}

TEST_CASE("letters need no frames of their own, but keep their place among other keys") {
    const std::vector<InputEvent> word{
        event(Kind::key, GLFW_KEY_A), event(Kind::character, 'a'), event(Kind::key_release, GLFW_KEY_A),
        event(Kind::key, GLFW_KEY_A), event(Kind::character, 'a'), event(Kind::key_release, GLFW_KEY_A)};
    CHECK(frames_of(word) == 0);
    InputPace pace;
    CHECK(frames_of(pace, word) == 0);
    CHECK(frames_of(pace, {event(Kind::key, GLFW_KEY_ENTER)}) == 0);  // letters are read before it
    CHECK(frames_of(pace, {event(Kind::character, 'a')}) == 1);
    CHECK(frames_of({event(Kind::key, GLFW_KEY_LEFT), event(Kind::key, GLFW_KEY_DELETE)}) == 1);
}

TEST_CASE("a modifier is held until the key with it is seen") {
    const std::vector<InputEvent> copy{event(Kind::key, GLFW_KEY_LEFT_CONTROL),
                                       event(Kind::key, GLFW_KEY_C, GLFW_MOD_CONTROL)};
    InputPace pace;
    CHECK(frames_of(pace, copy) == 0);
    CHECK(frames_of(pace, {event(Kind::key_release, GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL)}) == 1);
    // Shift with a letter has given another letter.
    CHECK(frames_of({event(Kind::key, GLFW_KEY_A, GLFW_MOD_SHIFT), event(Kind::character, 'A'),
                     event(Kind::key_release, GLFW_KEY_A, GLFW_MOD_SHIFT)}) == 0);
}

TEST_CASE("a click is where it was, however fast the pointer moves on") {
    InputPace pace;
    CHECK(frames_of(pace, {event(Kind::move), event(Kind::move), event(Kind::press)}) == 0);
    CHECK(frames_of(pace, {event(Kind::release)}) == 1);
    CHECK(frames_of(pace, {event(Kind::move)}) == 1);
}

TEST_CASE("the key after what takes the keyboard waits until that has it") {
    InputPace pace;
    pace.move_focus();
    CHECK(frames_of(pace, {event(Kind::key_release, GLFW_KEY_O), event(Kind::move)}) == 0);
    // One frame for the field to ask for it, one to get it, and one to say so.
    CHECK(frames_of(pace, {event(Kind::key, GLFW_KEY_A)}) >= 3);
    CHECK(frames_of(pace, {event(Kind::key, GLFW_KEY_B)}) == 0);
    CHECK(frames_of({event(Kind::press), event(Kind::key, GLFW_KEY_A)}) >= 2);
}
}  // TEST_SUITE("input pace")

}  // namespace candela::sandbox
