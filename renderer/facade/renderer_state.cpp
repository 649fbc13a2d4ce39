#include "renderer/facade/renderer_state.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include <candela/error.hpp>
#include <candela/extension.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/scene/scene_error.hpp>
#include "renderer/facade/surfaces_check.hpp"
#include "renderer/facade/target_check.hpp"
#include "renderer/gl/host_state.hpp"
#include "renderer/passes/output/tone_map.hpp"

namespace candela {
namespace {

gl::ShaderLibrary shader_library(const std::filesystem::path& directory) {
    return directory.empty() ? gl::ShaderLibrary(gl::embedded_shaders()) : gl::ShaderLibrary(directory);
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Ends the timed frame even if a pass throws.
class TimedFrame {
 public:
    TimedFrame(gl::Timer& timer, std::uint64_t index) : timer_(timer) { timer_.begin_frame(index); }
    ~TimedFrame() { timer_.end_frame(); }
    TimedFrame(const TimedFrame&) = delete;
    TimedFrame& operator=(const TimedFrame&) = delete;

 private:
    gl::Timer& timer_;
};

FrameReport to_report(const std::vector<PassRecord>& passes, std::uint64_t index, double cpu_ms) {
    FrameReport report{.index = index, .cpu_ms = cpu_ms, .gpu_ms = 0.0, .waiting_surfels = 0, .passes = {}};
    for (const PassRecord& pass : passes) {
        const auto* const workload = std::any_cast<Workload>(pass.note);
        report.passes.push_back({.name = std::string(pass.name),
                                 .ran = pass.ran,
                                 .cpu_ms = pass.cpu_ms,
                                 .workload = workload ? *workload : Workload::other});
    }
    return report;
}

/// Whether both have the same graph and differ only in how many surfels may be traced in a frame.
bool differ_in_limit(Configuration a, const Configuration& b) {
    const bool both_have = a.vpls.updates > 0 && b.vpls.updates > 0;
    a.vpls.updates = b.vpls.updates;
    return both_have && a == b;
}

/// Whether both give the same picture before tone mapping while nothing moves.
bool same_radiance(Configuration a, const Configuration& b) {
    a.vpls.updates = b.vpls.updates;
    a.tone_map = b.tone_map;
    a.frame_budget_ms = b.frame_budget_ms;
    return a == b;
}

ViewShape shape_of(const RenderView& view) {
    return {.target = view.target.size,
            .host_surfaces = view.surfaces.has_value(),
            .host_material = view.surfaces && view.surfaces->material != 0,
            .keep = view.keep,
            .estimate_error = view.estimate_error};
}

constexpr const char* no_view = "a frame needs at least one view";

std::set<std::string, std::less<>> host_passes(const FrameHandles& frame) {
    std::set<std::string, std::less<>> names;
    for (const ViewHandles& view : frame.views) {
        names.insert(view.host_passes.begin(), view.host_passes.end());
    }
    return names;
}

/// Throws SceneError. `index`: of the receiver.
void require_possible(const Receiver& receiver, std::size_t index) {
    constexpr float rounding = 1e-3F;  // of normals that a host has stored with 10 bits or more
    const glm::vec3 position = receiver.position;
    if (!std::isfinite(position.x + position.y + position.z)) {
        throw SceneError(fmt::format("receiver {}: its position is not finite", index));
    }
    if (!(std::abs(glm::length(receiver.normal) - 1.0F) <= rounding)) {
        throw SceneError(fmt::format("receiver {}: its normal is not of unit length", index));
    }
}

}  // namespace

Renderer::State::State(const gl::GetProc& get_proc, const RendererOptions& options)
    : shuffle_(options.shuffle_passes),
      gpu_(get_proc, shader_library(options.shader_directory), options),
      backend_(gpu_.device()),
      runtime_(backend_) {
    install(declare(configuration_, shape_, {}), configuration_, shape_, {});
}

std::vector<std::string> Renderer::State::configure(const Configuration& configuration) {
    std::vector<std::string> errors = validate(configuration);
    if (!errors.empty() || (compiled_ && configuration == configuration_)) return errors;
    if (differ_in_limit(configuration, configuration_)) {
        configuration_ = configuration;
        return {};
    }
    return try_to(configuration, extensions_);
}

/// Throws gl::GlError if the driver has no room for the depth maps of so many VPLs.
void Renderer::State::require_room_for_maps(const Configuration& configuration) const {
    if (configuration.indirect && configuration.visibility.method == VplVisibility::maps) {
        (void)plan_vpl_atlas(configuration.visibility.map_resolution, configuration.vpls.count,
                             gpu_.device().limits());
    }
}

/// Switches to a configuration and extensions, or returns why that is not possible.
std::vector<std::string> Renderer::State::try_to(const Configuration& configuration,
                                                 std::vector<Extension> extensions) {
    try {
        require_room_for_maps(configuration);
        switch_to(configuration, expected_shape(), std::move(extensions));
    } catch (const std::exception& error) {
        return {error.what()};
    }
    return {};
}

std::vector<std::string> Renderer::State::extend(Extension extension) {
    if (!extension.declare) {
        return {fmt::format("the extension '{}' has no function `declare`", extension.name)};
    }
    std::vector<Extension> extensions = extensions_;
    const auto same = std::ranges::find(extensions, extension.name, &Extension::name);
    if (same != extensions.end()) {
        *same = std::move(extension);
    } else {
        extensions.push_back(std::move(extension));
    }
    return try_to(configuration_, std::move(extensions));
}

void Renderer::State::remove_extension(std::string_view name) {
    std::vector<Extension> extensions = extensions_;
    if (std::erase_if(extensions, [&](const Extension& extension) { return extension.name == name; }) > 0) {
        switch_to(configuration_, shape_, std::move(extensions));
    }
}

Renderer::State::Declared Renderer::State::declare(const Configuration& configuration,
                                                   const FrameShape& shape,
                                                   std::span<const Extension> extensions) {
    FrameGraph graph;
    FrameHandles frame = build_frame(graph, gpu_, configuration, shape, extensions);
    return {compile(std::move(graph), shuffle_).take(), std::move(frame)};
}

void Renderer::State::switch_to(const Configuration& configuration, const FrameShape& shape,
                                std::vector<Extension> extensions) {
    gpu_.programs().forget_requests();
    Declared declared = declare(configuration, shape, extensions);
    gpu_.programs().compile();
    install(std::move(declared), configuration, shape, std::move(extensions));
    compiled_ = true;
}

void Renderer::State::install(Declared declared, const Configuration& configuration, const FrameShape& shape,
                              std::vector<Extension> extensions) {
    runtime_.switch_to(std::move(declared.graph));
    frame_ = std::move(declared.frame);
    backend_.set_host_passes(host_passes(frame_));
    FrameShape shape_before = shape_;
    shape_before.turn = shape.turn;
    const bool same = shape == shape_before && same_radiance(configuration, configuration_);
    schedule_.change_graph(same);
    configuration_ = configuration;
    shape_ = shape;
    extensions_ = std::move(extensions);
    surfaces_bound_ = false;
    last_passes_.clear();
}

/// What the frames of these views of the world may be like, as far as that decides on their programs.
std::vector<FrameShape> Renderer::State::shapes_to_prepare(const Configuration& configuration,
                                                           const World& world,
                                                           std::span<const RenderView> views) {
    FrameShape shape{.views = {},
                     .quality = {},
                     .contents = contents_of(world, gpu_.scene_check(), configuration.vpls.count).of_frame,
                     .receivers = !receivers_.empty()};
    for (const RenderView& view : views) shape.views.push_back(shape_of(view));
    std::vector<FrameShape> shapes{shape};
    if (budget_ms(configuration) > 0.0) {
        shape.quality = lowest_quality;
        shapes.push_back(shape);
    }
    return shapes;
}

std::vector<std::string> Renderer::State::prepare(const Configuration& configuration, const World& world,
                                                  std::span<const RenderView> views,
                                                  const CompileProgress& progress) {
    gpu_.require_context();
    if (views.empty()) throw gl::GlError(no_view);
    std::vector<std::string> errors = validate(configuration);
    if (!errors.empty()) return errors;
    // Their passes are the host's: of each extension, only what it needs of the renderer counts.
    std::vector<Extension> extensions = extensions_;
    for (Extension& extension : extensions) extension.declare = [](FrameGraph&, ViewFrame&) {};
    const std::vector<FrameShape> shapes = shapes_to_prepare(configuration, world, views);
    prepared_ = shapes.front();
    gpu_.programs().forget_requests();
    try {
        require_room_for_maps(configuration);
        for (const FrameShape& shape : shapes) (void)declare(configuration, shape, extensions);
        gpu_.programs().compile(progress);
    } catch (const Error& error) {
        return {error.what()};
    }
    return {};
}

/// Throws gl::GlError if there are none, or if a target is not possible.
void Renderer::State::require_views(std::span<const RenderView> views) const {
    if (views.empty()) throw gl::GlError(no_view);
    const gl::Device& device = gpu_.device();
    for (const RenderView& view : views) {
        require_possible(device, view.target);
    }
}

void Renderer::State::set_views(std::span<const RenderView> views) {
    host_contents_.resize(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewHandles& handles = frame_.views[i];
        set_view(handles, views[i]);
        if (handles.host) {
            set_surfaces(*handles.host, *views[i].surfaces, host_contents_[i]);
        } else {
            host_contents_[i] = {};
        }
    }
    surfaces_bound_ = true;
}

void Renderer::State::set_view(const ViewHandles& handles, const RenderView& view) {
    const glm::uvec2 size = rendered_size(view.target.size, shape_.quality);
    runtime_.set(handles.request, ViewRequest{view.camera, size, view.jitter});
    runtime_.set(handles.target, view.target);
    runtime_.bind(handles.picture, view.target.framebuffer, {view.target.size, Format::rgba8});
}

/// Binds the host's textures, by which their content counts as new, unless it is known to be the same.
void Renderer::State::set_surfaces(const HostSurfaceInputs& inputs, const HostSurfaces& surfaces,
                                   HostContent& last) {
    const HostContent now{surfaces, gl::texture_size(gpu_.gl(), surfaces.depth)};
    const bool revised = surfaces.revision != 0 && now != last;
    const bool same = surfaces.revision != 0 && now == last;
    last = now;
    if (revised) schedule_.restart();
    runtime_.set(inputs.description, surfaces);
    if (same && surfaces_bound_) return;
    runtime_.bind(inputs.depth, surfaces.depth, {});
    runtime_.bind(inputs.normal, surfaces.normal, {});
    runtime_.bind(inputs.albedo, surfaces.albedo, {});
    if (inputs.material) runtime_.bind(*inputs.material, surfaces.material, {});
}

bool Renderer::State::render(const World& world, std::span<const RenderView> views,
                             const FrameOptions& options) {
    gpu_.require_context();
    require_views(views);
    const gl::HostState host_state(gpu_.gl(), gpu_.keeps_gl_state());
    for (const RenderView& view : views) {
        if (view.surfaces) require_readable(gpu_.device(), *view.surfaces);
    }
    FrameShape shape{
        .views = {}, .quality = {}, .contents = contents_now(world), .receivers = !receivers_.empty()};
    std::vector<ViewRequest> requests;
    std::vector<ViewRequest> without_jitter;
    for (const RenderView& view : views) {
        shape.views.push_back(shape_of(view));
        requests.push_back({view.camera, view.target.size, view.jitter});
        without_jitter.push_back({view.camera, view.target.size});
    }
    schedule_.begin(world, std::move(requests), configuration_, budget_ms(configuration_));
    shape.quality = schedule_.quality();
    shape.turn = schedule_.turn();
    if (!compiled_ || shape != shape_) switch_to(configuration_, shape, extensions_);
    set_views(views);
    if (frame_.refinement_clock) runtime_.set(*frame_.refinement_clock, schedule_.refinement_clock());
    if (frame_.update_clock) runtime_.set(*frame_.update_clock, schedule_.update_clock());
    if (frame_.map_clock) runtime_.set(*frame_.map_clock, schedule_.map_clock());
    if (frame_.guide_waits) runtime_.set(*frame_.guide_waits, schedule_.guide_waits());
    if (frame_.receivers) runtime_.set(*frame_.receivers, receivers_);
    if (frame_.epoch) runtime_.set(*frame_.epoch, epoch_);
    if (frame_.requests) runtime_.set(*frame_.requests, std::move(without_jitter));

    const auto start = std::chrono::steady_clock::now();
    const std::uint64_t index = next_frame_++;
    bool complete = false;
    {
        const TimedFrame timed(backend_.timer(), index);
        const FrameRecord& record = runtime_.run(world, Timing::on, options.wanted);
        last_passes_ = record.passes;
        complete = record.complete;
    }
    gpu_.log().tell_counts();
    if (!complete) {
        schedule_.abandon();
        return false;
    }
    schedule_.complete(outcome());
    received_ = static_cast<std::uint32_t>(receivers_.size());
    pending_.push_back({to_report(last_passes_, index, milliseconds_since(start)), quality(),
                        frame_.waiting_of_next.has_value()});
    pending_.back().report.waiting_surfels = schedule_.waiting();
    match_times(backend_.timer().collect());
    if (runtime_.verifies()) runtime_.verify(world);
    return true;
}

FrameOutcome Renderer::State::outcome() const {
    const auto value = [this](const auto& handle) { return runtime_.value(*handle); };
    FrameOutcome outcome{.has_guide = frame_.guide_waits.has_value(), .refines = refines()};
    if (frame_.waiting) outcome.waiting = value(frame_.waiting);
    if (frame_.refinement) outcome.refinement = value(frame_.refinement);
    if (frame_.waiting_of_next) outcome.next_waits = value(frame_.waiting_of_next).any();
    return outcome;
}

/// Whether another frame is to be added to the mean of a view.
bool Renderer::State::refines() const {
    constexpr std::uint32_t samples_of_direct_light = 64;
    const std::uint32_t frames = configuration_.refinement.frames;
    const std::uint32_t wanted = frame_.vpls ? frames : std::min(frames, samples_of_direct_light);
    return std::ranges::any_of(frame_.views, [&](const ViewHandles& view) {
        return view.averaged && runtime_.value(*view.averaged) + 1 < wanted;
    });
}

const ViewHandles& Renderer::State::view_handles(std::size_t view) const {
    if (view >= frame_.views.size()) {
        throw GraphError(fmt::format("the frame has no view {}, only {}", view, frame_.views.size()));
    }
    return frame_.views[view];
}

FrameResults Renderer::State::results(std::size_t view) const {
    const ViewHandles& handles = view_handles(view);
    const FrameParts& keep = shape_.views[view].keep;
    const ViewFrame& parts = handles.parts;
    const auto texture = [&](bool wanted, const std::optional<TextureHandle>& handle) {
        return wanted && handle ? ResultTexture{runtime_.object(*handle), parts.size} : ResultTexture{};
    };
    FrameResults results{.view = runtime_.value(handles.camera),
                         .depth = texture(keep.depth, parts.depth),
                         .normal = texture(keep.normal, parts.normal),
                         .albedo = texture(keep.albedo, parts.albedo),
                         .indirect = texture(keep.indirect, parts.indirect),
                         .radiance = texture(keep.radiance, parts.radiance)};
    if (keep.vpls && frame_.vpls) {
        const auto buffer = [&](const auto& handle, std::uint32_t count) {
            return handle ? ResultBuffer{runtime_.object(*handle), count} : ResultBuffer{};
        };
        const VplCounts& counts = runtime_.value(frame_.vpls->counts);
        results.traced_vpls = buffer(parts.traced_vpls, counts.traced);
        results.lit_surfels = buffer(parts.lit_surfels, counts.surfels);
        results.lit_emitters = buffer(parts.lit_emitters, counts.emitters);
        results.sky_patches = buffer(parts.sky_patches, counts.sky_patches);
    }
    return results;
}

void Renderer::State::set_receivers(std::vector<Receiver> receivers) {
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        require_possible(receivers[i], i);
    }
    receivers_ = std::move(receivers);
}

ResultBuffer Renderer::State::received_light_buffer() const {
    return frame_.received ? ResultBuffer{runtime_.object(*frame_.received), received_} : ResultBuffer{};
}

std::vector<glm::vec3> Renderer::State::received_light() const {
    if (!frame_.received) return std::vector<glm::vec3>(received_);
    gpu_.require_context();
    const auto elements = backend_.buffer(runtime_.object(*frame_.received)).download<glm::vec4>(received_);
    return {elements.begin(), elements.end()};
}

/// Frame budget in milliseconds; 0: no limit.
double Renderer::State::budget_ms(const Configuration& configuration) const {
    constexpr double on_hardware = 16.0;
    constexpr double on_software = 60.0;
    if (configuration.frame_budget_ms) return static_cast<double>(*configuration.frame_budget_ms);
    return gpu_.device().limits().software ? on_software : on_hardware;
}

FrameContents Renderer::State::contents_now(const World& world) {
    const std::array revisions{world.revision<MeshInstance>(), world.revision<Environment>()};
    const Tick transforms = world.revision<Transform>();
    const std::uint32_t vpls = configuration_.vpls.count;
    const bool may_differ = revisions != contents_revisions_ || vpls != contents_vpls_ ||
                            (contents_depend_on_transforms_ && transforms != contents_transforms_);
    if (!may_differ) return shape_.contents;
    const WorldContents contents = contents_of(world, gpu_.scene_check(), vpls);
    contents_revisions_ = revisions;
    contents_vpls_ = vpls;
    contents_transforms_ = transforms;
    contents_depend_on_transforms_ = contents.depend_on_transforms;
    return contents.of_frame;
}

void Renderer::State::learn_cost(const PendingFrame& frame) {
    if (frame.worked_ahead) return;
    const std::uint32_t configured =
        interleaving(configuration_.interleave, configuration_.vpls.count, shape_.views.front().target);
    schedule_.learn(cost_of(frame.report), frame.quality, configured, budget_ms(configuration_));
}

void Renderer::State::invalidate() {
    runtime_.invalidate();
    ++epoch_;
    schedule_.invalidate();
}

void Renderer::State::match_times(const std::vector<FrameTime>& times) {
    for (const FrameTime& time : times) {
        // A frame that threw or was abandoned has GPU times but no report.
        if (pending_.empty() || pending_.front().report.index != time.frame) continue;
        PendingFrame frame = std::move(pending_.front());
        pending_.pop_front();
        frame.report.gpu_ms = time.ms;
        for (const PassTime& pass : time.passes) {
            frame.report.passes[pass.pass].gpu_ms = pass.ms;
        }
        learn_cost(frame);
        arrived_.push_back(std::move(frame.report));
        if (arrived_.size() > kept_frames) arrived_.pop_front();
    }
}

std::vector<FrameReport> Renderer::State::take_frames(bool wait) {
    match_times(wait ? backend_.timer().finish() : backend_.timer().collect());
    std::vector<FrameReport> frames(std::make_move_iterator(arrived_.begin()),
                                    std::make_move_iterator(arrived_.end()));
    arrived_.clear();
    return frames;
}

void Renderer::State::tone_map(const std::vector<glm::vec3>& radiance, const Target& target) {
    gpu_.require_context();
    require_possible(gpu_.device(), target);
    const gl::HostState host_state(gpu_.gl(), gpu_.keeps_gl_state());
    gl::Texture texture(gpu_.device(), "averaged radiance", {target.size, Format::rgba32f});
    std::vector<glm::vec4> texels;
    texels.reserve(radiance.size());
    for (const glm::vec3& pixel : radiance) {
        texels.emplace_back(pixel, 1.0F);
    }
    texture.upload(std::as_bytes(std::span(texels)));
    texture.bind(UNIT_RADIANCE);
    candela::tone_map(gpu_, target, display_of(configuration_));
}

void Renderer::State::tone_map(GLuint texture, const Target& target) {
    gpu_.require_context();
    require_possible(gpu_.device(), target);
    require_texture(gpu_.device(), texture, "the radiance");
    const gl::HostState host_state(gpu_.gl(), gpu_.keeps_gl_state());
    gpu_.gl().BindTextureUnit(UNIT_RADIANCE, texture);
    gpu_.nearest().bind(UNIT_RADIANCE);
    candela::tone_map(gpu_, target, display_of(configuration_));
}

GraphDescription Renderer::State::description() const {
    return runtime_.describe();
}

}  // namespace candela
