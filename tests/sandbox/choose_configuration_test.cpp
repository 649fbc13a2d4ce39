#include "sandbox/command_line/choose_configuration.hpp"

#include <fstream>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("choosing a configuration") {

TEST_CASE("without options it is the default, exposed, with refinement and a frame budget in a window") {
    Configuration refined;
    refined.tone_map.automatic_exposure = true;
    CHECK(choose_configuration({}, false) == refined);
    refined.refinement.enabled = true;
    refined.frame_budget_ms = std::nullopt;
    CHECK(choose_configuration({}, true) == refined);
}

TEST_CASE("a file overrides the default for refinement, if it sets it") {
    const TemporaryFolder folder;
    Options options;
    options.config = folder / "a.json";
    for (const bool in_window : {false, true}) {
        std::ofstream(*options.config) << R"({"vpls": {"count": 3}})";
        CHECK(choose_configuration(options, in_window).refinement.enabled == in_window);
        CHECK(choose_configuration(options, in_window).vpls.count == 3);
        for (const bool wanted : {false, true}) {
            std::ofstream(*options.config)
                << R"({"refinement": {"enabled": )" << (wanted ? "true" : "false") << "}}";
            CHECK(choose_configuration(options, in_window).refinement.enabled == wanted);
        }
    }
}

TEST_CASE("flags override the file") {
    const TemporaryFolder folder;
    Options options;
    options.config = folder / "a.json";
    std::ofstream(*options.config) << R"({"path": "deferred",
            "vpls": {"count": 3, "seed": 4, "visibility": "rays", "placement": "surfels"}})";
    options.settings["--vpl-visibility"] = "none";
    options.settings["--seed"] = "9";
    const Configuration configuration = choose_configuration(options, false);
    CHECK(configuration.visibility.method == VplVisibility::none);
    CHECK(configuration.vpls.seed == 9);
    CHECK(configuration.vpls.count == 3);
    CHECK(configuration.vpls.placement == VplPlacement::surfels);
    CHECK(configuration.path == ShadingPath::deferred);
}

TEST_CASE("the exposure is automatic unless the file or a flag turns that off, and stops are on top of it") {
    const TemporaryFolder folder;
    const auto tone_map = [](const Options& options) {
        return choose_configuration(options, false).tone_map;
    };
    const ToneMapSettings automatic{.automatic_exposure = true};
    CHECK(tone_map({}) == automatic);
    CHECK(choose_configuration({}, true).tone_map == automatic);
    Options named;
    named.config = "best";
    CHECK(tone_map(named) == automatic);
    Options file;
    file.config = folder / "a.json";
    std::ofstream(*file.config) << R"({"tone_map": {"exposure_ev": 1}})";
    CHECK(tone_map(file) == ToneMapSettings{.exposure_ev = 1.0F, .automatic_exposure = true});
    file.settings["--exposure"] = "-2";
    CHECK(tone_map(file) == ToneMapSettings{.exposure_ev = -2.0F, .automatic_exposure = true});
    std::ofstream(*file.config) << R"({"tone_map": {"automatic_exposure": false}})";
    CHECK(tone_map(file) == ToneMapSettings{.exposure_ev = -2.0F});
    file.settings["--automatic-exposure"] = "on";
    CHECK(tone_map(file) == ToneMapSettings{.exposure_ev = -2.0F, .automatic_exposure = true});
}

TEST_CASE("the written configuration has the requested VPL visibility") {
    for (const auto method : {VplVisibility::none, VplVisibility::maps, VplVisibility::rays}) {
        Options options;
        options.settings["--vpl-visibility"] = to_string(method);
        const std::string text = write_configuration(choose_configuration(options, false));
        CHECK(text.find("\"visibility\": \"" + std::string(to_string(method)) + "\"") != std::string::npos);
    }
}

TEST_CASE("errors of the file's syntax name the file, the line and the column") {
    const TemporaryFolder folder;
    Options options;
    options.config = folder / "a.json";
    std::ofstream(*options.config) << "{\n  \"vpls\": {\n    count: 3\n  }\n}\n";
    const std::string place = options.config->string() + ": invalid JSON: parse error at line 3, column 5: ";
    try {
        static_cast<void>(choose_configuration(options, true));
        FAIL("no error");
    } catch (const std::runtime_error& error) {
        CHECK(std::string(error.what()).starts_with(place));
    }
}

TEST_CASE("errors name the file") {
    const TemporaryFolder folder;
    Options options;
    options.config = folder / "a.json";
    std::ofstream(*options.config) << R"({"vpls": {"visibility": "yes"}})";
    CHECK_THROWS_WITH_AS(
        static_cast<void>(choose_configuration(options, true)),
        (options.config->string() + ": vpls.visibility: is not one of none, maps, rays").c_str(),
        std::runtime_error);
}
}  // TEST_SUITE("choosing a configuration")

}  // namespace candela::sandbox
