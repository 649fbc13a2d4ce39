#include "sandbox/editing/key_bindings.hpp"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "sandbox/files/shipped_file.hpp"

namespace candela::sandbox {

TEST_SUITE("key bindings") {

TEST_CASE("no key does two things") {
    std::set<std::pair<int, int>> seen;
    for (const KeyBinding& binding : key_bindings()) {
        CHECK_MESSAGE(seen.insert({binding.key, binding.modifiers}).second, binding.keys);
    }
    for (const KeyBinding& binding : key_bindings()) {
        if (binding.action != Action::fly) continue;
        CHECK_FALSE(seen.contains({binding.key, GLFW_MOD_SHIFT}));  // which makes flying faster
    }
}

TEST_CASE("every action has a key and a help text") {
    std::set<Action> seen{Action::along_y, Action::along_z};  // in the row of along_x
    for (const KeyBinding& binding : key_bindings()) {
        const bool first = seen.insert(binding.action).second;
        if (first) CHECK_FALSE(binding.help.empty());
        CHECK(binding.help.empty() == binding.keys.empty());
    }
    for (int action = 0; action <= static_cast<int>(Action::quit); ++action) {
        CHECK_MESSAGE(seen.contains(static_cast<Action>(action)), action);
    }
}

TEST_CASE("the README lists all keys, and what the mouse does") {
    std::string rows = "| keys | |\n|---|---|\n";
    for (const KeyBinding& binding : key_bindings()) {
        if (!binding.help.empty()) rows += fmt::format("| {} | {} |\n", binding.keys, binding.help);
    }
    rows += "\n| mouse | |\n|---|---|\n";
    for (const MouseHelp& mouse : mouse_help())
        rows += fmt::format("| {} | {} |\n", mouse.buttons, mouse.help);
    std::stringstream text;
    text << std::ifstream(shipped_file("", "README.md")).rdbuf();
    INFO("this must stand there:\n" << rows);
    CHECK(text.str().find("\n\n" + rows + "\n") != std::string::npos);
}

TEST_CASE("modifiers must match, locks do not matter") {
    CHECK(find_binding(GLFW_KEY_Z, GLFW_MOD_CONTROL)->action == Action::undo);
    CHECK(find_binding(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT)->action == Action::redo);
    CHECK(find_binding(GLFW_KEY_Z, GLFW_MOD_NUM_LOCK)->action == Action::along_z);
    CHECK(find_binding(GLFW_KEY_W, GLFW_MOD_SHIFT)->action == Action::fly);
    CHECK(find_binding(GLFW_KEY_W, GLFW_MOD_CONTROL) == nullptr);
    CHECK(find_binding(GLFW_KEY_Q, GLFW_MOD_CONTROL)->action == Action::quit);
}

TEST_CASE("keys that work while something is typed write nothing and edit no text") {
    CHECK(works_while_typing(Action::quit));
    // What fields do with Ctrl: all, copy, paste, cut, redo, undo.
    constexpr std::string_view of_fields = "ACVXYZ";
    for (const KeyBinding& binding : key_bindings()) {
        if (!works_while_typing(binding.action)) continue;
        CAPTURE(binding.keys);
        const bool is_function_key = binding.key >= GLFW_KEY_F1 && binding.key <= GLFW_KEY_F12;
        CHECK((is_function_key || (binding.modifiers & GLFW_MOD_CONTROL) != 0));
        CHECK(of_fields.find(static_cast<char>(binding.key)) == std::string_view::npos);
    }
}
}  // TEST_SUITE("key bindings")

}  // namespace candela::sandbox
