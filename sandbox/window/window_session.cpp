#include "sandbox/window/window_session.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <candela/renderer.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/animation/script_writer.hpp"
#include "sandbox/candela_private/files.hpp"
#include "sandbox/candela_private/gl.hpp"
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/messages.hpp"
#include "sandbox/files/numbered_file.hpp"
#include "sandbox/files/output_file.hpp"
#include "sandbox/files/recent_files.hpp"
#include "sandbox/headless/capture.hpp"
#include "sandbox/headless/headless.hpp"
#include "sandbox/headless/report.hpp"
#include "sandbox/panels/controls.hpp"
#include "sandbox/panels/graph_panel.hpp"
#include "sandbox/panels/help_panel.hpp"
#include "sandbox/panels/open_panel.hpp"
#include "sandbox/panels/overlay.hpp"
#include "sandbox/panels/quality_panel.hpp"
#include "sandbox/panels/resource_view.hpp"
#include "sandbox/panels/scene_panel.hpp"
#include "sandbox/panels/status_line.hpp"
#include "sandbox/panels/view_panel.hpp"
#include "sandbox/panels/vpl_dots.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/document.hpp"
#include "sandbox/window/gui.hpp"
#include "sandbox/window/layout.hpp"
#include "sandbox/window/picture_writer.hpp"
#include "sandbox/window/render_thread.hpp"
#include "sandbox/window/scene_loader.hpp"
#include "sandbox/window/ui_log.hpp"
#include "sandbox/window/view_commands.hpp"

namespace candela::sandbox {

namespace {

/// Lines from the render thread.
class Lines {
 public:
    void add(std::string_view line) {
        const std::lock_guard lock(mutex_);
        lines_.emplace_back(line);
    }
    [[nodiscard]] std::vector<std::string> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(lines_, {});
    }

 private:
    std::mutex mutex_;
    std::vector<std::string> lines_;
};

class WindowSession {
 public:
    WindowSession(Window& window, const OpenScene& open, const Configuration& configuration,
                  ConfigWatch& watch, const Options& options, const MakeReference& make_reference)
        : window_(window),
          watch_(watch),
          options_(options),
          shader_saves_(options.shaders),
          gui_(window),
          reference_(make_reference ? make_reference(Window::wake) : nullptr) {
        state_.configuration = configuration;
        if (options.ui_log) log_.emplace(*options.ui_log);
        loader_.start(open, "the scene");
        thread_ = std::make_unique<RenderThread>(
            window.share(),
            RendererOptions{.shader_directory = options.shaders.value_or(std::filesystem::path()),
                            .log = [this](std::string_view line) { warnings_.add(line); }},
            Window::wake);
    }

    void run() {
        if (options_.frames) loader_.wait();
        while (!window_.should_close() && (!options_.frames || frame_ < *options_.frames)) step();
        window_.hide();
    }

    void write_results() {
        if (!document_ || (!options_.out && !options_.report && !options_.describe_graph)) return;
        thread_->run([this](Renderer& renderer) { write_results(renderer); });
    }

    /// Ends what runs in the background; false if that takes longer than a user should wait.
    [[nodiscard]] bool stop() {
        constexpr double patience = 0.2;  // seconds
        writer_.finish();
        loader_.cancel();
        return thread_->stop(patience) && loader_.is_idle();
    }

 private:
    using Seconds = std::chrono::duration<double>;

    void step() {
        const std::vector<InputEvent> events = window_.take_events(time_to_wait());
        const glm::ivec2 pixels = window_.framebuffer_size();
        const glm::ivec2 size = window_.size();
        hidden_ = std::min({pixels.x, pixels.y, size.x, size.y}) < 1;
        thread_->pause(hidden_);
        take_what_is_new();
        if (window_.take_exposed()) frames_to_draw_ = settling;
        if (hidden_) return;
        pixel_ratio_ = static_cast<float>(pixels.x) / static_cast<float>(size.x);
        layout_ = make_layout(size, gui_.scale(), {.panel = state_.panel, .status_height = status_height()});
        for (const InputEvent& event : events) take(event);
        if (document_) {
            move();
            animate();
            follow_reference();
            submit();
            if (options_.frames) show(thread_->wait_for(submitted_));
        }
        if (must_draw()) draw();
    }

