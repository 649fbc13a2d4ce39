#include "sandbox/command_line/options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <regex>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/settings.hpp>
#include <candela/tools/output_file.hpp>
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr int largest_side = 16384;  // maximum texture size of most drivers

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

/// The words for the values of an option, in their order.
using Words = std::vector<std::string_view>;

/// Which of the words it is.
std::size_t index_of(std::string_view flag, std::string_view word, const Words& words) {
    const auto found = std::ranges::find(words, word);
    if (found == words.end()) fail(flag, word, fmt::format("is not one of {}", fmt::join(words, ", ")));
    return static_cast<std::size_t>(found - words.begin());
}

/// Parses all of `text` as a number >= `least`.
template <typename Number>
std::optional<Number> parse_number(std::string_view text, Number least) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && number >= least ? std::optional(number) : std::nullopt;
}

/// The same, with an error for other texts and for numbers above `most`.
template <typename Number>
Number number_of(std::string_view flag, std::string_view text, Number least,
                 Number most = std::numeric_limits<Number>::max()) {
    const std::optional<Number> number = parse_number(text, least);
    if (number && *number <= most) return *number;
    const std::string_view kind = std::is_integral_v<Number> ? "whole number" : "number";
    fail(flag, text, fmt::format("is no {} from {} to {}", kind, least, most));
}

