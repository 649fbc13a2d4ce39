#include "sandbox/headless/headless.hpp"

#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/graph/describe.hpp>
#include <candela/tools/output_file.hpp>
#include "sandbox/animation/clips.hpp"
#include "sandbox/command_line/messages.hpp"
#include "sandbox/headless/report.hpp"
#include "sandbox/headless/stop_signals.hpp"
#include "sandbox/headless/update_budget.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

void require_none(const std::vector<std::string>& errors) {
    if (!errors.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(errors, "; ")));
}

}  // namespace

std::optional<fs::path> picture_path(const Options& options) {
    if (options.out || options.report || options.describe_graph) return options.out;
    return "candela.png";
}

int frames_of(const Options& options, const Scene& scene) {
    return options.frames.value_or(scene.animation ? scene.animation->script().frames : 1);
}

ExitStatus run_headless(const HeadlessContext& context, Scene& scene, Entity camera,
                        const Configuration& configuration, const Options& options, glm::ivec2 size) {
    Renderer renderer(context.get_proc(), {.shader_directory = options.shaders.value_or(fs::path()).string(),
                                           .log = print_message,
                                           .keeps_gl_state = false});
    // What is compiled is what the scene needs.
    const RenderView view{.camera = camera, .target = {.framebuffer = 0, .size = glm::uvec2(size)}};
    require_none(renderer.prepare(configuration, scene.world, {&view, 1}));
    tools::Capture capture(renderer, context.get_proc(), size);
    const std::optional<fs::path> out = picture_path(options);
    const int frames = frames_of(options, scene);

    tools::RunReport run{
        context.description(), scene.path.string(), animation_of(scene), size, configuration, {}, {}};
    ClipPlayback clips;
    UpdateBudget budget(options.update_budget.value_or(0.0));
    const StopSignals signals;
    const auto goes_on = [&] { return !signals.received(); };
    int frame = 0;
    for (bool is_last = false; !is_last; ++frame) {
        require_none(renderer.configure(budget.limited(configuration)));
        if (scene.animation) scene.animation->apply(scene.world, frame);
        clips.advance(scene.world, frame == 0 ? 0.0 : seconds_a_frame);
        tools::CaptureReport captured;
        const tools::Picture picture =
            capture.render(scene.world, camera, options.samples, captured, goes_on);
        budget.learn(captured.frame);
        captured.frame.index = static_cast<std::uint64_t>(frame);
        run.frames.push_back(std::move(captured.frame));
        run.state = std::move(captured.state);
        is_last = frame == frames - 1 || !goes_on();
        if (out && (is_last || is_numbered(*out))) capture.write(numbered(*out, frame), picture);
        check_finite(picture, frame);
    }
    run.environment = environment_of(scene.world);
    write_graph(options, renderer);
    if (options.report && run.state.vpls && goes_on()) {
        run.state.vpls->estimated_error = capture.estimate_error(scene.world, camera);
    }
    write_report(options, run);

    fmt::print("{} on {}, {}x{}\n", run.context, run.state.gl_renderer, size.x, size.y);
    fmt::print("{}", to_table(run.frames.back(), run.state));
    if (out) fmt::print("picture          {}\n", fs::absolute(numbered(*out, frame - 1)).string());
    check_energy(run.scene, run.state);
    const std::optional<int> signal = signals.received();
    return signal ? stopped_by(*signal) : success;
}

tools::Picture whole_picture(Renderer& renderer, tools::Capture& capture, const World& world, Entity camera,
                             int samples) {
    Configuration whole = renderer.configuration();
    whole.frame_budget_ms = 0.0F;
    whole.vpls.updates = 0;
    require_none(renderer.configure(whole));
    return capture.render(world, camera, samples);
}

void write_report(const Options& options, const tools::RunReport& report) {
    if (options.report) tools::write_text(*options.report, to_json(report));
}

void write_graph(const Options& options, const Renderer& renderer) {
    if (options.describe_graph) {
        tools::write_text(*options.describe_graph, describe_text(renderer.description()));
    }
}

}  // namespace candela::sandbox
