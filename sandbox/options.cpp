#include "sandbox/options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <candela/version.hpp>
#include "sandbox/choose_configuration.hpp"
#include "sandbox/exit_status.hpp"
#include "sandbox/files/output_file.hpp"
#include "sandbox/messages.hpp"
#include "sandbox/scene.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr int largest_side = 16384;  // maximum texture size of most drivers
constexpr std::string_view frame_number = "%d";

/// A flag with a fixed set of values.
template <typename Target, typename Value>
void add_choice(CLI::App& app, const std::string& flag, Target& target,
                std::vector<std::pair<std::string, Value>> choices, const std::string& help) {
    std::vector<std::string> words;
    words.reserve(choices.size());
    for (const auto& choice : choices) words.push_back(choice.first);
    const auto choose = [&target, choices = std::move(choices)](const std::string& word) {
        const auto is_word = [&](const auto& choice) { return choice.first == word; };
        target = std::find_if(choices.begin(), choices.end(), is_word)->second;
    };
    app.add_option_function<std::string>(flag, choose, help)
        ->type_name(fmt::format("{}", fmt::join(words, "|")))
        ->check([words](const std::string& word) {
            const bool known = std::find(words.begin(), words.end(), word) != words.end();
            return known ? std::string() : fmt::format("'{}' is not one of {}", word, fmt::join(words, ", "));
        });
}

/// All errors have the same form: the flag, the value and what is wrong with it.
[[noreturn]] void fail(std::string_view flag, std::string_view value, std::string_view error) {
    throw CLI::ValidationError(std::string(flag), fmt::format("'{}' {}", value, error));
}

/// Parses all of `text` as a number >= `least`.
template <typename Number>
std::optional<Number> parse_number(std::string_view text, Number least) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && number >= least ? std::optional(number) : std::nullopt;
}

template <typename Number, typename Target>
void add_number(CLI::App& app, const std::string& flag, Target& target, Number least,
                const std::string& help) {
    const auto store = [flag, &target, least](const std::string& text) {
        const std::optional<Number> number = parse_number(text, least);
        if (!number) {
            fail(flag, text,
                 fmt::format("is no whole number from {} to {}", least, std::numeric_limits<Number>::max()));
        }
        target = *number;
    };
    app.add_option_function<std::string>(flag, store, help)->type_name("N");
}

glm::ivec2 parse_size(const std::string& text) {
    const std::string_view view = text;
    const std::size_t cross = std::min(view.find('x'), view.size());
    const std::optional<int> width = parse_number(view.substr(0, cross), 1);
    const std::optional<int> height = parse_number(view.substr(std::min(cross + 1, view.size())), 1);
    if (width && height && std::max(*width, *height) <= largest_side) return {*width, *height};
    fail("--size", text, fmt::format("is no size from 1x1 to {0}x{0}", largest_side));
}

struct NamedLimit {
    std::string_view name;
    std::uint64_t ImportLimits::*limit;
};
constexpr std::array limits{NamedLimit{"bytes", &ImportLimits::bytes},
                            NamedLimit{"growth", &ImportLimits::growth},
                            NamedLimit{"image_pixels", &ImportLimits::image_pixels},
                            NamedLimit{"pixels", &ImportLimits::pixels},
                            NamedLimit{"nodes", &ImportLimits::nodes},
                            NamedLimit{"depth", &ImportLimits::depth},
                            NamedLimit{"triangles", &ImportLimits::triangles}};

/// The limits with their defaults, as on the command line.
std::string default_limits() {
    std::vector<std::string> lines;
    lines.reserve(limits.size());
    for (const NamedLimit& each : limits) {
        lines.push_back(fmt::format("{}={}", each.name, ImportLimits{}.*each.limit));
    }
    return fmt::format("{}", fmt::join(lines, ", "));
}

/// "NAME=N".
void set_limit(ImportLimits& target, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const auto named = std::ranges::find(limits, std::string_view(text).substr(0, equals), &NamedLimit::name);
    const std::string_view after = std::string_view(text).substr(std::min(equals + 1, text.size()));
    const auto number = parse_number<std::uint64_t>(after, 0);
    if (named == limits.end() || !number) {
        fail("--limit", text, fmt::format("is not one of {}", default_limits()));
    }
    target.*(named->limit) = *number;
}

