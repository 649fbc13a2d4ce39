#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/graph/describe.hpp>
#include <candela/renderer.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/command_line/options.hpp"
#include "sandbox/files/config_watch.hpp"
#include "sandbox/files/save_watch.hpp"
#include "sandbox/panels/open_panel.hpp"
#include "sandbox/window/gui.hpp"
#include "sandbox/window/redraw.hpp"
#include "sandbox/window/reference_view.hpp"
#include "sandbox/window/render_thread.hpp"
#include "sandbox/window/scene_loader.hpp"
#include "sandbox/window/session_state.hpp"
#include "sandbox/window/ui_log.hpp"
#include "sandbox/window/window.hpp"

namespace candela::sandbox {

/// Lines from another thread.
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

/// What run_window does. Its functions stand in three files: window_session.cpp has the loop, in which each
/// step asks for a picture and draws the window; window_events.cpp takes what arrives; window_commands.cpp
/// does what the user has chosen.
class WindowSession {
 public:
    WindowSession(Window& window, const OpenScene& open, const Configuration& chosen, ConfigWatch& watch,
                  const Options& options, const MakeReference& make_reference);

    /// Until the window is closed, or the requested number of frames is done.
    void run();
    /// Writes what the options ask for.
    void write_results();
    /// Ends what runs in the background; false if that takes longer than a user should wait.
    [[nodiscard]] bool stop();

 private:
    // The loop.
    void step();
    void move();
    void animate();
    void follow_reference();
    void measure_error();
    void submit();
    void draw();
    void write_log();
    void note_progress();
    void write_picture(Renderer& renderer);
    [[nodiscard]] std::string busy_words() const;
    [[nodiscard]] double time_to_wait() const;
    [[nodiscard]] glm::uvec2 picture_size() const;

    // What arrives.
    void take(const InputEvent& event);
    void take_news();
    void take_loaded_scene();
    /// A scene, or a sky for the present one.
    void open_file(const std::filesystem::path& file);
    void take_saved_picture();
    void take_saved_configuration();
    void take_saved_shaders();
    void take_warnings();
    void show(RenderedFrame frame);
    void show_errors(const RenderedFrame& frame);

    // What the user has chosen.
    void carry_out(const Command& command);
    /// Reports what an action throws; it is then as if the action had not been tried.
    template <class F>
    void attempt(const F& action) {
        try {
            action();
        } catch (const std::runtime_error& error) {
            report_errors({error.what()});
        }
    }
    void open(const std::filesystem::path& path);
    void close_what_is_open();
    void save_scene();
    void save_picture();
    void report_errors(std::vector<std::string> errors);
    void announce_scene();

    Window& window_;
    ConfigWatch& watch_;
    const Options& options_;
    SaveWatch shader_saves_;
    Gui gui_;
    gl::Device device_{Window::functions(), gl::DebugOutput::off};
    std::future<std::filesystem::path> saved_picture_;  ///< that another thread is writing
    Lines warnings_;
    SessionState state_;
    std::optional<UiLog> log_;
    SceneLoader loader_{Window::wake};
    std::unique_ptr<RenderThread> thread_;

    FrameRequest requested_;
    bool cut_ = false;            ///< the next picture shows something else, and not what moves on
    bool from_renderer_ = false;  ///< whether the shown errors are those of a frame
    std::optional<Clock::time_point> input_;           ///< the oldest that no request answers yet
    std::optional<Clock::time_point> answered_input_;  ///< by the picture that is shown for the first time

    std::vector<FrameReport> reports_;
    std::shared_ptr<const GraphDescription> graph_;  // that state_ has
    OpenPanel open_panel_;
    float pixel_ratio_ = 0.0F;  ///< pixels of a window coordinate
    bool hidden_ = false;       ///< minimised, or without a single pixel
    int frame_ = 0;
    Redraw redraw_;
    Clock::time_point last_step_ = Clock::now();
    Clock::time_point last_animated_ = Clock::now();
};

}  // namespace candela::sandbox