    /// Panels need a few frames to settle after an event.
    static constexpr int settling = 3;
    /// Without a GPU, drawing the window takes time from the picture. So while only the pointer moves, it is
    /// drawn no more often than this, in seconds, unless there is a new picture.
    static constexpr double between_moves = 0.05;

    void take(const InputEvent& event) {
        if (event.kind == InputEvent::Kind::move) {
            pointer_moved_ = true;
        } else {
            frames_to_draw_ = settling;
        }
        // Dear ImGui knows only while it draws whether the pointer is over one of its windows now.
        if (event.kind == InputEvent::Kind::press) draw();
        if (!document_) {
            if (event.kind == InputEvent::Kind::key && event.code == GLFW_KEY_Q &&
                (event.modifiers & GLFW_MOD_CONTROL) != 0)
                window_.close();
            return;
        }
        const Tick before = document_->scene.world.revision();
        // A drag is likely to follow: no more work on the picture at rest, which the drag would have to wait
        // for.
        if (event.kind == InputEvent::Kind::press) thread_->hold_refinement(true);
        if (event.kind == InputEvent::Kind::release) thread_->hold_refinement(false);
        handle(event);
        if (document_->scene.world.revision() != before && !input_) input_ = Clock::now();
    }

    [[nodiscard]] bool must_draw() const {
        if (frames_to_draw_ > 0 || options_.frames || is_busy()) return true;
        return pointer_moved_ && Seconds(Clock::now() - last_draw_).count() >= between_moves;
    }

    [[nodiscard]] float status_height() const { return 22.0F * gui_.scale(); }

    /// Seconds that the window may sleep if no event arrives.
    [[nodiscard]] double time_to_wait() const {
        constexpr double while_busy = 0.1;  // turns the spinner, and sees what takes long
        constexpr double while_moving = 0.016;
        constexpr double idle = 0.2;  // looks for a saved configuration
        if (hidden_) return idle;
        if (options_.frames) return 0.0;
        if (frames_to_draw_ > 0 || advances_script()) return 0.0;
        if (document_ && document_->interaction.moving()) return while_moving;
        if (pointer_moved_) return between_moves;
        const bool busy = loader_.is_loading() || !shown_ || !shown_->settled || shown_->request < submitted_;
        return busy ? while_busy : idle;
    }

    [[nodiscard]] bool advances_script() const {
        return document_ && document_->is_playing() && shown_ && shown_->request == submitted_;
    }

    /// Opens another scene; the present one stays until that is loaded, and if it cannot be.
    void open(const std::filesystem::path& path) {
        const auto open_file = [path, import = import_options(options_)](const TellProgress& tell) mutable {
            import.progress = tell;
            Scene scene = load_scene(path, import);
            light_if_dark(scene);
            return scene;
        };
        loader_.start(open_file, path.filename().string());
    }

    void report_errors(std::vector<std::string> errors) {
        frames_to_draw_ = settling;
        for (const std::string& error : errors) print_message(error);
        state_.errors = std::move(errors);
    }

    void take_dropped_files() {
        for (const std::filesystem::path& file : window_.take_dropped_files()) {
            const std::string extension = lower_extension(file);
            if (extension == ".gltf" || extension == ".glb") {
                open(file);
            } else if (document_ && (extension == ".hdr" || extension == ".exr")) {
                take_sky(file);
            } else {
                report_errors({fmt::format("{}: is neither a scene (.gltf, .glb) nor a sky (.hdr, .exr)",
                                           file.string())});
            }
        }
    }

