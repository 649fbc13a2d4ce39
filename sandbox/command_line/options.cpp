#include "sandbox/command_line/options.hpp"

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

#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/files/output_file.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr int largest_side = 16384;  // maximum texture size of most drivers
constexpr std::string_view frame_number = "%d";

/// All errors have the same form: the flag, the value and what is wrong with it.
[[noreturn]] void fail(std::string_view flag, std::string_view value, std::string_view error) {
    throw FlagError(flag, fmt::format("'{}' {}", value, error));
}

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

/// Whether it exists and is no folder: it may be a pipe.
bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored) && !is_folder(path);
}

/// A flag with a fixed set of values.
template <typename Target, typename Value>
void add_choice(CommandLine& line, const std::string& flag, Target& target,
                std::vector<std::pair<std::string, Value>> choices, const std::string& help) {
    std::vector<std::string> words;
    words.reserve(choices.size());
    for (const auto& choice : choices) words.push_back(choice.first);
    const std::string type = fmt::format("{}", fmt::join(words, "|"));
    line.add_value(flag, type, help, [=, &target, choices = std::move(choices)](const std::string& word) {
        const auto is_word = [&](const auto& choice) { return choice.first == word; };
        const auto found = std::ranges::find_if(choices, is_word);
        if (found == choices.end()) fail(flag, word, fmt::format("is not one of {}", fmt::join(words, ", ")));
        target = found->second;
    });
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
void add_number(CommandLine& line, const std::string& flag, Target& target, Number least,
                const std::string& help) {
    line.add_value(flag, "N", help, [flag, &target, least](const std::string& text) {
        const std::optional<Number> number = parse_number(text, least);
        if (!number) {
            fail(flag, text,
                 fmt::format("is no whole number from {} to {}", least, std::numeric_limits<Number>::max()));
        }
        target = *number;
    });
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
    if (is_file(text)) return fs::path(text);
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
    if (!is_folder(folder)) fail(flag, text, "lies in a folder that does not exist");
    return path;
}

void add_output(CommandLine& line, const std::string& flag, std::optional<fs::path>& target,
                const std::vector<std::string_view>& extensions, const std::string& help) {
    const std::string type = fmt::format("FILE{}", fmt::join(extensions, "|"));
    line.add_value(flag, type, help, [flag, &target, extensions](const std::string& text) {
        target = parse_output(flag, text, extensions);
    });
}

/// A flag whose value is taken as it is.
template <typename Target>
void add_text(CommandLine& line, const std::string& flag, Target& target, const std::string& type,
              const std::string& help) {
    line.add_value(flag, type, help, [&target](const std::string& text) { target = text; });
}

/// The values with their names.
template <typename Enum, std::size_t N>
std::vector<std::pair<std::string, Enum>> named(const std::array<Enum, N>& values) {
    std::vector<std::pair<std::string, Enum>> names;
    names.reserve(N);
    for (const Enum value : values) names.emplace_back(to_string(value), value);
    return names;
}

void declare_scene(CommandLine& line, Options& options) {
    add_text(line, "SCENE", options.scene, "FILE.gltf|.glb",
             "default: the one that the script is for, else the shipped Cornell box");
    line.add_switch("--confine", "scenes may only name files in their own folder, or below it",
                    options.confine);
    line.add_values("--limit", "NAME=N",
                    "an upper limit of scenes, see ImportLimits; default: " + default_limits(),
                    [&options](const std::string& each) { set_limit(options.limits, each); });
    line.add_switch("--headless", "no window: render, write, exit", options.headless);
    add_choice<ContextChoice, ContextChoice>(line, "--context", options.context,
                                             {{"auto", ContextChoice::automatic},
                                              {"window", ContextChoice::window},
                                              {"egl", ContextChoice::egl},
                                              {"osmesa", ContextChoice::osmesa}},
                                             "auto: a window if there is a display, else EGL, else OSMesa");
    line.add_value("--size", "WxH", "pixels; default: 1280x720 in a window, 512x512 headless",
                   [&options](const std::string& text) { options.size = parse_size(text); });
    add_number(line, "--frames", options.frames, 1,
               "default: headless 1, or as many as the script has; no end in a window");
    add_number(line, "--samples", options.samples, 1,
               "average N frames jittered within the pixel; default: 1");
    line.add_value(
        "--environment", "R,G,B|FILE.hdr|.exr",
        "the sky: radiance from everywhere, or an equirectangular picture; default: that of the scene",
        [&options](const std::string& text) { options.environment = parse_sky(text); });
    add_text(line, "--camera", options.camera, "NAME|INDEX",
             "default: the scene's first, else one that sees all of it");
}

void declare_lighting(CommandLine& line, Options& options) {
    add_choice<std::optional<Show>, Show>(line, "--show", options.show, named(all_shows),
                                          "what goes into the picture");
    add_choice<std::optional<ShadingPath>, ShadingPath>(
        line, "--path", options.path, named(all_shading_paths), "how visible surfaces meet their lights");
    add_choice<std::optional<bool>, bool>(line, "--indirect", options.indirect,
                                          {{"on", true}, {"off", false}}, "light by way of surfaces");
    add_choice<std::optional<VplPlacement>, VplPlacement>(
        line, "--vpl-placement", options.vpl_placement,
        {{"paths", VplPlacement::paths}, {"surfels", VplPlacement::surfels}},
        "virtual lights where paths from the lights meet surfaces, or evenly on all surfaces");
    add_number(line, "--vpls", options.vpls, 0U, "virtual point lights");
    add_number(line, "--bounces", options.bounces, 0U, "indirect bounces: 0 is direct light only");
    add_number(line, "--seed", options.seed, 0U, "of the places of virtual lights");
    add_choice<std::optional<VplVisibility>, VplVisibility>(
        line, "--vpl-visibility", options.vpl_visibility,
        {{"none", VplVisibility::none}, {"maps", VplVisibility::maps}, {"rays", VplVisibility::rays}},
        "whether walls stop the light of virtual lights: by depth maps, or exactly by rays");
    add_choice<std::optional<Interleave>, Interleave>(
        line, "--interleave", options.interleave,
        {{"auto", Interleave::automatic},
         {"1", Interleave::one},
         {"2", Interleave::two},
         {"4", Interleave::four},
         {"8", Interleave::eight}},
        "with N, a pixel asks one in N² VPLs, and takes the rest from its neighbours");
}

void declare_files(CommandLine& line, Options& options) {
    add_text(line, "--animate", options.animate, "FILE.json|NAME",
             "a script of light, mesh and camera motion, or the name of a shipped one: door-opens, "
             "flicker-walk, orbit-camera, orbit-light, teleport, toggle");
    line.add_value(
        "--config", "FILE.json|NAME",
        "configuration, or the name of one of --list-configs; flags override it; in a window a file is "
        "read again whenever it is saved",
        [&options](const std::string& given) {
            if (find_named(given) == nullptr && !is_file(given)) fail("--config", given, "is no file");
            options.config = given;
        });
    line.add_value("--shaders", "DIR",
                   "read the shaders from this directory; in a window, again whenever one is saved",
                   [&options](const std::string& given) {
                       if (!is_folder(given)) fail("--shaders", given, "is no directory");
                       options.shaders = given;
                   });
    line.add_switch("--print-config", "print the whole configuration as JSON and exit", options.print_config);
    add_output(line, "--out", options.out, {".png", ".exr", ".pfm"},
               "picture: PNG tone-mapped, EXR and PFM linear radiance; %d numbers frames; default headless: "
               "candela.png, unless a report or a graph is asked for");
    add_output(line, "--report", options.report, {".json"}, "times, counts and the energy account");
    add_output(line, "--describe-graph", options.describe_graph, {".txt", ".dot", ".json"},
               "the compiled frame graph");
    add_output(
        line, "--ui-log", options.ui_log, {".jsonl"},
        "what the window shows, and where its controls are, a JSON object a line: for automatic tests");
    line.add_switch("--list-configs", "print the named configurations and exit", options.list_configs);
}

/// Checks across several flags.
void check_together(Options& options) {
    const bool windowless = options.context == ContextChoice::egl || options.context == ContextChoice::osmesa;
    if (options.headless && options.context == ContextChoice::window) {
        throw FlagError("--headless", "there is no window for --context window");
    }
    options.headless = options.headless || windowless;
}

}  // namespace

std::variant<Options, EarlyExit> parse_options(int count, const char* const* arguments) {
    CommandLine line("Real-time global illumination by instant radiosity", exit_statuses);
    Options options;
    declare_scene(line, options);
    declare_lighting(line, options);
    declare_files(line, options);
    const std::optional<EarlyExit> exit = line.parse(count, arguments, [&] { check_together(options); });
    if (exit) return *exit;
    return options;
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
