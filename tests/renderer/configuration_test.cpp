#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <candela/graph/describe.hpp>
#include <candela/settings.hpp>
#include "sandbox/files/shipped_file.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("configuration") {

using namespace candela;

namespace {

using GraphErrors = std::vector<std::string>;

GraphErrors errors_of(std::string_view json) {
    const ConfigurationResult result = read_configuration(json);
    CHECK(result.configuration.has_value() == result.errors.empty());
    return result.errors;
}

/// A configuration in which every setting differs from the default.
Configuration unusual() {
    Configuration c;
    c.path = ShadingPath::forward;
    c.show = Show::indirect;
    c.indirect = false;
    c.vpls = {.count = 7, .bounces = 5, .seed = 4'000'000'000U, .updates = 9};
    c.interleave = Interleave::four;
    c.frame_budget_ms = std::nullopt;
    c.geometry_bound = std::numeric_limits<float>::infinity();
    c.shadows = {.enabled = false, .cube_resolution = 16, .map_resolution = 8192, .budget_mib = 0};
    c.tone_map = {
        .enabled = false, .exposure_ev = -1.7F, .curve = ToneCurve::aces, .automatic_exposure = true};
    return c;
}

/// The values that a setting can have, in words.
template <class T>
std::string values_of(const Setting& setting, const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return "true, false";
    } else if constexpr (std::is_enum_v<T>) {
        std::string names;
        for (const Choice& choice : choices_of(value)) {
            names += (names.empty() ? "" : ", ") + std::string(choice.name);
        }
        return names;
    } else {
        const auto& [least, most, step] = setting.range;
        const std::string limit = std::isinf(most) ? "infinity" : fmt::format("{}", most);
        return fmt::format("{}{} to {}{}", std::is_same_v<T, std::optional<float>> ? "auto, or " : "", least,
                           limit, step > 1 ? fmt::format(", multiples of {}", step) : "");
    }
}

/// The row of a setting in sandbox/README.md.
template <class T>
std::string row_of(const Setting& setting, const T& value) {
    std::string pointer = fmt::format("/{}", setting.path);
    std::ranges::replace(pointer, '.', '/');
    const auto defaults = nlohmann::json::parse(write_configuration({}));
    return fmt::format("| `{}` | {} | {} | {} | {} |\n", setting.path,
                       setting.flag.empty() ? "" : fmt::format("`{}`", setting.flag),
                       values_of(setting, value), defaults.at(nlohmann::json::json_pointer(pointer)).dump(),
                       setting.help);
}

}  // namespace

TEST_CASE("the README lists all settings, with their values, defaults and meanings") {
    std::stringstream text;
    text << std::ifstream(sandbox::shipped_file("", "README.md")).rdbuf();
    std::string rows = "| setting | flag | values | default | meaning |\n|---|---|---|---|---|\n";
    const Configuration defaults;
    for_each_setting(defaults,
                     [&](const Setting& setting, const auto& value) { rows += row_of(setting, value); });
    INFO("this must stand there:\n" << rows);
    CHECK(text.str().find("\n\n" + rows + "\n") != std::string::npos);
}

TEST_CASE("a setting that depends on others says when it has an effect") {
    const auto without_effect = [](const Configuration& configuration) {
        std::vector<std::string_view> paths;
        for_each_setting(configuration, [&](const Setting& setting, const auto& /*value*/) {
            if (!setting.has_effect) paths.push_back(setting.path);
        });
        return paths;
    };
    using Paths = std::vector<std::string_view>;
    Configuration c;
    c.path = ShadingPath::tiled_deferred;
    c.refinement.enabled = true;
    CHECK(without_effect(c) == Paths{"vpls.geometry_bound", "lists.slices"});
    c.vpls.placement = VplPlacement::paths;
    c.visibility.method = VplVisibility::rays;
    c.path = ShadingPath::clustered_forward;
    c.shadows.enabled = false;
    CHECK(without_effect(c) == Paths{"vpls.updates", "vpls.guided", "vpls.map_resolution",
                                     "shadows.cube_resolution", "shadows.map_resolution",
                                     "shadows.budget_mib"});
}

