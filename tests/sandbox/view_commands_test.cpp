#include "sandbox/window/view_commands.hpp"

#include <doctest/doctest.h>

#include <candela/graph/describe.hpp>

#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

TEST_SUITE("view commands") {

namespace {

struct View {
    AppState state;
    GraphSelection selection;
    GraphDescription graph;

    bool carry_out(Action action, int number = 0) {
        return change_view({action, number}, graph, state, selection);
    }
};

}  // namespace

TEST_CASE("paths go round in both directions") {
    View view;
    const ShadingPath first = view.state.configuration.path;
    for (std::size_t i = 0; i < all_shading_paths.size(); ++i) {
        CHECK((i == 0) == (view.state.configuration.path == first));
        CHECK(view.carry_out(Action::next_path));
    }
    CHECK(view.state.configuration.path == first);
    CHECK(view.carry_out(Action::previous_path));
    CHECK(view.carry_out(Action::next_path));
    CHECK(view.state.configuration.path == first);
}

TEST_CASE("resources that can be shown go round, with the picture between the last and the first") {
    View view;
    view.graph.resources = {{.name = "target", .kind = ResourceKind::texture, .lifetime = Lifetime::imported},
                            {.name = "depth", .kind = ResourceKind::texture},
                            {.name = "plan", .kind = ResourceKind::value},
                            {.name = "inspected picture", .kind = ResourceKind::texture},
                            {.name = "lights", .kind = ResourceKind::buffer},
                            {.name = "exposure", .kind = ResourceKind::buffer}};
    // These run after the view of resources: what they write cannot be shown, what they read can.
    view.graph.passes = {
        {.name = "exposure 2", .accesses = {{.resource = 4}, {.resource = 5, .write = true}}},
        {.name = "tone-map 2", .accesses = {{.resource = 1}}}};
    for (const char* const name : {"depth", "lights"}) {
        CHECK(view.carry_out(Action::next_resource));
        CHECK(view.selection.resource == name);
    }
    CHECK(view.carry_out(Action::next_resource));
    CHECK_FALSE(view.selection.resource.has_value());
    CHECK(view.carry_out(Action::previous_resource));
    CHECK(view.selection.resource == "lights");
    view.graph.resources.clear();
    CHECK(view.carry_out(Action::next_resource));
    CHECK_FALSE(view.selection.resource.has_value());
}

TEST_CASE("a comparison begins with the present configuration, and is a divider, then a difference") {
    View view;
    view.state.configuration.vpls.count = 77;
    for (const CompareMode mode : {CompareMode::divider, CompareMode::difference, CompareMode::off}) {
        CHECK(view.carry_out(Action::compare));
        CHECK(view.state.comparison.mode == mode);
    }
    CHECK(view.state.comparison.other.vpls.count == 77);
}

TEST_CASE("the presets 1 to 4 are those by purpose") {
    View view;
    int number = 0;
    for (const char* const name : {"draft", "balanced", "best", "report"}) {
        CHECK(view.carry_out(Action::preset, ++number));
        CHECK(name_of(view.state.configuration) == name);
    }
}

TEST_CASE("presets are numbered, a number without a preset and other commands change nothing") {
    View view;
    CHECK(view.carry_out(Action::preset, 2));
    const Configuration second = view.state.configuration;
    CHECK(view.carry_out(Action::preset, 1));
    CHECK(view.state.configuration != second);
    CHECK(view.carry_out(Action::preset, 2));
    CHECK(view.carry_out(Action::preset, 99));
    CHECK(view.state.configuration == second);
    CHECK_FALSE(view.carry_out(Action::screenshot));
    CHECK(view.state.configuration == second);
}

TEST_CASE("the panel and the help are shown and hidden") {
    View view;
    CHECK(view.carry_out(Action::panel));
    CHECK_FALSE(view.state.panel);
    CHECK(view.carry_out(Action::help));
    CHECK(view.state.help);
}
}  // TEST_SUITE("view commands")

}  // namespace candela::sandbox