/// "R,G,B", or else the name of a file.
SkyChoice parse_sky(const std::string& text) {
    std::vector<float> channels;
    std::size_t from = 0;
    while (from <= text.size()) {
        const std::size_t comma = std::min(text.find(',', from), text.size());
        const std::optional<float> channel =
            parse_number(std::string_view(text).substr(from, comma - from), 0.0F);
        if (!channel || !std::isfinite(*channel)) break;
        channels.push_back(*channel);
        from = comma + 1;
    }
    if (channels.size() == 3 && from > text.size()) return glm::vec3(channels[0], channels[1], channels[2]);
    std::error_code ignored;
    if (fs::exists(text, ignored)) return fs::path(text);
    fail("--environment", text, "is neither three numbers R,G,B, none of them negative, nor a file");
}

/// Checks the path of an output file: the format is known and the folder exists.
fs::path parse_output(std::string_view flag, const std::string& text,
                      const std::vector<std::string_view>& extensions) {
    fs::path path = text;
    const std::string extension = lower_extension(path);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
        fail(flag, text, fmt::format("does not end in {}", fmt::join(extensions, ", ")));
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) fail(flag, text, "lies in a folder that does not exist");
    return path;
}

void add_output(CLI::App& app, const std::string& flag, std::optional<fs::path>& target,
                const std::vector<std::string_view>& extensions, const std::string& help) {
    const auto store = [flag, &target, extensions](const std::string& text) {
        target = parse_output(flag, text, extensions);
    };
    app.add_option_function<std::string>(flag, store, help)
        ->type_name(fmt::format("FILE{}", fmt::join(extensions, "|")));
}

/// The values with their names.
template <typename Enum, std::size_t N>
std::vector<std::pair<std::string, Enum>> named(const std::array<Enum, N>& values) {
    std::vector<std::pair<std::string, Enum>> names;
    names.reserve(N);
    for (const Enum value : values) names.emplace_back(to_string(value), value);
    return names;
}