    void take_sky(const std::filesystem::path& file) {
        try {
            set_sky(document_->scene, file);
            frames_to_draw_ = settling;
        } catch (const std::runtime_error& error) {
            report_errors({error.what()});
        }
    }

    void save_picture(const std::filesystem::path& path) {
        if (!shown_) return;
        const FinishedTexture& picture = shown_->picture;
        writer_.write(path, picture.size, gl::read_texels(device_.gl(), picture.texture, picture.size));
    }

    void take_written_pictures() {
        for (PictureWriter::Result& result : writer_.take_results()) {
            if (!result.error.empty()) {
                report_errors({std::move(result.error)});
            } else {
                say_written(result.path);
            }
            frames_to_draw_ = settling;
        }
    }

    void take_what_is_new() {
        take_loaded_scene();
        take_dropped_files();
        take_written_pictures();
        take_saved_configuration();
        take_saved_shaders();
        for (std::string& line : warnings_.take()) {
            print_message(line);
            state_.warnings.push_back(std::move(line));
            frames_to_draw_ = settling;
        }
        if (std::optional<RenderedFrame> frame = thread_->take()) show(std::move(*frame));
    }

    void take_loaded_scene() {
        if (!loader_.is_ready()) return;
        frames_to_draw_ = settling;
        const glm::vec2 size = window_.size();
        const bool first = !document_;
        try {
            document_.emplace(loader_.take(), first ? options_.camera : std::nullopt, size.x / size.y);
        } catch (const std::runtime_error& error) {
            if (first) throw;
            return report_errors({error.what()});
        }
        cut_ = true;
        if (first) return say_warnings();
        state_.errors.clear();
        state_.notice.clear();
        state_.sequence = false;
        add_recent_file(recent_files_list(), std::filesystem::absolute(document_->scene.path));
        say_warnings();
    }

    void say_warnings() {
        state_.warnings = first_ten(document_->scene.warnings);
        window_.set_title(fmt::format("Candela - {}", document_->scene.path.filename().string()));
        for (const std::string& warning : state_.warnings) print_message(warning);
    }

    void take_saved_configuration() {
        const std::optional<ConfigurationResult> saved = watch_.poll(SaveWatch::Clock::now());
        if (!saved) return;
        report_errors(saved->errors);
        if (saved->configuration) state_.configuration = *saved->configuration;
    }

    void take_saved_shaders() {
        if (shader_saves_.has_saved(SaveWatch::Clock::now()) && shader_saves_.accept())
            thread_->reload_shaders();
    }

    void show(RenderedFrame frame) {
        frames_to_draw_ = std::max(frames_to_draw_, 1);
        for (const FrameReport& times : frame.times) costs_.add(times);
        if (options_.report) {
            reports_.insert(reports_.end(), std::make_move_iterator(frame.times.begin()),
                            std::make_move_iterator(frame.times.end()));
        }
        if (!frame.errors.empty() && frame.errors != state_.errors) {
            for (const std::string& error : frame.errors) print_message(error);
        }
        if (frame.request == submitted_ && (!frame.errors.empty() || from_renderer_)) {
            state_.errors = frame.errors;
            from_renderer_ = !frame.errors.empty();
        }
        if (frame.graph && frame.graph != graph_text_) {
            graph_text_ = frame.graph;
            graph_ = read_graph(*graph_text_);
        }
        if (!frame.report && shown_) frame.report = shown_->report;
        if (frame.input) answered_input_ = frame.input;
        const bool is_new = !shown_ || frame.request != shown_->request;
        shown_ = std::move(frame);
        if (shown_->radiance) measure();
        if (state_.sequence && is_new)
            save_picture(fmt::format("{}-{:04}.png", sequence_, sequence_frame_++));
    }

