#include "sandbox/window/render_thread.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "sandbox/candela_private/gl.hpp"
#include "sandbox/headless/canvas.hpp"

namespace candela::sandbox {

namespace {

FinishedTexture finished(const Canvas& canvas) {
    return {canvas.colour.name(), canvas.size()};
}

std::vector<VplDot> read_dots(gl::Device& device, const FrameResults& results) {
    std::vector<gpu::Vpl> vpls(results.vpl_count);
    if (vpls.empty()) return {};
    gl::read_buffer(device.gl(), results.vpl_buffer, std::as_writable_bytes(std::span(vpls)));
    std::vector<VplDot> dots;
    dots.reserve(vpls.size());
    for (const gpu::Vpl& vpl : vpls) {
        if (vpl.map == IN_SKY || vpl.normal == glm::vec3(0.0F)) continue;
        dots.push_back({vpl.position, vpl.normal, vpl.flux, vpl.area});
    }
    return dots;
}

std::shared_ptr<const Picture> read_radiance(gl::Device& device, const ResultTexture& result) {
    if (result.texture == 0) return nullptr;
    const std::vector<glm::vec4> texels = gl::read_texels(device.gl(), result.texture, result.size);
    return std::make_shared<const Picture>(
        flipped({glm::ivec2(result.size), {texels.begin(), texels.end()}}));
}

constexpr std::size_t no_slot = 3;

}  // namespace

/// What both threads use, under the mutex.
struct RenderThread::Shared {
    mutable std::mutex mutex;
    std::condition_variable to_worker;
    std::condition_variable to_window;

    std::optional<FrameRequest> pending;
    std::uint64_t submitted = 0;
    std::function<void(Renderer&)> job;
    bool job_done = false;
    std::exception_ptr job_error;
    bool paused = false;
    bool hold_refinement = false;
    bool reload = false;
    bool stop = false;

    std::optional<RenderedFrame> finished;
    std::size_t finished_slot = no_slot;
    std::size_t shown_slot = no_slot;
    bool ended = false;
    std::exception_ptr failure;
    RenderStage stage = RenderStage::compiling;
    Clock::time_point stage_start = Clock::now();
};

/// What only the render thread uses.
class RenderThread::Worker {
 public:
    Worker(Shared& shared, gl::GetProc functions, RendererOptions options, std::function<void()> notify)
        : shared_(shared),
          functions_(std::move(functions)),
          options_(std::move(options)),
          notify_(std::move(notify)),
          device_(functions_, gl::DebugOutput::off),
          renderer_(make_renderer()) {}

    void work() {
        std::unique_lock lock(shared_.mutex);
        while (true) {
            shared_.to_worker.wait(lock,
                                   [&] { return shared_.stop || shared_.job || has_frame_to_render(); });
            if (shared_.stop) return;
            if (shared_.job) {
                run_job(lock);
            } else {
                step(lock);
            }
        }
    }

 private:
    struct Slot {
        Canvas picture;
        Canvas other;
        Canvas difference;
        Canvas inspection;
    };

    [[nodiscard]] std::unique_ptr<Renderer> make_renderer() const {
        return std::make_unique<Renderer>(functions_, options_);
    }

    [[nodiscard]] bool has_frame_to_render() const {
        if (shared_.paused) return false;
        const bool refines = !settled_ && !shared_.hold_refinement;
        return shared_.pending || (request_ && (refines || shared_.reload));
    }

