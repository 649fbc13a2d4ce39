// What the session of a window does when the user has chosen it.

#include <filesystem>
#include <future>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <candela/tools/picture.hpp>
#include "sandbox/command_line/messages.hpp"
#include "sandbox/files/numbered_file.hpp"
#include "sandbox/files/recent_files.hpp"
#include "sandbox/scene/studio.hpp"
#include "sandbox/window/save_commands.hpp"
#include "sandbox/window/view_commands.hpp"
#include "sandbox/window/window_session.hpp"

namespace candela::sandbox {

void WindowSession::carry_out(const Command& command) {
    redraw_.changed();
    AppState& app = state_.app;
    if (change_view(command, state_.graph, app, state_.selection)) return;
    switch (command.action) {
        case Action::open_scene:
            gui_.move_focus();
            return open_panel_.show(
                {{"recent", recent_files(recent_files_list())}, {"shipped", shipped_scenes()}}, ".");
        case Action::save_scene:
            return attempt([&] { save_scene(); });
        case Action::save_configuration:
            return attempt([&] { app.notice = written(save_configuration(app.configuration)); });
        case Action::record_drag:
            return attempt([&] { app.notice = toggle_recording(*state_.document); });
        case Action::screenshot:
            return save_picture();
        case Action::full_screen:
            return window_.toggle_full_screen();
        case Action::cancel:
            return close_what_is_open();
        case Action::play_pause:
            return state_.document->toggle_playback();
        case Action::step_frame:
            return state_.document->step_playback();
        case Action::quit:
            return window_.close();
        default:
            return;  // by Interaction
    }
}

/// Opens another scene; the present one stays until that is loaded, and if it cannot be.
void WindowSession::open(const std::filesystem::path& path) {
    const auto open_file = [path, import = import_options(options_)](const TellProgress& tell) mutable {
        import.progress = tell;
        Scene scene = load_scene(path, import);
        light_if_dark(scene);
        return scene;
    };
    loader_.start(open_file, path.filename().string());
}

void WindowSession::close_what_is_open() {
    if (loader_.is_loading()) return loader_.cancel();
    if (open_panel_.is_shown()) return open_panel_.hide();
    state_.app.help = false;
    state_.selection.resource.reset();
    state_.app.errors.clear();
    state_.app.notice.clear();
}

void WindowSession::save_scene() {
    const SavedScene saved = save_document(*state_.document);
    for (const std::string& line : saved.warnings) warnings_.add(line);
    state_.app.notice = written(saved.path);
}

/// In another thread, so that the window does not wait for the compression. A picture before it is finished
/// first: their numbers follow from the files that are there.
void WindowSession::save_picture() {
    if (!state_.shown) return;
    if (saved_picture_.valid()) saved_picture_.wait();
    take_saved_picture();
    const FinishedTexture& picture = state_.shown->picture;
    saved_picture_ = std::async(
        std::launch::async,
        [size = picture.size, texels = gl::read_texels(device_.gl(), picture.texture, picture.size)] {
            std::filesystem::path path = next_numbered_file(".png");
            tools::write_png(path, size, tools::rgb_of_texels(size, texels));
            return path;
        });
}

void WindowSession::report_errors(std::vector<std::string> errors) {
    redraw_.changed();
    for (const std::string& error : errors) print_message(error);
    state_.app.errors = std::move(errors);
}

}  // namespace candela::sandbox