    void draw() {
        if (frames_to_draw_ > 0) --frames_to_draw_;
        pointer_moved_ = false;
        last_draw_ = Clock::now();
        gui_.begin_frame();
        draw_scene();
        draw_panel();
        draw_messages(state_.errors, state_.notice, layout_.scene);
        draw_help(state_.help, layout_.scene);
        if (const auto chosen = open_panel_.draw()) open(*chosen);
        draw_status_line(status(), layout_.status, ImGui::GetTime());
        gui_.end_frame();
        window_.swap();
        ++frame_;
        if (document_) submit();  // what the panel has changed
        write_log();
        answered_input_.reset();
    }

    void draw_scene() {
        const glm::vec2 size = window_.size();
        ImGui::GetBackgroundDrawList()->AddRectFilled({0.0F, 0.0F}, {size.x, size.y},
                                                      IM_COL32(24, 24, 26, 255));
        if (!shown_ || !document_) return;
        if (selection_.resource && shown_->inspection)
            return draw_resource(*selection_.resource, selection_.inspection, *shown_->inspection,
                                 shown_->elements, layout_.scene);
        const CompareMode mode = state_.comparison.mode;
        if (shown_->difference && mode == CompareMode::difference) {
            draw_picture(shown_->difference->texture, layout_.scene);
        } else {
            draw_picture(shown_->picture.texture, layout_.scene);
        }
        if (shown_->other && mode == CompareMode::divider)
            draw_picture(shown_->other->texture, layout_.scene, state_.comparison.divider, 1.0F);
        draw_overlay();
        draw_divider(state_.comparison, layout_.scene);
    }

    void draw_overlay() {
        const Interaction& interaction = document_->interaction;
        const Viewport viewport = make_viewport(document_->scene.world, interaction.viewer(),
                                                layout_.scene.size, layout_.scene.corner);
        const glm::vec3 eye(world_matrix(document_->scene.world, interaction.viewer())[3]);
        if (state_.vpls) {
            draw_vpl_dots(shown_->vpls, viewport, [&](const glm::vec3& point) {
                return !interaction.surfaces().blocked(eye, point);
            });
        }
        const Overlay overlay = interaction.overlay(viewport, !ImGui::GetIO().WantCaptureMouse);
        draw_lights(overlay.lights);
        if (overlay.gizmo) draw_gizmo(*overlay.gizmo, overlay.active);
    }

    void draw_panel() {
        if (layout_.panel.size.x < 1.0F) return;
        ImGui::SetNextWindowPos({layout_.panel.corner.x, layout_.panel.corner.y});
        ImGui::SetNextWindowSize({layout_.panel.size.x, layout_.panel.size.y});
        constexpr ImGuiWindowFlags docked = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings |
                                            ImGuiWindowFlags_NoBringToFrontOnFocus;
        if (ImGui::Begin("panel", nullptr, docked) && ImGui::BeginTabBar("tabs")) {
            ImGui::PushItemWidth(0.55F * ImGui::GetContentRegionAvail().x);
            draw_tabs();
            ImGui::PopItemWidth();
            ImGui::EndTabBar();
        }
        ImGui::End();
    }

    void draw_tabs() {
        const auto tab = [](const char* name, const char* tip) {
            const bool open = ImGui::BeginTabItem(name);
            note_control(name, tip);
            return open;
        };
        if (tab("Scene", "cameras, lights, objects, animation")) {
            if (document_) {
                for (const Action action :
                     draw_scene_panel(*document_, state_, shown_ ? shown_->report.get() : nullptr))
                    carry_out({action});
            }
            ImGui::EndTabItem();
        }
        if (tab("Quality", "how a frame is computed")) {
            draw_quality_panel(state_.configuration, shown_ ? shown_->quality : Quality{});
            ImGui::EndTabItem();
        }
        if (tab("Light", "what of the light is shown; comparisons")) {
            draw_view_panel(state_, reference_, costs_.frame().mean_ms);
            ImGui::EndTabItem();
        }
        if (tab("Graph", "what the frame graph does, and what it costs")) {
            draw_graph_panel(selection_, graph_, costs_);
            ImGui::EndTabItem();
        }
    }