void declare(CLI::App& app, Options& options) {
    app.footer(exit_statuses);
    app.set_help_flag("--help", "print this and exit");
    app.set_version_flag("--version", "candela " CANDELA_VERSION, "print the version and exit");
    app.add_option("SCENE", options.scene,
                   "default: the one that the script is for, else the shipped Cornell box")
        ->type_name("FILE.gltf|.glb");
    app.add_flag("--confine", options.confine, "scenes may only name files in their own folder, or below it");
    app.add_option_function<std::vector<std::string>>(
           "--limit",
           [&options](const std::vector<std::string>& given) {
               for (const std::string& each : given) set_limit(options.limits, each);
           },
           "an upper limit of scenes, see ImportLimits; default: " + default_limits())
        ->type_name("NAME=N");
    app.add_flag("--headless", options.headless, "no window: render, write, exit");
    add_choice<ContextChoice, ContextChoice>(app, "--context", options.context,
                                             {{"auto", ContextChoice::automatic},
                                              {"window", ContextChoice::window},
                                              {"egl", ContextChoice::egl},
                                              {"osmesa", ContextChoice::osmesa}},
                                             "auto: a window if there is a display, else EGL, else OSMesa");
    app.add_option_function<std::string>(
           "--size", [&options](const std::string& text) { options.size = parse_size(text); },
           "pixels; default: 1280x720 in a window, 512x512 headless")
        ->type_name("WxH");
    add_number(app, "--frames", options.frames, 1,
               "default: headless 1, or as many as the script has; no end in a window");
    add_number(app, "--samples", options.samples, 1,
               "average N frames jittered within the pixel; default: 1");
    app.add_option_function<std::string>(
           "--environment", [&options](const std::string& text) { options.environment = parse_sky(text); },
           "the sky: radiance from everywhere, or an equirectangular picture; default: that of the scene")
        ->type_name("R,G,B|FILE.hdr|.exr");
    app.add_option("--camera", options.camera, "default: the scene's first, else one that sees all of it")
        ->type_name("NAME|INDEX");
    add_choice<std::optional<Show>, Show>(app, "--show", options.show, named(all_shows),
                                          "what goes into the picture");
    add_choice<std::optional<ShadingPath>, ShadingPath>(app, "--path", options.path, named(all_shading_paths),
                                                        "how visible surfaces meet their lights");
    add_choice<std::optional<bool>, bool>(app, "--indirect", options.indirect, {{"on", true}, {"off", false}},
                                          "light by way of surfaces");
    add_choice<std::optional<VplPlacement>, VplPlacement>(
        app, "--vpl-placement", options.vpl_placement,
        {{"paths", VplPlacement::paths}, {"surfels", VplPlacement::surfels}},
        "virtual lights where paths from the lights meet surfaces, or evenly on all surfaces");
    add_number(app, "--vpls", options.vpls, 0U, "virtual point lights");
    add_number(app, "--bounces", options.bounces, 0U, "indirect bounces: 0 is direct light only");
    add_number(app, "--seed", options.seed, 0U, "of the places of virtual lights");
    add_choice<std::optional<VplVisibility>, VplVisibility>(
        app, "--vpl-visibility", options.vpl_visibility,
        {{"none", VplVisibility::none}, {"maps", VplVisibility::maps}, {"rays", VplVisibility::rays}},
        "whether walls stop the light of virtual lights: by depth maps, or exactly by rays");
    add_choice<std::optional<Interleave>, Interleave>(
        app, "--interleave", options.interleave,
        {{"auto", Interleave::automatic},
         {"1", Interleave::one},
         {"2", Interleave::two},
         {"4", Interleave::four},
         {"8", Interleave::eight}},
        "with N, a pixel asks one in N² VPLs, and takes the rest from its neighbours");
    app.add_option("--animate", options.animate,
                   "a script of light, mesh and camera motion, or the name of a shipped one: door-opens, "
                   "flicker-walk, orbit-camera, orbit-light, teleport, toggle")
        ->type_name("FILE.json|NAME");
    app.add_option(
           "--config", options.config,
           "configuration, or the name of one of --list-configs; flags override it; in a window a file is "
           "read again whenever it is saved")
        ->type_name("FILE.json|NAME")
        ->check([](const std::string& given) {
            return find_named(given) != nullptr ? std::string() : CLI::ExistingFile(given);
        });
    app.add_option("--shaders", options.shaders,
                   "read the shaders from this directory; in a window, again whenever one is saved")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory.description(""));
    app.add_flag("--print-config", options.print_config, "print the whole configuration as JSON and exit");
    add_output(app, "--out", options.out, {".png", ".exr", ".pfm"},
               "picture: PNG tone-mapped, EXR and PFM linear radiance; %d numbers frames; default headless: "
               "candela.png, unless a report or a graph is asked for");
    add_output(app, "--report", options.report, {".json"}, "times, counts and the energy account");
    add_output(app, "--describe-graph", options.describe_graph, {".txt", ".dot", ".json"},
               "the compiled frame graph");
    add_output(
        app, "--ui-log", options.ui_log, {".jsonl"},
        "what the window shows, and where its controls are, a JSON object a line: for automatic tests");
    app.add_flag("--list-configs", options.list_configs, "print the named configurations and exit");
}

/// Checks across several flags.
void check_together(Options& options) {
    const bool windowless = options.context == ContextChoice::egl || options.context == ContextChoice::osmesa;
    if (options.headless && options.context == ContextChoice::window) {
        throw CLI::ValidationError("--headless", "there is no window for --context window");
    }
    options.headless = options.headless || windowless;
}

}  // namespace

std::variant<Options, EarlyExit> parse_options(int count, const char* const* arguments) {
    CLI::App app("Real-time global illumination by instant radiosity", "candela");
    Options options;
    declare(app, options);
    try {
        app.parse(count, arguments);
        check_together(options);
        return options;
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{success, app.help()};
    } catch (const CLI::CallForVersion& version) {
        return EarlyExit{success, fmt::format("{}\n", version.what())};
    } catch (const CLI::ParseError& error) {
        return EarlyExit{bad_input, fmt::format("candela: {}\n", one_line(error.what()))};
    }
}

ImportOptions import_options(const Options& options) {
    ImportOptions import = unconfined();
    import.limits = options.limits;
    if (options.confine) import.root.clear();
    return import;
}

fs::path numbered(const fs::path& out, int frame) {
    std::string name = out.filename().string();
    const std::string number = fmt::format("{}", frame);
    for (auto at = name.find(frame_number); at != std::string::npos; at = name.find(frame_number, at)) {
        name.replace(at, frame_number.size(), number);
    }
    return out.parent_path() / name;
}

}  // namespace candela::sandbox