TEST_CASE("a member of an object is unknown outside of it, and objects are nested no deeper") {
    CHECK(errors_of(R"({"vpls.count": 3})") == GraphErrors{"vpls.count: is unknown"});
    CHECK(errors_of(R"({"count": 3})") == GraphErrors{"count: is unknown"});
    CHECK(errors_of(R"({"vpls": {"vpls": {}, "": 1}})") ==
          GraphErrors{"vpls.: is unknown", "vpls.vpls: is unknown"});
    CHECK(errors_of(R"({"lists": {"tile_size": 40}})") ==
          GraphErrors{"lists.tile_size: 40 is not a multiple of 16"});
}

TEST_CASE("a configuration that is written and read again is unchanged") {
    CHECK(read_configuration(write_configuration({})).configuration == Configuration{});
    CHECK(read_configuration(write_configuration(unusual())).configuration == unusual());
    for (const NamedConfiguration& named : named_configurations()) {
        CAPTURE(named.name);
        CHECK(validate(named.configuration) == GraphErrors{});
        CHECK(read_configuration(write_configuration(named.configuration)).configuration ==
              named.configuration);
    }
}

TEST_CASE("everything that can be shown has a name") {
    CHECK(all_shows.size() == 8);
    for (std::size_t i = 0; i < all_shows.size(); ++i) {
        CHECK(static_cast<std::size_t>(all_shows.at(i)) == i);
    }
    for (const Show show : all_shows) {
        const std::string json = R"({"show": ")" + std::string(to_string(show)) + "\"}";
        REQUIRE(read_configuration(json).configuration);
        CHECK(read_configuration(json).configuration->show == show);
    }
    CHECK(to_string(Show::irradiance) == "irradiance");
    CHECK(to_string(Show::albedo) == "albedo");
    CHECK(to_string(Show::normals) == "normals");
    CHECK(to_string(Show::roughness) == "roughness");
    CHECK(to_string(Show::metalness) == "metalness");
}

TEST_CASE("members that are left out keep the values of the base") {
    CHECK(read_configuration("{}").configuration == Configuration{});
    Configuration wanted = unusual();
    wanted.vpls.count = 9;
    CHECK(read_configuration(R"({"vpls": {"count": 9}})", unusual()).configuration == wanted);
}

TEST_CASE("every error names its member") {
    CHECK(errors_of("[]") == GraphErrors{"not a JSON object"});
    CHECK(errors_of("3") == GraphErrors{"not a JSON object"});
    const std::string paths =
        "path: is not one of forward, tiled-forward, forward+, deferred, tiled-deferred, "
        "clustered-forward, clustered-deferred";
    CHECK(errors_of(R"({"path": "sideways"})") == GraphErrors{paths});
    CHECK(errors_of(R"({"path": 1})") == GraphErrors{paths});
    CHECK(errors_of(R"({"indirect": "on"})") == GraphErrors{"indirect: is not true or false"});
    CHECK(errors_of(R"({"vpls": 256})") == GraphErrors{"vpls: is not an object"});
    CHECK(errors_of(R"({"bounce": 1, "vpls": {"number": 2}})").size() == 2);
    for (const char* count :
         {"-1", "1.5", "\"many\"", "null", "4294967296", "1e300", "18446744073709551616"}) {
        CAPTURE(count);
        const GraphErrors errors = errors_of(std::string(R"({"vpls": {"count": )") + count + "}}");
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].starts_with("vpls.count: "));
    }
    CHECK(errors_of(R"({"shadows": {"cube_resolution": 15}})").size() == 1);
    CHECK(errors_of(R"({"shadows": {"map_resolution": 8193}})").size() == 1);
    CHECK(errors_of(R"({"vpls": {"geometry_bound": -0.1}})").size() == 1);
    CHECK(errors_of(R"({"tone_map": {"exposure_ev": "infinity"}})").size() == 1);
    CHECK(errors_of(R"({"frame_budget_ms": -1})") ==
          GraphErrors{"frame_budget_ms: is not from 0 to 1000000"});
    CHECK(errors_of(R"({"frame_budget_ms": true})") == GraphErrors{"frame_budget_ms: is not a number"});
    CHECK(read_configuration(R"({"frame_budget_ms": 12.5})", unusual()).configuration->frame_budget_ms ==
          12.5F);
    CHECK_FALSE(read_configuration(R"({"frame_budget_ms": "auto"})").configuration->frame_budget_ms);
    CHECK(errors_of(R"({"vpls": {"interleave": 3}})") ==
          GraphErrors{"vpls.interleave: is not one of auto, 1, 2, 4, 8"});
    CHECK(read_configuration(R"({"vpls": {"interleave": 8}})").configuration->interleave ==
          Interleave::eight);
    CHECK(read_configuration(R"({"vpls": {"interleave": "auto"}})", unusual()).configuration->interleave ==
          Interleave::automatic);

    const GraphErrors several = errors_of(
        R"({"path": "sideways", "vpls": {"count": -1, "seed": true}, "shadows": {"enabled": 1}, "extra": {}})");
    REQUIRE(several.size() == 5);
    CHECK(several[0].starts_with("path: "));
    CHECK(several[1].starts_with("vpls.count: "));
    CHECK(several[2].starts_with("vpls.seed: "));
    CHECK(several[3].starts_with("shadows.enabled: "));
    CHECK(several[4] == "extra: is unknown");
}