    [[nodiscard]] bool is_busy() const { return !busy_words().empty(); }

    [[nodiscard]] std::string busy_words() const {
        constexpr Seconds noticeable(0.3);
        if (loader_.is_loading()) return loader_.words();
        const RenderStage stage = thread_->stage();
        if (stage == RenderStage::idle || thread_->stage_time() < noticeable) return "";
        if (stage == RenderStage::rendering) return "rendering";
        return "compiling shaders, placing virtual lights";
    }

    [[nodiscard]] Status status() const {
        Status status;
        status.busy = busy_words();
        status.frame_ms = costs_.frame().last_ms();
        status.mean_ms = costs_.frame().mean_ms;
        if (!shown_) return status;
        status.quality = shown_->quality;
        status.settled = is_settled();
        if (!shown_->report) return status;
        if (shown_->report->vpls) status.vpls = shown_->report->vpls->alive;
        status.refined = shown_->report->refined;
        const RefinementSettings& refinement = shown_->configuration.refinement;
        status.to_refine = refinement.enabled ? refinement.frames : 0;
        return status;
    }

    [[nodiscard]] bool is_settled() const {
        const bool playing = document_ && document_->is_playing();
        return shown_ && shown_->settled && shown_->request == submitted_ && !loader_.is_loading() &&
               !playing;
    }

    /// Flies, and records.
    void move() {
        const Clock::time_point now = Clock::now();
        const auto seconds = static_cast<float>(Seconds(now - std::exchange(last_step_, now)).count());
        Interaction& interaction = document_->interaction;
        interaction.unit = gui_.scale();
        const Tick before = document_->scene.world.revision();
        interaction.step(seconds, layout_.scene.size, layout_.scene.corner);
        if (document_->scene.world.revision() != before && !input_) input_ = now;
        if (document_->recorder)
            document_->recorder->record(document_->scene.world, Seconds(now.time_since_epoch()).count());
    }

    void animate() {
        if (shown_ && shown_->request < submitted_) return;
        if (document_->animate()) cut_ = true;
    }

    /// The reference is that of the scene at rest; while something moves, it waits.
    void follow_reference() {
        std::optional<ReferenceRequest> request;
        if (state_.reference && shown_) {
            request.emplace();
            request->world = document_->copy_of_world();
            request->camera = document_->interaction.viewer();
            request->size = picture_size();
            request->antialiased = state_.configuration.refinement.enabled;
        }
        reference_.follow(request);
        if (reference_.update()) measure();
        if (!state_.reference) state_.error.reset();
    }

    /// The error of the picture over the reference.
    void measure() {
        frames_to_draw_ = std::max(frames_to_draw_, 1);
        state_.error = shown_ && shown_->radiance ? reference_.error_of(*shown_->radiance) : std::nullopt;
    }

    [[nodiscard]] glm::uvec2 picture_size() const {
        return glm::max(glm::uvec2(layout_.scene.size * pixel_ratio_), 1U);
    }

    void handle(const InputEvent& event) {
        if (Gui::wants(event.kind)) return;
        const auto command = document_->interaction.handle(event, layout_.scene.size, layout_.scene.corner);
        if (command) carry_out(*command);
    }

    void carry_out(const Command& command) {
        frames_to_draw_ = settling;
        if (change_view(command, graph_, state_, selection_)) return;
        switch (command.action) {
            case Action::open_scene:
                return open_panel_.show(
                    {{"recent", recent_files(recent_files_list())}, {"shipped", shipped_scenes()}});
            case Action::save_scene:
                return attempt([&] { save_scene_file(); });
            case Action::save_configuration:
                return attempt([&] { save_configuration(); });
            case Action::record_drag:
                return attempt([&] { toggle_recording(); });
            case Action::screenshot:
                return save_picture(next_numbered_file(".png"));
            case Action::sequence:
                return toggle_sequence();
            case Action::full_screen:
                return window_.toggle_full_screen();
            case Action::cancel:
                return close_what_is_open();
            case Action::play_pause:
                if (document_->playback) document_->playback->toggle();
                return;
            case Action::step_frame:
                if (document_->playback) document_->playback->step();
                return;
            case Action::quit:
                return window_.close();
            default:
                return;  // by Interaction
        }
    }