    void run_job(std::unique_lock<std::mutex>& lock) {
        const std::function<void(Renderer&)> job = std::exchange(shared_.job, nullptr);
        lock.unlock();
        std::exception_ptr error;
        try {
            job(*renderer_);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        shared_.job_error = error;
        shared_.job_done = true;
        shared_.to_window.notify_all();
    }

    void step(std::unique_lock<std::mutex>& lock) {
        const bool is_new = shared_.pending.has_value();
        if (is_new) {
            request_ = *std::exchange(shared_.pending, std::nullopt);
            number_ = shared_.submitted;
            errors_.clear();
        }
        const bool reload = std::exchange(shared_.reload, false);
        const std::size_t slot = free_slot();
        const bool compiles = reload || needs_compiling();
        enter(compiles ? RenderStage::compiling : RenderStage::rendering);
        lock.unlock();
        RenderedFrame frame = render(slots_.at(slot), reload);
        lock.lock();
        frame.input = is_new ? request_->input : std::nullopt;
        // A frame that is replaced before it was shown hands its input and its times on.
        if (shared_.finished) keep_from(*shared_.finished, frame);
        shared_.finished = std::move(frame);
        shared_.finished_slot = slot;
        enter(RenderStage::idle);
        shared_.to_window.notify_all();
        lock.unlock();
        notify_();
        lock.lock();
    }

    static void keep_from(RenderedFrame& replaced, RenderedFrame& frame) {
        if (replaced.input) frame.input = replaced.input;
        frame.times.insert(frame.times.begin(), std::make_move_iterator(replaced.times.begin()),
                           std::make_move_iterator(replaced.times.end()));
    }

    void enter(RenderStage stage) {
        shared_.stage = stage;
        shared_.stage_start = Clock::now();
    }

    [[nodiscard]] std::size_t free_slot() const {
        std::size_t slot = 0;
        while (slot == shared_.finished_slot || slot == shared_.shown_slot) ++slot;
        return slot;
    }

    /// Whether the next frame has another graph than the last one, whose shaders may have to be compiled.
    [[nodiscard]] bool needs_compiling() const {
        return !has_rendered_ || request_->configuration != renderer_->configuration() ||
               (request_->other && (!other_ || *request_->other != other_->configuration()));
    }

    RenderedFrame render(Slot& slot, bool reload) {
        RenderedFrame frame;
        try {
            if (reload) reload_error_ = replace_renderers();
            frame = render_request(slot);
        } catch (const std::exception& error) {
            errors_.emplace_back(error.what());
            // The slot may hold a part of a frame, or none.
            fit(slot.picture, request_->size);
            frame.picture = finished(slot.picture);
            settled_ = true;
        }
        frame.request = number_;
        frame.errors = errors_;
        if (reload_error_) frame.errors.push_back(*reload_error_);
        frame.settled = settled_;
        frame.configuration = renderer_->configuration();
        device_.finish();
        return frame;
    }

    /// Returns why not, and keeps the old renderers, if a shader does not compile.
    std::optional<std::string> replace_renderers() {
        try {
            std::unique_ptr<Renderer> renderer = make_renderer();
            const std::vector<std::string> errors = renderer->configure(renderer_->configuration());
            if (!errors.empty()) return errors.front();
            inspector_ = std::make_unique<ResourceInspector>(*renderer);
            renderer_ = std::move(renderer);
        } catch (const gl::ProgramError& error) {
            return error.what();
        }
        other_.reset();
        graph_.reset();
        return std::nullopt;
    }

    RenderedFrame render_request(Slot& slot) {
        Configuration wanted = request_->configuration;
        if (std::exchange(request_->cut, false)) wanted.frame_budget_ms = 0.0F;
        if (wanted != renderer_->configuration() && errors_.empty()) {
            errors_ = renderer_->configure(wanted);
            graph_.reset();
        }
        RenderedFrame frame;
        if (request_->inspection != inspector_->shown()) {
            for (const std::string& error : inspector_->show(request_->inspection)) errors_.push_back(error);
            graph_.reset();
        }
        draw(*renderer_, slot.picture);
        if (request_->reference) {
            draw_reference(slot.other);
            frame.other = finished(slot.other);
        } else if (request_->other) {
            draw_other(slot.other);
            frame.other = finished(slot.other);
        }
        if (request_->reference || !request_->other) other_.reset();
        if (request_->difference && frame.other && frame.other->size == request_->size)
            frame.difference = draw_difference_of(slot);
        if (request_->inspection) inspect(frame, slot.inspection);
        device_.finish();
        settled_ = renderer_->settled() && (!other_ || other_->settled());
        has_rendered_ = true;
        frame.picture = finished(slot.picture);
        frame.quality = renderer_->quality();
        frame.report = report();
        frame.times = renderer_->take_frames(true);
        frame.graph = graph();
        const FrameResults results = renderer_->results();
        if (request_->read_vpls) frame.vpls = read_dots(device_, results);
        if (request_->read_radiance) frame.radiance = read_radiance(device_, results.radiance);
        return frame;
    }

    /// Gives the canvas this size, in pixels.
    void fit(Canvas& canvas, glm::uvec2 size) {
        if (canvas.colour.name() == 0 || canvas.size() != size) canvas = Canvas(device_, size, Format::rgba8);
    }

    void draw(Renderer& renderer, Canvas& canvas) {
        fit(canvas, request_->size);
        const RenderView view{.camera = request_->camera,
                              .target = canvas.target(),
                              .keep = {.radiance = request_->read_radiance, .vpls = request_->read_vpls}};
        renderer.render(*request_->world, std::span(&view, 1));
    }

    void draw_other(Canvas& canvas) {
        if (!other_) other_ = make_renderer();
        for (const std::string& error : other_->configure(*request_->other)) errors_.push_back(error);
        draw(*other_, canvas);
    }

    /// Reading the report back takes time, so this is done a few times per second, and for the last frame.
    std::shared_ptr<const Report> report() {
        constexpr std::chrono::milliseconds interval(250);
        const Clock::time_point now = Clock::now();
        if (!report_ || settled_ || now - report_time_ > interval) {
            report_ = std::make_shared<const Report>(renderer_->report());
            report_time_ = now;
        }
        return report_;
    }

    FinishedTexture draw_difference_of(Slot& slot) {
        fit(slot.difference, request_->size);
        draw_difference(*renderer_, slot.picture.colour.name(), slot.other.colour.name(),
                        *request_->difference, slot.difference.target());
        return finished(slot.difference);
    }

    void inspect(RenderedFrame& frame, Canvas& canvas) {
        constexpr std::uint64_t most_elements = 256;
        frame.inspection = inspector_->result();
        if (frame.inspection->texture == 0) {
            frame.elements = inspector_->read_buffer(0, most_elements);
            return;
        }
        fit(canvas, frame.inspection->size);
        gl::copy_texels(device_.gl(), frame.inspection->texture, canvas.colour.name(),
                        frame.inspection->size);
        frame.inspection->texture = canvas.colour.name();
    }

    void draw_reference(Canvas& canvas) {
        const Picture& picture = *request_->reference;
        fit(canvas, picture.size);
        renderer_->tone_map(flipped(picture).pixels, canvas.target());
    }

    /// The description changes with the graph, which also depends on the scene.
    std::shared_ptr<const std::string> graph() {
        const auto& passes = renderer_->last_passes();
        std::vector<std::string> names;
        names.reserve(passes.size());
        for (const PassRecord& pass : passes) names.emplace_back(pass.name);
        if (!graph_ || names != graph_passes_)
            graph_ = std::make_shared<const std::string>(renderer_->describe(GraphFormat::json));
        graph_passes_ = std::move(names);
        return graph_;
    }

    Shared& shared_;
    gl::GetProc functions_;
    RendererOptions options_;
    std::function<void()> notify_;
    gl::Device device_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<ResourceInspector> inspector_ = std::make_unique<ResourceInspector>(*renderer_);
    std::unique_ptr<Renderer> other_;  ///< while a request has a second configuration
    std::array<Slot, 3> slots_;
    std::optional<FrameRequest> request_;
    std::uint64_t number_ = 0;
    std::vector<std::string> errors_;          ///< of the request
    std::optional<std::string> reload_error_;  ///< of the shaders that were read last
    bool settled_ = true;
    bool has_rendered_ = false;
    std::shared_ptr<const Report> report_;
    Clock::time_point report_time_;
    std::shared_ptr<const std::string> graph_;
    std::vector<std::string> graph_passes_;
};

RenderThread::RenderThread(std::unique_ptr<ThreadContext> context, RendererOptions options,
                           std::function<void()> notify)
    : shared_(std::make_unique<Shared>()), context_(std::move(context)) {
    thread_ = std::thread([this, options = std::move(options), notify = std::move(notify)]() mutable {
        context_->make_current();
        try {
            Worker(*shared_, context_->functions(), std::move(options), notify).work();
        } catch (...) {
            const std::lock_guard lock(shared_->mutex);
            shared_->failure = std::current_exception();
        }
        context_->release();
        {
            const std::lock_guard lock(shared_->mutex);
            shared_->ended = true;
        }
        shared_->to_window.notify_all();
        notify();
    });
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->stop = true;
    }
    shared_->to_worker.notify_all();
    thread_.join();
}

std::uint64_t RenderThread::submit(FrameRequest request) {
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(shared_->mutex);
        // A request that is replaced before it was rendered hands its input on.
        if (shared_->pending && shared_->pending->input) request.input = shared_->pending->input;
        shared_->pending = std::move(request);
        shared_->hold_refinement = false;
        number = ++shared_->submitted;
    }
    shared_->to_worker.notify_all();
    return number;
}