TEST_CASE("of many unknown members, ten are named and the others counted") {
    nlohmann::json many;
    for (int i = 0; i < 200'000; ++i) {
        many[fmt::format("member {}", i)] = i;
    }
    const std::string text = many.dump();
    const auto start = std::chrono::steady_clock::now();
    const GraphErrors errors = errors_of(text);
    // Takes 0.3 s; in quadratic time it would take minutes.
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
    REQUIRE(errors.size() == 11);
    CHECK(errors.front() == "member 0: is unknown");
    CHECK(errors.back() == "and 199,990 more");
}

TEST_CASE("names in errors are cut, and their control characters visible") {
    const nlohmann::json named{{"\x1B[2J" + std::string(5'000'000, 'x'), 1}};
    const GraphErrors errors = errors_of(named.dump());
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with("\\x1B[2Jxxx"));
    CHECK(errors[0].ends_with("x...: is unknown"));
    CHECK(errors[0].size() < 250);
}

TEST_CASE("limits that are rounded to single precision are included") {
    Configuration smallest;
    smallest.geometry_bound = 1e-6F;
    CHECK(read_configuration(R"({"vpls": {"geometry_bound": 1e-6}})").configuration == smallest);
    CHECK(read_configuration(write_configuration(smallest)).configuration == smallest);
    CHECK(!errors_of(R"({"vpls": {"geometry_bound": 0.99e-6}})").empty());
}

TEST_CASE("text that is not JSON has one error, with its line and column and what was expected") {
    struct Case {
        std::string_view json;
        std::string_view place;     ///< of the last character that was read
        std::string_view expected;  ///< what should be there instead
    };
    for (const Case& invalid :
         {Case{"", "line 1, column 1", "unexpected end of input"},
          Case{"{\"path\": ", "line 1, column 10", "unexpected end of input"},
          Case{"{\n  \"show\": \"total\"\n  \"path\": \"forward\"\n}", "line 3, column 8", "expected '}'"},
          Case{"{\n  \"show\": \"total\",\n}", "line 3, column 1", "expected string literal"},
          Case{"{\"indirect\": yes}", "line 1, column 14", "invalid literal"},
          Case{"{} {}", "line 1, column 4", "expected end of input"}}) {
        CAPTURE(invalid.json);
        const GraphErrors errors = errors_of(invalid.json);
        REQUIRE(errors.size() == 1);
        CAPTURE(errors[0]);
        CHECK(errors[0].starts_with("invalid JSON: parse error at " + std::string(invalid.place) + ": "));
        CHECK(errors[0].find(invalid.expected) != std::string::npos);
        CHECK(errors[0].find('\n') == std::string::npos);
    }
    const GraphErrors too_large = errors_of(R"({"frame_budget_ms": 1e999})");
    REQUIRE(too_large.size() == 1);
    CHECK(too_large[0].starts_with("invalid JSON: number overflow"));
    CHECK(too_large[0].find("1e999") != std::string::npos);
}

TEST_CASE(
    "of members with the same name the last counts, and nesting has a limit, which texts do not reach") {
    CHECK(read_configuration(R"({"path": "forward", "path": "deferred"})").configuration->path ==
          ShadingPath::deferred);
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    CHECK(errors_of(nested(256)) == GraphErrors{"not a JSON object"});
    CHECK(errors_of(nested(257)) == GraphErrors{"its JSON is nested too deeply"});
    CHECK(errors_of("[\"\\\"" + nested(300) + "\"]") == GraphErrors{"not a JSON object"});
}

