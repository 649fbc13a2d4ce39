#include "sandbox/window_session.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <candela/renderer.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/capture.hpp"
#include "sandbox/gui.hpp"
#include "sandbox/headless.hpp"
#include "sandbox/interaction.hpp"
#include "sandbox/panel.hpp"
#include "sandbox/playback.hpp"
#include "sandbox/report.hpp"

namespace candela::sandbox {

namespace {

/// Compiling shaders takes a moment; the window says so meanwhile.
Renderer open_renderer(Gui& gui, Window& window, const Scene& scene, const RendererOptions& options) {
    show_words(gui, window,
               fmt::format("{}: compiling shaders, placing virtual lights", scene.path.filename().string()));
    return Renderer(Window::get_proc(), options);
}

class WindowSession {
 public:
    WindowSession(Window& window, Scene& scene, Entity camera, const Configuration& configuration,
                  ConfigWatch& watch, const Options& options)
        : window_(window),
          scene_(scene),
          watch_(watch),
          options_(options),
          gui_(window),
          renderer_(
              open_renderer(gui_, window, scene, {.log = [this](std::string_view line) { warn(line); }})),
          interaction_(scene.world, camera) {
        apply(renderer_, configuration);
        panel_.warnings.insert(panel_.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
        if (scene.animation) playback_.emplace(*scene.animation);
    }

    void run() {
        while (!window_.should_close() && (!options_.frames || frame_ < *options_.frames)) step();
    }

    void write_results() {
        if (!options_.out && !options_.report && !options_.describe_graph) return;
        collect(true);
        const Configuration configuration = renderer_.configuration();
        const RunReport run{
            "window", scene_.path.string(), animation_of(scene_),        pixels_, configuration,
            frames_,  renderer_.report(),   environment_of(scene_.world)};
        if (options_.out) write_picture(numbered(*options_.out, std::max(frame_ - 1, 0)));
        write_documents(options_, run, renderer_);
        check_energy(run.scene, run.state);
    }

 private:
    void step() {
        // While idle, the panels are still updated, slowly, because they show times.
        constexpr double idle_wait = 0.1;  // seconds
        const std::vector<InputEvent> events = window_.take_events(is_idle() ? idle_wait : 0.0);
        quiet_frames_ = events.empty() ? quiet_frames_ + 1 : 0;
        const glm::ivec2 pixels = window_.framebuffer_size();
        const glm::ivec2 size = window_.size();
        if (std::min({pixels.x, pixels.y, size.x, size.y}) < 1) return;
        pixels_ = pixels;

        gui_.begin_frame();
        for (const InputEvent& event : events) handle(event, size);
        panel_.draw(renderer_, scene_.world, interaction_, playback_ ? &*playback_ : nullptr,
                    frames_.empty() ? FrameReport{} : frames_.back());
        take_saved_configuration();
        animate();
        const Viewport viewport = make_viewport(scene_.world, interaction_.viewer(), size);
        draw_markers(light_markers(scene_.world), viewport, interaction_.selected);
        renderer_.render(scene_.world, interaction_.viewer(), {0, pixels_});
        gui_.end_frame();
        window_.swap();
        ++frame_;
        collect(false);
    }

    void take_saved_configuration() {
        const std::optional<ConfigurationResult> saved = watch_.poll(ConfigWatch::Clock::now());
        if (!saved) return;
        panel_.errors = saved->configuration ? renderer_.configure(*saved->configuration) : saved->errors;
        for (const std::string& error : panel_.errors) fmt::print(stderr, "candela: {}\n", error);
    }

    /// The viewer follows the animated camera that it started from, even if the user has moved away from it.
    void animate() {
        if (!playback_) return;
        const Entity camera = interaction_.camera();
        const glm::mat4 before = world_matrix(scene_.world, camera);
        playback_->advance(scene_.world);
        if (world_matrix(scene_.world, camera) != before) interaction_.look_from_camera(camera);
    }

    /// Panels need two frames to settle after an event. A run is not idle if a number of frames is requested,
    /// a script is playing, or the last frame did more than to show the same picture again.
    [[nodiscard]] bool is_idle() const {
        constexpr int settled = 3;
        const auto& passes = renderer_.last_passes();
        const auto ran =
            std::count_if(passes.begin(), passes.end(), [](const auto& pass) { return pass.ran; });
        const bool playing = playback_ && playback_->playing();
        return !options_.frames && !playing && ran <= 1 && quiet_frames_ > settled;
    }

    void handle(const InputEvent& event, glm::vec2 size) {
        if (gui_.wants(event.kind)) return;
        const bool key = event.kind == InputEvent::Kind::key;
        if (key && event.code == GLFW_KEY_ESCAPE) window_.close();
        if (key && event.code == GLFW_KEY_F1) panel_.visible = !panel_.visible;
        if (key && playback_) handle_playback(event.code);
        interaction_.handle(event, size);
    }

    void handle_playback(int key) {
        if (key == GLFW_KEY_SPACE) playback_->toggle();
        if (key == GLFW_KEY_PERIOD) playback_->step();
    }

    /// Takes the frame times that have arrived. Keeps all of them for a report, else only the last one.
    void collect(bool wait) {
        for (FrameReport& frame : renderer_.take_frames(wait)) {
            if (!options_.report) frames_.clear();
            frames_.push_back(std::move(frame));
        }
    }

    /// At full quality, whatever the frame budget of the window is.
    void write_picture(const std::filesystem::path& path) {
        Configuration whole = renderer_.configuration();
        whole.frame_budget_ms = 0.0F;
        apply(renderer_, whole);
        Capture capture(renderer_, pixels_);
        CaptureReport ignored;
        capture.write(path, capture.render(scene_.world, interaction_.viewer(), options_.samples, ignored));
        fmt::print("picture          {}\n", std::filesystem::absolute(path).string());
    }

    void warn(std::string_view line) {
        print_warning(line);
        panel_.warnings.emplace_back(line);
    }

    Window& window_;
    Scene& scene_;
    ConfigWatch& watch_;
    const Options& options_;
    Gui gui_;
    Panel panel_;
    Renderer renderer_;
    Interaction interaction_;
    std::optional<Playback> playback_;
    glm::ivec2 pixels_{1};
    int frame_ = 0;
    int quiet_frames_ = 0;
    std::vector<FrameReport> frames_;
};

}  // namespace

void run_window(Window& window, Scene& scene, Entity camera, const Configuration& configuration,
                ConfigWatch& watch, const Options& options) {
    WindowSession session(window, scene, camera, configuration, watch, options);
    session.run();
    session.write_results();
}

}  // namespace candela::sandbox