    /// Reports what an action throws; it is then as if the action had not been tried.
    template <class F>
    void attempt(const F& action) {
        try {
            action();
        } catch (const std::runtime_error& error) {
            report_errors({error.what()});
        }
    }

    void close_what_is_open() {
        if (loader_.is_loading()) return loader_.cancel();
        if (open_panel_.is_shown()) return open_panel_.hide();
        state_.help = false;
        selection_.resource.reset();
        state_.errors.clear();
        state_.notice.clear();
    }

    void say_written(const std::filesystem::path& path) {
        state_.notice = fmt::format("wrote {}", std::filesystem::absolute(path).lexically_normal().string());
    }

    void save_scene_file() {
        const std::filesystem::path path = next_numbered_file(".gltf");
        const std::vector<Entity> of_app = {document_->interaction.viewer()};
        for (const std::string& line : save_scene(document_->scene.world, path, of_app)) warnings_.add(line);
        document_->interaction.history().mark_saved();
        say_written(path);
    }

    void save_configuration() {
        const std::filesystem::path path = next_numbered_file("-config.json");
        write_text(path, write_configuration(state_.configuration) + "\n");
        say_written(path);
    }

    void toggle_recording() {
        if (!document_->recorder) {
            if (!document_->interaction.selected)
                throw std::runtime_error("select what is to be recorded first");
            document_->recorder.emplace(document_->scene.world, *document_->interaction.selected);
            state_.notice = "recording the motion of the selection; Ctrl+R ends it";
            return;
        }
        const std::filesystem::path path = next_numbered_file("-animation.json");
        const Script script = document_->recorder->finish();
        document_->recorder.reset();
        save_script(script, document_->scene.path, path);
        say_written(path);
    }

    void toggle_sequence() {
        state_.sequence = !state_.sequence;
        sequence_ = next_numbered_file("").string();
        sequence_frame_ = 0;
        state_.notice =
            state_.sequence ? fmt::format("saving each new picture as {}-0000.png, ...", sequence_) : "";
    }

    /// Asks for a new picture if something has changed since the last request.
    void submit() {
        FrameRequest request{.world = document_->copy_of_world(),
                             .camera = document_->interaction.viewer(),
                             .size = picture_size(),
                             .configuration = state_.configuration,
                             .read_vpls = state_.vpls,
                             .read_radiance = state_.reference};
        if (selection_.resource) {
            request.inspection = selection_.inspection;
            request.inspection->resource = *selection_.resource;
        }
        if (state_.comparison.mode == CompareMode::difference) request.difference = state_.comparison.factor;
        if (state_.comparison.mode != CompareMode::off) {
            if (state_.comparison.with_reference) {
                request.reference = reference_.radiance();
            } else {
                request.other = state_.comparison.other;
            }
        }
        if (request != requested_) {
            requested_ = request;
            request.cut = cut_;
            request.input = std::exchange(input_, std::nullopt);
            submitted_ = thread_->submit(std::move(request));
        }
        cut_ = false;
    }

    void write_log() {
        if (!log_) return;
        UiRecord record;
        record.frame = frame_;
        record.time = ImGui::GetTime();
        record.submitted = submitted_;
        record.settled = is_settled();
        record.busy = busy_words();
        record.scene = layout_.scene;
        record.scale = gui_.scale();
        record.configuration = name_of(state_.configuration);
        record.show = to_string(state_.configuration.show);
        record.compare = state_.comparison.mode;
        record.view = selection_.resource;
        record.errors = state_.errors;
        record.controls = take_control_places();
        if (document_) record.undo = document_->interaction.history().undo_count();
        if (document_) record.redo = document_->interaction.history().redo_count();
        record.rel_mse = state_.error;
        if (shown_) record.picture = shown_->request;
        if (shown_ && shown_->report) record.refined = shown_->report->refined;
        if (answered_input_) record.latency = Seconds(Clock::now() - *answered_input_).count();
        if (document_) describe_document(record);
        log_->add(record);
    }