std::optional<RenderedFrame> RenderThread::take() {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->failure) std::rethrow_exception(shared_->failure);
    if (!shared_->finished) return std::nullopt;
    shared_->shown_slot = std::exchange(shared_->finished_slot, no_slot);
    return std::exchange(shared_->finished, std::nullopt);
}

RenderedFrame RenderThread::wait_for(std::uint64_t request) {
    {
        std::unique_lock lock(shared_->mutex);
        shared_->to_window.wait(lock, [&] {
            return shared_->ended || (shared_->finished && shared_->finished->request >= request);
        });
    }
    return take().value();
}

void RenderThread::pause(bool paused) {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->paused = paused;
    }
    shared_->to_worker.notify_all();
}

void RenderThread::hold_refinement(bool on) {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->hold_refinement = on;
    }
    shared_->to_worker.notify_all();
}

void RenderThread::run(const std::function<void(Renderer&)>& job) {
    std::unique_lock lock(shared_->mutex);
    shared_->job_done = false;
    shared_->job = job;
    shared_->to_worker.notify_all();
    shared_->to_window.wait(lock, [&] { return shared_->job_done || shared_->ended; });
    if (shared_->failure) std::rethrow_exception(shared_->failure);
    if (shared_->job_error) std::rethrow_exception(std::exchange(shared_->job_error, nullptr));
}

void RenderThread::reload_shaders() {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->reload = true;
    }
    shared_->to_worker.notify_all();
}

RenderStage RenderThread::stage() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->stage;
}

std::chrono::duration<double> RenderThread::stage_time() const {
    const std::lock_guard lock(shared_->mutex);
    return Clock::now() - shared_->stage_start;
}

bool RenderThread::stop(double seconds) {
    std::unique_lock lock(shared_->mutex);
    shared_->stop = true;
    shared_->to_worker.notify_all();
    return shared_->to_window.wait_for(lock, std::chrono::duration<double>(seconds),
                                       [&] { return shared_->ended; });
}

}  // namespace candela::sandbox
