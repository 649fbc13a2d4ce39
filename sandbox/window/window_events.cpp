// What arrives at the session of a window: input, files, scenes, frames.

#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <candela/tools/output_file.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/command_line/messages.hpp"
#include "sandbox/files/recent_files.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/window/save_commands.hpp"
#include "sandbox/window/window_session.hpp"

namespace candela::sandbox {

namespace {

bool works_while_typing(const InputEvent& event) {
    if (event.kind != InputEvent::Kind::key) return false;
    const KeyBinding* const binding = find_binding(event.code, event.modifiers);
    return binding != nullptr && works_while_typing(binding->action);
}

}  // namespace

void WindowSession::take(const InputEvent& event) {
    using Kind = InputEvent::Kind;
    while (gui_.needs_frame_before(event)) draw();
    gui_.tell(event);
    if (event.kind == Kind::move) {
        redraw_.pointer_moved();
    } else {
        redraw_.changed();
    }
    // Dear ImGui knows only while it draws whether the pointer is over one of its windows now.
    if (event.kind == Kind::press) draw();
    if (!state_.document) {
        const bool control = (event.modifiers & GLFW_MOD_CONTROL) != 0;
        if (event.kind == Kind::key && event.code == GLFW_KEY_Q && control) window_.close();
        return;
    }
    // A drag is likely to follow: no more work on the picture at rest, which the drag would have to wait for.
    if (event.kind == Kind::press) thread_->hold_refinement(true);
    if (event.kind == Kind::release) thread_->hold_refinement(false);
    if (Gui::wants(event.kind) && !works_while_typing(event)) return;
    Document& document = *state_.document;
    const Tick before = document.scene.world.revision();
    const Rectangle& scene = state_.layout.scene;
    const auto command = document.interaction.handle(event, scene.size, scene.corner);
    if (command) carry_out(*command);
    if (document.scene.world.revision() != before && !input_) input_ = event.time;
}

void WindowSession::take_news() {
    take_loaded_scene();
    for (const std::filesystem::path& file : window_.take_dropped_files()) open_file(file);
    take_saved_picture();
    take_saved_configuration();
    take_saved_shaders();
    take_warnings();
    if (std::optional<RenderedFrame> frame = thread_->take()) show(std::move(*frame));
}

void WindowSession::take_loaded_scene() {
    if (!loader_.is_ready()) return;
    redraw_.changed();
    const glm::vec2 size = window_.size();
    const bool first = !state_.document;
    try {
        state_.document.emplace(loader_.take(), first ? options_.camera : std::nullopt, size.x / size.y);
    } catch (const std::runtime_error& error) {
        if (first) throw;
        return report_errors({error.what()});
    }
    cut_ = true;
    last_animated_ = Clock::now();
    if (!first) {
        state_.app.errors.clear();
        state_.app.notice.clear();
        add_recent_file(recent_files_list(), std::filesystem::absolute(state_.document->scene.path));
    }
    announce_scene();
}

void WindowSession::announce_scene() {
    const Scene& scene = state_.document->scene;
    state_.app.warnings = first_ten(scene.warnings);
    if (std::string fault = why_nothing_is_seen(scene); !fault.empty())
        state_.app.errors = {std::move(fault)};
    window_.set_title(fmt::format("Candela - {}", scene.path.filename().string()));
    for (const std::string& warning : state_.app.warnings) print_message(warning);
}

void WindowSession::open_file(const std::filesystem::path& file) {
    const std::string extension = tools::lower_extension(file);
    if (extension == ".gltf" || extension == ".glb") return open(file);
    if (!state_.document || (extension != ".hdr" && extension != ".exr")) {
        return report_errors(
            {fmt::format("{}: is neither a scene (.gltf, .glb) nor a sky (.hdr, .exr)", file.string())});
    }
    attempt([&] {
        set_sky(state_.document->scene, file);
        redraw_.changed();
    });
}

void WindowSession::take_saved_picture() {
    const bool is_ready = saved_picture_.valid() &&
                          saved_picture_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!is_ready) return;
    redraw_.changed();
    attempt([&] { state_.app.notice = written(saved_picture_.get()); });
}

void WindowSession::take_saved_configuration() {
    const std::optional<ConfigurationResult> saved = watch_.poll(SaveWatch::Clock::now());
    if (!saved) return;
    report_errors(saved->errors);
    if (saved->configuration) state_.app.configuration = *saved->configuration;
}

void WindowSession::take_saved_shaders() {
    if (shader_saves_.has_saved(SaveWatch::Clock::now()) && shader_saves_.accept()) thread_->reload_shaders();
}

void WindowSession::take_warnings() {
    for (std::string& line : warnings_.take()) {
        print_message(line);
        state_.app.warnings.push_back(std::move(line));
        redraw_.changed();
    }
}

void WindowSession::show(RenderedFrame frame) {
    redraw_.changed_once();
    for (const FrameReport& times : frame.times) state_.costs.add(times);
    if (options_.report) std::ranges::move(frame.times, std::back_inserter(reports_));
    show_errors(frame);
    if (frame.graph && frame.graph != graph_) {
        graph_ = frame.graph;
        state_.graph = *graph_;
    }
    if (frame.input) answered_input_ = frame.input;
    if (!frame.report && state_.shown) frame.report = state_.shown->report;
    state_.shown = std::move(frame);
    if (state_.shown->radiance) measure_error();
}

/// Errors of a frame stay until a frame of the newest request has none.
void WindowSession::show_errors(const RenderedFrame& frame) {
    if (frame.errors != state_.app.errors) {
        for (const std::string& error : frame.errors) print_message(error);
    }
    if (frame.request == state_.submitted && (!frame.errors.empty() || from_renderer_)) {
        state_.app.errors = frame.errors;
        from_renderer_ = !frame.errors.empty();
    }
}

}  // namespace candela::sandbox
