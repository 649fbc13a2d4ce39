#include "sandbox/command_line/options.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include <candela/version.hpp>
#include "sandbox/command_line/messages.hpp"
#include "sandbox/files/shipped_file.hpp"

namespace candela::sandbox {

TEST_SUITE("options") {

namespace {

std::variant<Options, EarlyExit> parse(std::vector<const char*> flags) {
    std::vector<const char*> arguments{"candela"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

Options accepted(std::initializer_list<const char*> flags) {
    const auto result = parse(flags);
    if (const auto* exit = std::get_if<EarlyExit>(&result)) FAIL(exit->text);
    return std::get<Options>(result);
}

/// The defaults with what these flags change.
Configuration configured(std::initializer_list<const char*> flags) {
    Configuration configuration;
    apply_settings(accepted(flags), configuration);
    return configuration;
}

/// Checks for one line that starts with the program's name and contains `flag` and `value`, and for exit
/// status 2.
void check_refused(std::initializer_list<const char*> flags, std::string_view flag, std::string_view value) {
    const auto result = parse(flags);
    REQUIRE(std::holds_alternative<EarlyExit>(result));
    const std::string& text = std::get<EarlyExit>(result).text;
    CAPTURE(text);
    CHECK(std::get<EarlyExit>(result).status == 2);
    CHECK(text.starts_with("candela: "));
    CHECK(text.find(flag) != std::string::npos);
    CHECK(text.find(value) != std::string::npos);
    CHECK(text.find('\n') == text.size() - 1);
}

void check_refused_value(const char* flag, std::initializer_list<const char*> values) {
    for (const char* value : values) check_refused({flag, value}, flag, value);
}

}  // namespace

TEST_CASE("without flags everything has its default, and nothing overrides a configuration") {
    const Options options = accepted({});
    CHECK_FALSE(options.headless);
    CHECK(options.context == ContextChoice::automatic);
    CHECK(options.samples == 1);
    CHECK_FALSE((options.scene || options.size || options.frames || options.camera || options.config));
    CHECK(options.settings.empty());
    CHECK_FALSE(options.animate);
    CHECK_FALSE((options.out || options.report || options.describe_graph));
    CHECK_FALSE((options.print_config || options.list_configs));
}

TEST_CASE("every flag sets its option") {
    const std::string config = shipped_file("scenes", "cornell.gltf");  // any file that exists
    const Options options = accepted({"room.glb",
                                      "--headless",
                                      "--context",
                                      "osmesa",
                                      "--size",
                                      "333x217",
                                      "--frames",
                                      "3",
                                      "--samples",
                                      "4",
                                      "--camera",
                                      "2",
                                      "--show",
                                      "indirect",
                                      "--path",
                                      "forward",
                                      "--indirect",
                                      "off",
                                      "--vpl-placement",
                                      "paths",
                                      "--interleave",
                                      "4",
                                      "--vpls",
                                      "0",
                                      "--bounces",
                                      "5",
                                      "--seed",
                                      "4294967295",
                                      "--exposure",
                                      "-2.5",
                                      "--automatic-exposure",
                                      "on",
                                      "--tone-curve",
                                      "neutral",
                                      "--vpl-visibility",
                                      "rays",
                                      "--animate",
                                      "orbit-light",
                                      "--config",
                                      config.c_str(),
                                      "--print-config",
                                      "--out",
                                      "f%d.png",
                                      "--report",
                                      "r.json",
                                      "--describe-graph",
                                      "g.txt",
                                      "--list-configs"});
    CHECK(options.scene == "room.glb");
    CHECK(options.headless);
    CHECK(options.context == ContextChoice::osmesa);
    CHECK(options.size == glm::ivec2(333, 217));
    CHECK(options.frames == 3);
    CHECK(options.samples == 4);
    CHECK(options.camera == "2");
    Configuration configuration;
    apply_settings(options, configuration);
    CHECK(configuration.show == Show::indirect);
    CHECK(configuration.path == ShadingPath::forward);
    CHECK(configuration.indirect == false);
    CHECK(configuration.vpls.placement == VplPlacement::paths);
    CHECK(configuration.vpls.count == 0U);
    CHECK(configuration.vpls.bounces == 5U);
    CHECK(configuration.vpls.seed == 4294967295U);
    CHECK(configuration.tone_map ==
          ToneMapSettings{.exposure_ev = -2.5F, .curve = ToneCurve::neutral, .automatic_exposure = true});
    CHECK(configuration.visibility.method == VplVisibility::rays);
    CHECK(configuration.interleave == Interleave::four);
    CHECK(options.animate == "orbit-light");
    CHECK(options.config == config);
    CHECK(options.print_config);
    CHECK(options.out == "f%d.png");
    CHECK(options.report == "r.json");
    CHECK(options.describe_graph == "g.txt");
    CHECK(options.list_configs);
}

TEST_CASE("every word of each choice is accepted") {
    CHECK(accepted({"--context", "auto"}).context == ContextChoice::automatic);
    CHECK(accepted({"--context", "window"}).context == ContextChoice::window);
    CHECK(accepted({"--context", "egl"}).context == ContextChoice::egl);
    for (const Show show : all_shows) {
        CHECK(configured({"--show", std::string(to_string(show)).c_str()}).show == show);
    }
    for (const candela::ShadingPath path : candela::all_shading_paths) {
        CHECK(configured({"--path", std::string(to_string(path)).c_str()}).path == path);
    }
    CHECK(configured({"--indirect", "on"}).indirect);
    for (const auto method : {VplVisibility::none, VplVisibility::maps, VplVisibility::rays}) {
        const std::string word(to_string(method));
        CHECK(configured({"--vpl-visibility", word.c_str()}).visibility.method == method);
    }
    for (const auto interleave :
         {Interleave::automatic, Interleave::one, Interleave::two, Interleave::four, Interleave::eight}) {
        const std::string word(to_string(interleave));
        CHECK(configured({"--interleave", word.c_str()}).interleave == interleave);
    }
}

TEST_CASE("a context without windows is headless") {
    CHECK(accepted({"--context", "egl"}).headless);
    CHECK(accepted({"--context", "osmesa"}).headless);
    CHECK_FALSE(accepted({"--context", "window"}).headless);
    check_refused({"--headless", "--context", "window"}, "--headless", "--context window");
}

TEST_CASE("sizes range from one pixel to the size of the largest texture") {
    CHECK(accepted({"--size", "1x1"}).size == glm::ivec2(1));
    CHECK(accepted({"--size=16384x1"}).size == glm::ivec2(16384, 1));
    check_refused_value(
        "--size", {"0x0", "0x5", "5x0", "-4x5", "4x-5", "16385x1", "1x16385", "4294967297x1", "64", "64x",
                   "x64", "64x64x64", "64X64", " 64x64", "64x64 ", "axb", "+1x1"});
}

TEST_CASE("the sky is a radiance, or a file") {
    const SkyChoice radiance = accepted({"--environment", "0.5,1,2e2"}).environment.value();
    CHECK(std::get<glm::vec3>(radiance) == glm::vec3(0.5F, 1.0F, 200.0F));
    const SkyChoice file = accepted({"--environment", "/dev/null"}).environment.value();
    CHECK(std::get<std::filesystem::path>(file) == "/dev/null");
    check_refused_value("--environment", {"1", "1,2", "1,2,3,4", "1,2,-3", "1,2,inf", "1,2,nan", "1,2,x",
                                          "1, 2, 3", ",,", "1,2,1e39", "no/such/sky.hdr"});
}

TEST_CASE("numbers must be whole and within their range") {
    check_refused_value("--frames", {"0", "-1", "1.5", "abc", "2147483648", "1e3", "3frames"});
    check_refused_value("--samples", {"0", "-1", "1.5", "abc"});
    for (const char* flag : {"--vpls", "--bounces", "--seed"}) {
        check_refused_value(flag, {"-1", "1.5", "abc", "4294967296", "0x10"});
    }
}

TEST_CASE("unknown words are refused, and so are flags without a value or given twice") {
    check_refused_value("--context", {"glx", "AUTO", "0"});
    check_refused_value("--show", {"both"});
    check_refused_value("--path", {"tiled", "forward-plus", "Forward", "1"});
    check_refused_value("--indirect", {"true", "1"});
    check_refused_value("--vpl-visibility", {"on", "map", "Rays"});
    check_refused_value("--interleave", {"3", "16", "Auto"});
    check_refused({"--vpls"}, "--vpls", "");
    check_refused({"--animate"}, "--animate", "");
    check_refused({"--vpls", "1", "--vpls", "2"}, "--vpls", "");
}

TEST_CASE("flags that do not exist are refused and not in the help") {
    const std::string help = std::get<EarlyExit>(parse({"--help"})).text;
    for (const char* flag : {"--fullscreen", "-x"}) {
        check_refused({flag, "x"}, flag, "");
        CHECK(help.find(flag) == std::string::npos);
    }
    check_refused({"a.gltf", "b.gltf"}, "b.gltf", "");
}

TEST_CASE("messages show control characters as text") {
    for (const std::vector<const char*>& arguments :
         {std::vector<const char*>{"--\x1B]0;"}, {"--vpls", "\x1B[2J"}, {"--config", "\xC2\x9B\n"}}) {
        const EarlyExit exit = std::get<EarlyExit>(parse(arguments));
        CHECK(exit.status == 2);
        CHECK(exit.text.find('\x1B') == std::string::npos);
        CHECK(exit.text.find('\x9B') == std::string::npos);
        CHECK(std::ranges::count(exit.text, '\n') == 1);
    }
    CHECK(one_line("a\nb\x1B") == "a b\\x1B");
    CHECK(one_line(std::string(10'000, 'x')).size() < 5'000);
}

TEST_CASE("the help names every flag, and the version is printed alone") {
    const EarlyExit help = std::get<EarlyExit>(parse({"--help"}));
    CHECK(help.status == 0);
    for (const char* flag :
         {"SCENE",    "--headless",       "--context",        "--size",         "--frames",       "--samples",
          "--camera", "--show",           "--path",           "--indirect",     "--vpls",         "--bounces",
          "--seed",   "--vpl-visibility", "--animate",        "--config",       "--print-config", "--out",
          "--report", "--environment",    "--describe-graph", "--list-configs", "--version",      "--help",
          "--limit",  "--confine"}) {
        CAPTURE(flag);
        CHECK(help.text.find(flag) != std::string::npos);
    }
    const EarlyExit version = std::get<EarlyExit>(parse({"--version"}));
    CHECK(version.status == 0);
    CHECK(version.text == "candela " CANDELA_VERSION "\n");
}

TEST_CASE("files must have a known format and be in an existing folder") {
    CHECK(accepted({"--out", "a.EXR"}).out == "a.EXR");
    CHECK(accepted({"--out", "/tmp/a.pfm"}).out == "/tmp/a.pfm");
    check_refused_value("--out", {"a.jpg", "a", "png", ".png", "/dev/null", "no/such/folder/a.png"});
    check_refused_value("--report", {"a.txt", "no/such/folder/a.json"});
    check_refused_value("--describe-graph", {"a.png", "no/such/folder/a.txt"});
    check_refused_value("--config", {"no-such-file.json", "/tmp"});
}

TEST_CASE("limits of the import, and where it may read") {
    const ImportOptions by_default = import_options(accepted({}));
    CHECK(by_default.root == "/");
    CHECK(by_default.limits.triangles == ImportLimits{}.triangles);
    const ImportOptions set =
        import_options(accepted({"--confine", "--limit", "triangles=7", "--limit", "bytes=0"}));
    CHECK(set.root.empty());  // the scene's own folder
    CHECK(set.limits.triangles == 7);
    CHECK(set.limits.bytes == 0);
    CHECK(set.limits.pixels == ImportLimits{}.pixels);
    check_refused_value("--limit",
                        {"triangles", "triangles=", "triangles=-1", "corners=3", "=3", "nodes=3x"});
}

TEST_CASE("the number of a frame replaces placeholders in the file name") {
    CHECK(numbered("a.png", 7) == "a.png");
    CHECK(numbered("a%d.png", 7) == "a7.png");
    CHECK(numbered("in/f%d-%d.exr", 12) == "in/f12-12.exr");
    CHECK(numbered("%d/100%.png", 3) == "%d/100%.png");
    CHECK(numbered("%05d.png", 42) == "00042.png");
    CHECK(numbered("f%02d of %d.png", 123) == "f123 of 123.png");
    CHECK(numbered("%0d %00d %5d %05.png", 7) == "%0d %00d %5d %05.png");
}
}  // TEST_SUITE("options")

}  // namespace candela::sandbox