    void describe_document(UiRecord& record) const {
        const World& world = document_->scene.world;
        record.scene_file = document_->scene.path.string();
        record.eye = glm::vec3(world_matrix(world, document_->interaction.viewer())[3]);
        if (!document_->interaction.selected) return;
        record.selected = name_of(world, *document_->interaction.selected);
        record.position = glm::vec3(world_matrix(world, *document_->interaction.selected)[3]);
    }

    void write_results(Renderer& renderer) {
        const Configuration configuration = renderer.configuration();
        const Scene& scene = document_->scene;
        const glm::ivec2 size = shown_ ? glm::ivec2(shown_->picture.size) : glm::ivec2(1);
        const RunReport run{"window", scene.path.string(), animation_of(scene),        size, configuration,
                            reports_, renderer.report(),   environment_of(scene.world)};
        if (options_.out) write_picture(renderer, window_.framebuffer_size());
        write_documents(options_, run, renderer);
        check_energy(run.scene, run.state);
    }

    void write_picture(Renderer& renderer, glm::ivec2 size) {
        Capture capture(renderer, size);
        const std::filesystem::path path = numbered(*options_.out, std::max(frame_ - 1, 0));
        capture.write(path, whole_picture(renderer, capture, document_->scene.world,
                                          document_->interaction.viewer(), options_.samples));
        fmt::print("picture          {}\n", std::filesystem::absolute(path).string());
    }

    Window& window_;
    ConfigWatch& watch_;
    const Options& options_;
    SaveWatch shader_saves_;
    Gui gui_;
    gl::Device device_{Window::functions(), gl::DebugOutput::off};
    PictureWriter writer_{Window::wake};
    ReferenceView reference_;
    Lines warnings_;
    AppState state_;
    std::optional<UiLog> log_;
    SceneLoader loader_{Window::wake};
    std::optional<Document> document_;
    std::unique_ptr<RenderThread> thread_;

    FrameRequest requested_;
    std::uint64_t submitted_ = 0;
    std::optional<RenderedFrame> shown_;
    bool cut_ = false;            ///< the next picture shows something else, and not what moves on
    bool from_renderer_ = false;  ///< whether the shown errors are those of a frame
    std::optional<Clock::time_point> input_;           ///< the oldest that no request answers yet
    std::optional<Clock::time_point> answered_input_;  ///< by the picture that is shown for the first time

    PassCosts costs_;
    std::vector<FrameReport> reports_;
    std::shared_ptr<const std::string> graph_text_;
    GraphPicture graph_;
    GraphSelection selection_;
    OpenPanel open_panel_;
    std::string sequence_;    ///< beginning of the names of the files
    int sequence_frame_ = 0;  ///< number of the next one
    Layout layout_;
    float pixel_ratio_ = 0.0F;  ///< pixels of a window coordinate
    bool hidden_ = false;       ///< minimised, or without a single pixel
    int frame_ = 0;
    int frames_to_draw_ = settling;
    bool pointer_moved_ = false;
    Clock::time_point last_draw_;
    Clock::time_point last_step_ = Clock::now();
};

}  // namespace

void run_window(Window& window, const OpenScene& open, const Configuration& configuration, ConfigWatch& watch,
                const Options& options, const MakeReference& make_reference) {
    WindowSession session(window, open, configuration, watch, options, make_reference);
    session.run();
    session.write_results();
    if (session.stop()) return;
    std::fflush(nullptr);
    std::_Exit(EXIT_SUCCESS);
}

}  // namespace candela::sandbox
