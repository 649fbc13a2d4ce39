#include "sandbox/window/window_session.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include <candela/tools/capture.hpp>
#include "sandbox/headless/headless.hpp"
#include "sandbox/headless/report.hpp"
#include "sandbox/panels/controls.hpp"
#include "sandbox/panels/help_panel.hpp"
#include "sandbox/panels/overlay.hpp"
#include "sandbox/panels/status_line.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/window/window_view.hpp"

namespace candela::sandbox {

namespace {

using Seconds = std::chrono::duration<double>;

}  // namespace

WindowSession::WindowSession(Window& window, const OpenScene& open, const Configuration& chosen,
                             ConfigWatch& watch, const Options& options, const MakeReference& make_reference)
    : window_(window), watch_(watch), options_(options), shader_saves_(options.shaders), gui_(window) {
    constexpr double default_budget_ms = 60.0;
    state_.app.configuration = chosen;
    state_.app.update_budget_ms = options.update_budget.value_or(default_budget_ms);
    if (make_reference) state_.reference = ReferenceView(make_reference(Window::wake));
    if (options.ui_log) log_.emplace(*options.ui_log);
    loader_.start(open, "the scene");
    thread_ = std::make_unique<RenderThread>(
        window.share(),
        RendererOptions{.shader_directory = options.shaders.value_or(std::filesystem::path()).string(),
                        .log = [this](std::string_view line) { warnings_.add(line); },
                        .keeps_gl_state = false},
        Window::wake);
}

void WindowSession::run() {
    if (options_.frames) loader_.wait();
    while (!window_.should_close() && (!options_.frames || frame_ < *options_.frames)) step();
    window_.hide();
}

bool WindowSession::stop() {
    constexpr double patience = 0.2;  // seconds
    if (saved_picture_.valid()) saved_picture_.wait();
    loader_.cancel();
    return thread_->stop(patience) && loader_.is_idle();
}

void WindowSession::step() {
    const std::vector<InputEvent> events = window_.take_events(time_to_wait());
    const glm::ivec2 pixels = window_.framebuffer_size();
    const glm::ivec2 size = window_.size();
    hidden_ = std::min({pixels.x, pixels.y, size.x, size.y}) < 1;
    thread_->pause(hidden_);
    take_news();
    if (window_.take_exposed()) redraw_.changed();
    if (hidden_) return;
    pixel_ratio_ = static_cast<float>(pixels.x) / static_cast<float>(size.x);
    state_.layout =
        make_layout(size, gui_.scale(), {.panel = state_.app.panel, .status_height = 22.0F * gui_.scale()});
    for (const InputEvent& event : events) take(event);
    if (state_.document) {
        move();
        if (!state_.shown || state_.is_answered()) animate();
        follow_reference();
        submit();
        if (options_.frames) show(thread_->wait_for(state_.submitted));
    }
    const bool rendering = state_.document && !state_.is_answered();
    if (options_.frames || !busy_words().empty() || redraw_.is_due(Clock::now(), rendering)) draw();
}

/// Seconds that the window may sleep if no event arrives.
double WindowSession::time_to_wait() const {
    constexpr double while_busy = 0.1;  // turns the spinner, and sees what takes long
    constexpr double while_moving = 0.016;
    constexpr double idle = 0.2;  // looks for a saved configuration
    if (hidden_) return idle;
    if (options_.frames || redraw_.has_changes()) return 0.0;
    if (state_.is_playing() && state_.is_answered()) return 0.0;
    if (state_.document && state_.document->interaction.moving()) return while_moving;
    if (redraw_.has_moves()) return Seconds(Redraw::between_moves).count();
    const bool busy = loader_.is_loading() || !state_.is_answered() || !state_.shown->settled;
    return busy ? while_busy : idle;
}

/// Flies, and records.
void WindowSession::move() {
    const Clock::time_point now = Clock::now();
    const auto seconds = static_cast<float>(Seconds(now - std::exchange(last_step_, now)).count());
    Document& document = *state_.document;
    document.interaction.unit = gui_.scale();
    const Tick before = document.scene.world.revision();
    document.interaction.step(seconds, state_.layout.scene.size, state_.layout.scene.corner);
    if (document.scene.world.revision() != before && !input_) input_ = now;
    if (document.recorder) {
        document.recorder->record(document.scene.world, Seconds(now.time_since_epoch()).count());
    }
}

/// Shows what moves by itself at the present time.
void WindowSession::animate() {
    const Clock::time_point now = Clock::now();
    const double passed = Seconds(now - std::exchange(last_animated_, now)).count();
    cut_ |= state_.document->animate(options_.frames ? seconds_a_frame : passed);
}

void WindowSession::follow_reference() {
    state_.reference.follow(reference_request(state_, picture_size()));
    if (state_.reference.update()) measure_error();
    if (!state_.app.reference) state_.app.error.reset();
}

/// The error of the picture over the reference.
void WindowSession::measure_error() {
    redraw_.changed_once();
    const bool is_read = state_.shown && state_.shown->radiance;
    state_.app.error = is_read ? state_.reference.errors_of(*state_.shown->radiance) : std::nullopt;
}

glm::uvec2 WindowSession::picture_size() const {
    return glm::max(glm::uvec2(state_.layout.scene.size * pixel_ratio_), 1U);
}

/// Asks for a new picture if something has changed since the last request.
void WindowSession::submit() {
    FrameRequest request = frame_request(state_, picture_size());
    if (request != requested_) {
        requested_ = request;
        request.cut = cut_;
        request.whole = options_.frames.has_value();
        request.input = std::exchange(input_, std::nullopt);
        state_.submitted = thread_->submit(std::move(request));
    }
    cut_ = false;
}

void WindowSession::draw() {
    redraw_.draw(Clock::now());
    note_progress();
    gui_.begin_frame();
    draw_scene(state_, window_.size());
    for (const Action action : draw_panel(state_)) carry_out({action});
    draw_messages(state_.app.errors, state_.app.notice, state_.layout.scene);
    draw_help(state_.app.help, state_.layout.scene);
    if (const auto chosen = open_panel_.draw()) open_file(*chosen);
    draw_status_line(status_of(state_), state_.layout.status, ImGui::GetTime());
    gui_.end_frame();
    window_.swap();
    ++frame_;
    if (state_.document) submit();  // what the panel has changed
    write_log();
    answered_input_.reset();
}

void WindowSession::note_progress() {
    state_.loading = loader_.is_loading();
    state_.busy = busy_words();
}

std::string WindowSession::busy_words() const {
    constexpr Seconds noticeable(0.3);
    if (loader_.is_loading()) return loader_.words();
    const RenderStage stage = thread_->stage();
    if (stage == RenderStage::idle || thread_->stage_time() < noticeable) return "";
    if (stage == RenderStage::rendering) return "rendering";
    return "compiling shaders, placing virtual lights";
}

void WindowSession::write_log() {
    if (!log_) return;
    note_progress();
    std::optional<double> latency;
    if (answered_input_) latency = Seconds(Clock::now() - *answered_input_).count();
    log_->add(state_, {.number = frame_,
                       .time = ImGui::GetTime(),
                       .latency = latency,
                       .scale = gui_.scale(),
                       .controls = take_control_places()});
}

void WindowSession::write_results() {
    if (!state_.document || (!options_.out && !options_.report && !options_.describe_graph)) return;
    thread_->run([this](Renderer& renderer) {
        const Scene& scene = state_.document->scene;
        const glm::ivec2 size = state_.shown ? glm::ivec2(state_.shown->picture.size) : glm::ivec2(1);
        const tools::RunReport run{
            "window", scene.path.string(), animation_of(scene),        size, renderer.configuration(),
            reports_, renderer.report(),   environment_of(scene.world)};
        if (options_.out) write_picture(renderer);
        write_report(options_, run);
        write_graph(options_, renderer);
        check_energy(run.scene, run.state);
    });
}

void WindowSession::write_picture(Renderer& renderer) {
    tools::Capture capture(renderer, Window::functions(), window_.framebuffer_size());
    const std::filesystem::path path = numbered(*options_.out, std::max(frame_ - 1, 0));
    capture.write(path, whole_picture(renderer, capture, state_.document->scene.world,
                                      state_.document->interaction.viewer(), options_.samples));
    fmt::print("picture          {}\n", std::filesystem::absolute(path).string());
}

}  // namespace candela::sandbox
