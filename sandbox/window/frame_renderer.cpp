#include "sandbox/window/frame_renderer.hpp"

#include <exception>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <candela/graph/describe.hpp>

namespace candela::sandbox {

namespace {

FinishedTexture finished(const tools::Canvas& canvas) {
    return {canvas.colour.name(), canvas.size()};
}

template <class T>
std::vector<T> read_structs(gl::Device& device, const ResultBuffer& result) {
    std::vector<T> structs(result.count);
    if (structs.empty()) return structs;
    gl::read_buffer(device.gl(), result.buffer, std::as_writable_bytes(std::span(structs)));
    return structs;
}

std::vector<VplDot> read_dots(gl::Device& device, const FrameResults& results) {
    std::vector<VplDot> dots;
    for (const auto& vpl : read_structs<gpu::TracedVpl>(device, results.traced_vpls)) {
        if (vpl.state == VPL_PLACED) dots.push_back({vpl.position, vpl.normal, vpl.flux, 0.0F});
    }
    for (const auto& surfel : read_structs<gpu::LitSurfel>(device, results.lit_surfels)) {
        dots.push_back({surfel.centre, surfel.normal, surfel.flux, surfel.area});
    }
    for (const auto& emitter : read_structs<gpu::LitEmitter>(device, results.lit_emitters)) {
        dots.push_back({emitter.position, emitter.normal, emitter.flux, emitter.area});
    }
    return dots;
}

std::shared_ptr<const tools::Picture> read_radiance(gl::Device& device, const ResultTexture& result) {
    if (result.texture == 0) return nullptr;
    const std::vector<glm::vec4> texels = gl::read_texels(device.gl(), result.texture, result.size);
    return std::make_shared<const tools::Picture>(
        tools::flipped({glm::ivec2(result.size), {texels.begin(), texels.end()}}));
}

}  // namespace

FrameRenderer::FrameRenderer(gl::GetProc functions, RendererOptions options)
    : functions_(std::move(functions)),
      options_(std::move(options)),
      device_(functions_, gl::DebugOutput::off),
      renderer_(make_renderer()) {}

std::unique_ptr<Renderer> FrameRenderer::make_renderer() const {
    return std::make_unique<Renderer>(functions_, options_);
}

void FrameRenderer::begin(FrameRequest request, std::uint64_t number) {
    const bool same_picture = request_ && request.world == request_->world &&
                              request.camera == request_->camera && request.size == request_->size &&
                              request.configuration == request_->configuration;
    if (!same_picture) noise_.reset();
    request_ = std::move(request);
    number_ = number;
    refines_ = false;
    settled_ = false;
    errors_.clear();
    if (budget_.budget_ms() != request_->update_budget_ms) budget_ = UpdateBudget(request_->update_budget_ms);
}

/// Limits of surfels may differ: the graph stays.
bool FrameRenderer::needs_compiling() const {
    Configuration wanted = budget_.limited(request_->configuration);
    const Configuration& now = renderer_->configuration();
    if (wanted.vpls.updates > 0 && now.vpls.updates > 0) wanted.vpls.updates = now.vpls.updates;
    return !has_rendered_ || wanted != now ||
           (request_->other && (!other_ || *request_->other != other_->configuration()));
}

std::optional<RenderedFrame> FrameRenderer::render(std::size_t slot_index, bool reload,
                                                   const std::function<bool()>& wanted) {
    // A driver may take work in long before it does it. Where frames take long, it is waited for: only then
    // is little done for a frame that is given up, and the window, which draws with the same driver, never
    // waits for more than a pass.
    constexpr double long_time = 0.04;  // seconds
    const Clock::time_point start = Clock::now();
    const bool refines_slowly = refines_ && last_ && last_->seconds > long_time;
    const FrameOptions options{.wanted = [&, start] {
        const std::chrono::duration<double> age = Clock::now() - start;
        if (refines_slowly || age.count() > long_time) device_.finish();
        return wanted();
    }};
    Slot& slot = slots_.at(slot_index);
    RenderedFrame frame;
    try {
        if (reload) reload_error_ = replace_renderers();
        std::optional<RenderedFrame> rendered = render_request(slot, options);
        if (!rendered) return std::nullopt;
        frame = std::move(*rendered);
    } catch (const std::exception& error) {
        errors_.emplace_back(error.what());
        // The slot may hold a part of a frame, or none.
        fit(slot.picture, request_->size);
        frame.picture = finished(slot.picture);
        settled_ = true;
    }
    refines_ = true;
    frame.request = number_;
    frame.errors = errors_;
    if (reload_error_) frame.errors.push_back(*reload_error_);
    frame.settled = settled_;
    frame.configuration = renderer_->configuration();
    if (request_->configuration.vpls.updates == 0) frame.configuration.vpls.updates = 0;
    device_.finish();
    return frame;
}

/// Returns why not, and keeps the old renderers, if a shader does not compile.
std::optional<std::string> FrameRenderer::replace_renderers() {
    try {
        std::unique_ptr<Renderer> renderer = make_renderer();
        const std::vector<std::string> errors = configure_new(*renderer, renderer_->configuration());
        if (!errors.empty()) return errors.front();
        inspector_ = std::make_unique<ResourceInspector>(*renderer);
        renderer_ = std::move(renderer);
    } catch (const gl::ProgramError& error) {
        return error.what();
    }
    other_.reset();
    graph_.reset();
    noise_.reset();
    return std::nullopt;
}

/// Nothing if the frame is not wanted any more.
std::optional<RenderedFrame> FrameRenderer::render_request(Slot& slot, const FrameOptions& options) {
    const Clock::time_point start = Clock::now();
    Configuration wanted = budget_.limited(request_->configuration);
    if (request_->cut && !refines_) wanted.frame_budget_ms = 0.0F;
    size_ = refines_ || request_->whole ? request_->size : first_size(request_->size, last_);
    if (wanted != renderer_->configuration() && errors_.empty()) {
        if (needs_compiling()) graph_.reset();
        errors_ = has_rendered_ ? renderer_->configure(wanted) : configure_new(*renderer_, wanted);
    }
    RenderedFrame frame;
    if (request_->inspection != inspector_->shown()) {
        for (const std::string& error : inspector_->show(request_->inspection)) errors_.push_back(error);
        graph_.reset();
    }
    if (!draw(*renderer_, slot.picture, options) || !draw_second(frame, slot, options)) return std::nullopt;
    if (request_->inspection) inspect(frame, slot.inspection);
    device_.finish();
    settled_ = size_ == request_->size && renderer_->settled() && (!other_ || other_->settled());
    has_rendered_ = true;
    last_ = FinishedFrame{request_->size, size_, std::chrono::duration<double>(Clock::now() - start).count()};
    frame.picture = finished(slot.picture);
    frame.quality = renderer_->quality();
    frame.quality.scale *= static_cast<float>(size_.x) / static_cast<float>(request_->size.x);
    frame.report = report();
    frame.times = renderer_->take_frames(true);
    for (const FrameReport& times : frame.times) budget_.learn(times);
    frame.graph = graph();
    const FrameResults results = renderer_->results();
    estimate_noise(results.radiance);
    frame.noise = noise_.value();
    frame.probed = probe(slot.picture, results.radiance);
    settled_ |= is_quiet();
    if (request_->read_vpls) frame.vpls = read_dots(device_, results);
    if (request_->read_radiance) frame.radiance = read_radiance(device_, results.radiance);
    return frame;
}

/// The picture to compare with. False if the frame is not wanted any more.
bool FrameRenderer::draw_second(RenderedFrame& frame, Slot& slot, const FrameOptions& options) {
    if (request_->reference || !request_->other) other_.reset();
    if (request_->reference) {
        draw_reference(slot.other);
    } else if (request_->other) {
        if (!draw_other(slot.other, options)) return false;
    } else {
        return true;
    }
    frame.other = finished(slot.other);
    if (request_->difference && frame.other->size == size_) frame.difference = draw_difference_of(slot);
    return true;
}

/// Gives the canvas this size, in pixels.
void FrameRenderer::fit(tools::Canvas& canvas, glm::uvec2 size) {
    if (canvas.colour.name() == 0 || canvas.size() != size)
        canvas = tools::Canvas(device_, size, Format::rgba8);
}

RenderView FrameRenderer::view_on(const Target& target) const {
    return {.camera = request_->camera,
            .target = target,
            .keep = {.radiance = request_->read_radiance || request_->probe || estimates_noise(),
                     .vpls = request_->read_vpls},
            .estimate_error = request_->estimate_error};
}

/// Before its first frame, a renderer compiles what the world needs, and nothing else.
std::vector<std::string> FrameRenderer::configure_new(Renderer& renderer, const Configuration& wanted) const {
    const RenderView view = view_on({.framebuffer = 0, .size = request_->size});
    std::vector<std::string> errors = renderer.prepare(wanted, *request_->world, {&view, 1});
    return errors.empty() ? renderer.configure(wanted) : errors;
}

bool FrameRenderer::draw(Renderer& renderer, tools::Canvas& canvas, const FrameOptions& options) {
    fit(canvas, size_);
    const RenderView view = view_on(canvas.target());
    return renderer.render(*request_->world, std::span(&view, 1), options);
}

bool FrameRenderer::draw_other(tools::Canvas& canvas, const FrameOptions& options) {
    const bool is_new = !other_;
    if (is_new) other_ = make_renderer();
    for (const std::string& error :
         is_new ? configure_new(*other_, *request_->other) : other_->configure(*request_->other)) {
        errors_.push_back(error);
    }
    return draw(*other_, canvas, options);
}

/// Reading the report back takes time, so this is done a few times per second, and for the last frame.
std::shared_ptr<const Report> FrameRenderer::report() {
    constexpr std::chrono::milliseconds interval(250);
    const Clock::time_point now = Clock::now();
    if (!report_ || settled_ || now - report_time_ > interval) {
        report_ = std::make_shared<const Report>(renderer_->report());
        report_time_ = now;
    }
    return report_;
}

bool FrameRenderer::estimates_noise() const {
    return request_->noise_limit > 0.0 && request_->configuration.refinement.enabled;
}

/// Not after a few frames: their samples leave steps at edges, which are few pixels, and they have few sets
/// of surfels.
bool FrameRenderer::is_quiet() const {
    constexpr std::uint32_t least = 32;
    return !other_ && noise_.value() && *noise_.value() <= request_->noise_limit && report_->refined >= least;
}

/// With the frames whose number is known: those with a new report.
void FrameRenderer::estimate_noise(const ResultTexture& radiance) {
    if (!estimates_noise() || radiance.texture == 0) return noise_.reset();
    if (noise_time_ == report_time_) return;
    noise_time_ = report_time_;
    const bool is_whole = size_ == request_->size && (!report_->vpls || report_->vpls->waiting == 0);
    if (!is_whole || !noise_.wants(report_->refined)) return;
    noise_.add(report_->refined, gl::read_texels(device_.gl(), radiance.texture, radiance.size));
}

std::optional<ProbedPixel> FrameRenderer::probe(const tools::Canvas& picture, const ResultTexture& radiance) {
    if (!request_->probe || radiance.texture == 0) return std::nullopt;
    const glm::uvec2 at = glm::min(*request_->probe, request_->size - 1U);
    const auto texel = [&](std::uint32_t texture) {
        const glm::uvec2 drawn = at * size_ / request_->size;  // the picture may be smaller
        return glm::vec3(gl::read_texels(device_.gl(), texture, glm::uvec2(1), drawn).front());
    };
    return ProbedPixel{at, texel(radiance.texture), texel(picture.colour.name())};
}

FinishedTexture FrameRenderer::draw_difference_of(Slot& slot) {
    fit(slot.difference, size_);
    draw_difference(*renderer_, slot.picture.colour.name(), slot.other.colour.name(), *request_->difference,
                    slot.difference.target());
    return finished(slot.difference);
}

void FrameRenderer::inspect(RenderedFrame& frame, tools::Canvas& canvas) {
    constexpr std::uint64_t most_elements = 256;
    frame.inspection = inspector_->result();
    if (frame.inspection->texture == 0) {
        frame.elements = inspector_->read_buffer(0, most_elements);
        return;
    }
    fit(canvas, frame.inspection->size);
    gl::copy_texels(device_.gl(), frame.inspection->texture, canvas.colour.name(), frame.inspection->size);
    frame.inspection->texture = canvas.colour.name();
}

void FrameRenderer::draw_reference(tools::Canvas& canvas) {
    const tools::Picture& picture = *request_->reference;
    fit(canvas, picture.size);
    renderer_->tone_map(tools::flipped(picture).pixels, canvas.target());
}

/// The description changes with the graph, which also depends on the scene, and with the sizes that resources
/// have, which are asked for as often as the report.
std::shared_ptr<const GraphDescription> FrameRenderer::graph() {
    const auto& passes = renderer_->last_passes();
    std::vector<std::string> names;
    names.reserve(passes.size());
    for (const PassRecord& pass : passes) names.emplace_back(pass.name);
    if (!graph_ || names != graph_passes_ || graph_time_ != report_time_) {
        graph_time_ = report_time_;
        graph_ = std::make_shared<const GraphDescription>(renderer_->description());
    }
    graph_passes_ = std::move(names);
    return graph_;
}

}  // namespace candela::sandbox
