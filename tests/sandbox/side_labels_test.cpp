#include "sandbox/panels/side_labels.hpp"

#include <doctest/doctest.h>

#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

TEST_SUITE("side labels") {

namespace {

Configuration named(std::string_view name) {
    return choose_named({}, *find_named(name));
}

}  // namespace

TEST_CASE("two named configurations are told apart by their names") {
    const SideLabels labels = side_labels(named("draft"), named("best"));
    CHECK(labels.a == "A: draft");
    CHECK(labels.b == "B: best");
}

TEST_CASE("a configuration that has no name is told apart by the settings that differ") {
    Configuration changed = named("draft");
    changed.vpls.count = 77;
    changed.shadows.enabled = false;
    const SideLabels labels = side_labels(named("draft"), changed);
    const std::string count = std::to_string(named("draft").vpls.count);
    CHECK(labels.a == "A: draft\nvpls.count " + count + "\nshadows.enabled on");
    CHECK(labels.b == "B: custom\nvpls.count 77\nshadows.enabled off");
}

TEST_CASE("two configurations of the same name may differ in what the name does not say") {
    Configuration darker = named("draft");
    darker.tone_map.exposure_ev = -1.0F;
    REQUIRE(name_of(darker) == "draft");
    const SideLabels labels = side_labels(named("draft"), darker);
    CHECK(labels.a == "A: draft\ntone_map.exposure_ev 0");
    CHECK(labels.b == "B: draft\ntone_map.exposure_ev -1");
}

TEST_CASE("equal configurations are said to be equal, and the reference is named") {
    AppState state;
    state.configuration = state.comparison.other = named("best");
    const ReferenceView none;
    CHECK(side_labels(state, none).b == "B: best, the same as A");
    state.comparison.with_reference = true;
    CHECK(side_labels(state, none).a == "A: best");
    CHECK(side_labels(state, none).b.starts_with("B: the reference"));
}
}  // TEST_SUITE("side labels")

}  // namespace candela::sandbox
