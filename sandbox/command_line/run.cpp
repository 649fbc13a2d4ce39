#include "sandbox/command_line/run.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/gl_error.hpp>
#include <candela/headless_context.hpp>
#include <candela/tools/output_file.hpp>
#include "sandbox/animation/animation_script.hpp"
#include "sandbox/animation/clips.hpp"
#include "sandbox/candela_private.hpp"
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/command_line/messages.hpp"
#include "sandbox/files/config_watch.hpp"
#include "sandbox/headless/headless.hpp"
#include "sandbox/headless/report.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/scene/scene.hpp"
#include "sandbox/scene/studio.hpp"
#include "sandbox/window/run_window.hpp"
#include "sandbox/window/window.hpp"

namespace candela::sandbox {

namespace {

constexpr glm::ivec2 window_size{1280, 720};
constexpr glm::ivec2 headless_size{512, 512};

ExitStatus report_error(std::string_view error, ExitStatus status) {
    print_message(error);
    return status;
}

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets variables
    return value != nullptr && *value != '\0';
}

bool has_display() {
    return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

std::vector<ContextKind> headless_kinds(ContextChoice choice) {
    switch (choice) {
        case ContextChoice::egl:
            return {ContextKind::egl};
        case ContextChoice::osmesa:
            return {ContextKind::osmesa};
        case ContextChoice::automatic:
        case ContextChoice::window:
            break;
    }
    return {ContextKind::egl, ContextKind::osmesa};
}

bool wants_window(const Options& options) {
    return !options.headless && (options.context == ContextChoice::window || has_display());
}

/// A window, or null if headless contexts are to be tried. Adds error messages to `tried`.
std::unique_ptr<Window> open_window(const Options& options, glm::ivec2 size,
                                    std::vector<std::string>& tried) {
    if (!wants_window(options)) return nullptr;
    try {
        return std::make_unique<Window>(size, "Candela");
    } catch (const ContextError& error) {
        if (options.context == ContextChoice::window) throw;
        tried.emplace_back(error.what());
        return nullptr;
    }
}

std::unique_ptr<HeadlessContext> open_headless(ContextChoice choice, std::vector<std::string>& tried) {
    for (const ContextKind kind : headless_kinds(choice)) {
        try {
            auto context = HeadlessContext::create(kind);
            context->make_current();
            return context;
        } catch (const ContextError& error) {
            tried.emplace_back(error.what());
        }
    }
    throw ContextError(fmt::format("no OpenGL 4.5 context: {}", fmt::join(tried, "; ")));
}

std::filesystem::path default_scene() {
    return shipped_file("scenes", "cornell.gltf");
}

float aspect(glm::ivec2 size) {
    return static_cast<float>(size.x) / static_cast<float>(size.y);
}

/// The scene given by the options, else by the script, else the default scene; with the chosen sky and the
/// script's animation.
Scene open_scene(const Options& options, const TellProgress& tell) {
    std::optional<Script> script;
    if (options.animate) script = load_script(*options.animate);
    const std::filesystem::path by_default =
        script ? scene_of(*script).value_or(default_scene()) : default_scene();
    ImportOptions import = import_options(options);
    import.progress = tell;
    Scene scene = load_scene(options.scene.value_or(by_default), import);
    if (options.environment) set_sky(scene, *options.environment);
    light_if_dark(scene);
    if (script) scene.animation.emplace(std::move(*script), scene.world);
    if (options.clip) choose_clip(scene.world, *options.clip);
    advance_animations(scene.world, options.clip_time);
    return scene;
}

ExitStatus run_session(const Options& options, const MakeReference& make_reference) {
    ConfigWatch watch(options);
    const bool windowed = wants_window(options);
    Configuration chosen = choose_configuration(options, windowed);
    if (options.list_configs || options.print_config) {
        fmt::print("{}", options.list_configs ? list_configurations() : write_configuration(chosen) + "\n");
        return success;
    }
    std::vector<std::string> tried;
    if (const std::unique_ptr<Window> window =
            open_window(options, options.size.value_or(window_size), tried)) {
        run_window(
            *window, [&](const TellProgress& tell) { return open_scene(options, tell); }, chosen, watch,
            options, make_reference);
        return success;
    }
    for (const std::string& error : tried) print_message("no window: " + error);
    Scene scene = open_scene(options, {});
    for (const std::string& warning : first_ten(scene.warnings)) print_message(warning);
    const glm::ivec2 size = options.size.value_or(headless_size);
    const Entity camera = choose_camera(scene.world, options.camera, aspect(size));
    const std::unique_ptr<HeadlessContext> context = open_headless(options.context, tried);
    if (windowed) chosen = choose_configuration(options, false);
    return run_headless(*context, scene, camera, chosen, options, size);
}

}  // namespace

ExitStatus run(const Options& options, const MakeReference& make_reference) {
    try {
        return run_session(options, make_reference);
    } catch (const ContextError& error) {
        return report_error(error.what(), no_driver);
    } catch (const gl::MemoryError& error) {
        return report_error(error.what(), no_driver);
    } catch (const std::bad_alloc&) {
        return report_error("out of memory", no_driver);
    } catch (const PictureError& error) {
        return report_error(error.what(), wrong_picture);
    } catch (const std::exception& error) {
        return report_error(error.what(), bad_input);
    }
}

}  // namespace candela::sandbox
