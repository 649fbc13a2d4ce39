#include "sandbox/command_line/choose_configuration.hpp"

#include <fstream>
#include <stdexcept>
#include <string>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("choosing a configuration") {

TEST_CASE("without options it is the default, with refinement and a frame budget in a window") {
    CHECK(choose_configuration({}, false) == Configuration{});
    Configuration refined;
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

TEST_CASE("the exposure is open unless the file or a flag gives one, even that of the default") {
    const TemporaryFolder folder;
    const auto is_open = [](const Options& options) {
        const ChosenConfiguration chosen = choose_with_exposure(options, true);
        CHECK(chosen.configuration == choose_configuration(options, true));
        if (chosen.leaves_exposure_open) {
            CHECK_FALSE(chosen.configuration.tone_map.automatic_exposure);
            CHECK(chosen.configuration.tone_map.exposure_ev == 0.0F);
        }
        return chosen.leaves_exposure_open;
    };
    CHECK(is_open({}));
    Options file;
    file.config = folder / "a.json";
    for (const char* text : {"{}", R"({"tone_map": {"curve": "aces"}})"}) {
        std::ofstream(*file.config) << text;
        CHECK(is_open(file));
    }
    for (const char* text : {R"({"exposure_ev": 0})", R"({"exposure_ev": 1})",
                             R"({"automatic_exposure": false})", R"({"automatic_exposure": true})"}) {
        CAPTURE(text);
        std::ofstream(*file.config) << R"({"tone_map": )" << text << "}";
        CHECK_FALSE(is_open(file));
    }
    Options named;
    named.config = "best";
    CHECK(is_open(named));
    for (const char* flag : {"--exposure=0", "--exposure=2", "--automatic-exposure=off"}) {
        CAPTURE(flag);
        const std::string text = flag;
        named.settings = {{text.substr(0, text.find('=')), text.substr(text.find('=') + 1)}};
        CHECK_FALSE(is_open(named));
    }
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