TEST_CASE("values out of range and NaN are errors") {
    Configuration c;
    c.vpls.placement = VplPlacement::paths;
    c.vpls.count = (1U << 20U) + 1;
    c.vpls.bounces = 65;
    c.geometry_bound = std::nanf("");
    c.shadows.cube_resolution = 0;
    c.tone_map.exposure_ev = std::numeric_limits<float>::infinity();
    const GraphErrors errors = validate(c);
    REQUIRE(errors.size() == 5);
    CHECK(errors[0].starts_with("vpls.count: "));
    CHECK(errors[1].starts_with("vpls.bounces: "));
    CHECK(errors[2].starts_with("vpls.geometry_bound: "));
    CHECK(errors[3].starts_with("shadows.cube_resolution: "));
    CHECK(errors[4].starts_with("tone_map.exposure_ev: "));
}

TEST_CASE("the largest number of surfels is lower than that of VPLs on paths") {
    Configuration c;
    c.vpls = {.placement = VplPlacement::surfels, .count = 65536};
    CHECK(validate(c).empty());
    c.vpls.count = 65537;
    CHECK(validate(c) ==
          std::vector<std::string>{"vpls.count: 65537 surfels are too many; 65536 are possible"});
    c.vpls.placement = VplPlacement::paths;
    CHECK(validate(c).empty());
}

TEST_CASE_FIXTURE(RenderFixture, "an invalid configuration leaves the current one in use") {
    const Scene scene = cornell_box();
    configure(linear_configuration(ShadingPath::forward));
    const Picture before = render(scene, {20, 15});
    Configuration bad = unusual();
    bad.vpls.bounces = 65;
    CHECK(renderer.configure(bad).size() == 1);
    CHECK(renderer.configuration() == linear_configuration(ShadingPath::forward));
    CHECK(render(scene, {20, 15}) == before);
    CHECK_FALSE(ran("forward"));
}

TEST_CASE_FIXTURE(RenderFixture, "the graph's description lists the passes of each path in their order") {
    const auto passes_of = [&](ShadingPath path, bool indirect) {
        Configuration configuration = linear_configuration(path);
        configuration.indirect = indirect;
        configure(configuration);
        const Scene scene = cornell_box();
        renderer.invalidate();
        static_cast<void>(render(scene, {4, 4}));
        std::string names;
        const std::string text = describe_text(renderer.description());
        std::size_t at = 0;
        for (const PassRecord& pass : renderer.last_passes()) {
            names += names.empty() ? "" : " ";
            names += pass.name;
            // Each pass has a paragraph, in the same order.
            at = text.find(" " + std::string(pass.name) + "\n", at);
            CHECK(at != std::string::npos);
        }
        return names;
    };
    const std::string scene =
        "scene-gather scene-upload instance-upload bvh lights shadow-plan shadow-maps light-upload view ";
    const std::string surfels =
        "scene-motion surfel-focus surfel-spread surfels surfel-visibility surfel-light ";
    const std::string view = "view-upload view-cull ";
    const std::string bounce = "surfel-bounce vpl-constants ";  // behind the first barrier
    const std::string deferred = "deferred transparent tone-map";
    const std::string forward = "forward transparent tone-map";
    CHECK(passes_of(ShadingPath::deferred, true) == scene + surfels + view + "gbuffer " + bounce + deferred);
    CHECK(passes_of(ShadingPath::forward, true) == scene + surfels + view + bounce + forward);
    CHECK(passes_of(ShadingPath::deferred, false) == scene + view + "gbuffer " + deferred);
}

TEST_CASE_FIXTURE(RenderFixture,
                  "there are barriers only before passes that read or overwrite what shaders have stored") {
    const auto barriers_of = [&](ShadingPath path) {
        configure(linear_configuration(path));
        std::istringstream text(describe_text(renderer.description()));
        std::string barriers, pass;
        for (std::string line; std::getline(text, line) && line != "resources";) {
            if (line.starts_with("      barrier ")) {
                barriers += pass + ":" + line.substr(13) + "\n";
            } else if (!line.starts_with("      ")) {
                pass = line.substr(line.rfind(' ') + 1);
            }
        }
        return barriers;
    };
    // The first barrier of each waits for the previous frame, whose radiance is overwritten. Shaders fetch
    // VPLs as texels; before the next frame stores others, storage is waited for where there is a barrier
    // anyway.
    CHECK(barriers_of(ShadingPath::deferred) ==
          "surfel-bounce: storage\ndeferred: texture fetch + image access\n"
          "transparent: texture fetch + framebuffer + storage\n");
    CHECK(barriers_of(ShadingPath::forward) == "surfel-bounce: storage\nforward: texture fetch + storage\n");
}

}  // TEST_SUITE("configuration")