template <typename Target>
void add_count(CommandLine& line, const std::string& flag, Target& target, const std::string& help) {
    line.add_value(flag, "N", help,
                   [flag, &target](const std::string& text) { target = number_of(flag, text, 1); });
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
    const std::string extension = tools::lower_extension(path);
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

template <class T>
constexpr bool has_words = std::is_enum_v<T> || std::is_same_v<T, bool>;

/// The words for the values of a setting; none if it is a number.
template <class T>
Words words_of(const T& value) {
    Words words;
    if constexpr (std::is_same_v<T, bool>) {
        words = {"off", "on"};
    } else if constexpr (std::is_enum_v<T>) {
        for (const Choice& choice : choices_of(value)) words.push_back(choice.name);
    }
    return words;
}

/// A setting's value as on the command line.
template <class T>
std::string text_of(const T& value) {
    if constexpr (has_words<T>) {
        return std::string(words_of(value)[static_cast<std::size_t>(value)]);
    } else {
        return fmt::format("{}", value);
    }
}
std::string text_of(const std::optional<float>& value) {
    return value ? text_of(*value) : "auto";
}

/// Sets a setting to the value of its flag.
template <class T>
void set_value(const Setting& setting, T& value, const std::string& text) {
    if constexpr (has_words<T>) {
        value = static_cast<T>(index_of(setting.flag, text, words_of(value)));
    } else {
        value = number_of(setting.flag, text, static_cast<T>(setting.range.least),
                          static_cast<T>(setting.range.most));
    }
}
void set_value(const Setting& setting, std::optional<float>& value, const std::string& text) {
    if (text == "auto") return value.reset();
    set_value(setting, value.emplace(), text);
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
    line.add_value("--context", "auto|window|egl|osmesa",
                   "auto: a window if there is a display, else EGL, else OSMesa",
                   [&options](const std::string& text) {
                       const Words words{"auto", "window", "egl", "osmesa"};
                       options.context = static_cast<ContextChoice>(index_of("--context", text, words));
                   });
    line.add_value("--size", "WxH", "pixels; default: 1280x720 in a window, 512x512 headless",
                   [&options](const std::string& text) { options.size = parse_size(text); });
    add_count(line, "--frames", options.frames,
              "default: headless 1, or as many as the script has; no end in a window");
    add_count(line, "--samples", options.samples, "average N frames jittered within the pixel; default: 1");
    line.add_value(
        "--update-budget", "MS",
        "milliseconds for a frame in which much moves: as many surfels are traced as fit, see --vpl-updates, "
        "and the others in the next frames; 0: all at once; default: 60 in a window, headless 0",
        [&options](const std::string& text) {
            options.update_budget = number_of("--update-budget", text, 0.0, 1e6);
        });
    line.add_value(
        "--environment", "R,G,B|FILE.hdr|.exr",
        "the sky: radiance from everywhere, or an equirectangular picture; default: that of the scene",
        [&options](const std::string& text) { options.environment = parse_sky(text); });
    add_text(line, "--camera", options.camera, "NAME|INDEX",
             "default: the scene's first, else one that sees all of it");
    add_text(line, "--clip", options.clip, "NAME|INDEX", "the animation to play; default: the scene's first");
    line.add_value(
        "--clip-time", "SECONDS",
        "where the animation begins; each of --frames is 1/30 s later than the one before; default: 0",
        [&options](const std::string& text) {
            options.clip_time = number_of("--clip-time", text, 0.0, 1e6);
        });
}

void declare_settings(CommandLine& line, Options& options) {
    const Configuration defaults;
    for_each_setting(defaults, [&](const Setting& setting, const auto& by_default) {
        if (setting.flag.empty()) return;
        const std::string flag(setting.flag);
        const Words words = words_of(by_default);
        const std::string type = words.empty() ? "N" : fmt::format("{}", fmt::join(words, "|"));
        const std::string range =
            words.empty() ? fmt::format("{} to {}, ", setting.range.least, setting.range.most) : "";
        const std::string help = fmt::format("{}; {}default: {}", setting.help, range, text_of(by_default));
        line.add_value(flag, type, help, [=, &options](const std::string& text) {
            auto value = by_default;
            set_value(setting, value, text);  // throws if the text is wrong
            options.settings[flag] = text;
        });
    });
}

void declare_files(CommandLine& line, Options& options) {
    add_text(line, "--animate", options.animate, "FILE.json|NAME",
             "a script of light, mesh and camera motion, or the name of a shipped one: boxes-fall, "
             "door-opens, flicker-walk, orbit-camera, orbit-light, teleport, toggle, walk-in");
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
    add_output(
        line, "--out", options.out, {".png", ".exr", ".pfm"},
        "picture: PNG tone-mapped, EXR and PFM linear radiance; %d numbers frames, %05d with five digits; "
        "default headless: candela.png, unless a report or a graph is asked for");
    add_output(line, "--report", options.report, {".json"}, "times, counts and the energy account");
    add_output(line, "--describe-graph", options.describe_graph, {".txt"}, "the compiled frame graph");
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
    declare_settings(line, options);
    declare_files(line, options);
    const std::optional<EarlyExit> exit = line.parse(count, arguments, [&] { check_together(options); });
    if (exit) return *exit;
    return options;
}

void apply_settings(const Options& options, Configuration& configuration) {
    for_each_setting(configuration, [&](const Setting& setting, auto& value) {
        const auto given = options.settings.find(std::string(setting.flag));
        if (given != options.settings.end()) set_value(setting, value, given->second);
    });
}

ImportOptions import_options(const Options& options) {
    ImportOptions import = unconfined();
    import.limits = options.limits;
    if (options.confine) import.root.clear();
    return import;
}

fs::path numbered(const fs::path& out, int frame) {
    static const std::regex place("%(0([1-9][0-9]?))?d");
    const std::string name = out.filename().string();
    std::string result;
    auto rest = name.cbegin();
    for (std::sregex_iterator found(name.cbegin(), name.cend(), place), end; found != end; ++found) {
        const std::ssub_match& digits = (*found)[2];
        result.append(rest, (*found)[0].first);
        result += fmt::format("{:0{}}", frame, digits.matched ? std::stoi(digits.str()) : 1);
        rest = (*found)[0].second;
    }
    result.append(rest, name.cend());
    return out.parent_path() / result;
}

bool is_numbered(const fs::path& out) {
    return numbered(out, 0) != out;
}

}  // namespace candela::sandbox
