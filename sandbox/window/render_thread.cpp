#include "sandbox/window/render_thread.hpp"

#include <cstddef>
#include <iterator>
#include <utility>

#include "sandbox/window/frame_renderer.hpp"

namespace candela::sandbox {

namespace {

constexpr std::size_t no_slot = FrameRenderer::slots;

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

    /// Changes something, and lets the render thread see it.
    template <class F>
    void change(const F& what) {
        {
            const std::lock_guard lock(mutex);
            what();
        }
        to_worker.notify_all();
    }
};

/// What only the render thread uses.
class RenderThread::Worker {
 public:
    Worker(Shared& shared, gl::GetProc functions, RendererOptions options, std::function<void()> notify)
        : shared_(shared), notify_(std::move(notify)), frames_(std::move(functions), std::move(options)) {}

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
    [[nodiscard]] bool has_frame_to_render() const {
        if (shared_.paused) return false;
        const bool refines = !frames_.settled() && !shared_.hold_refinement;
        return shared_.pending || (frames_.has_request() && (refines || shared_.reload));
    }

    void run_job(std::unique_lock<std::mutex>& lock) {
        const std::function<void(Renderer&)> job = std::exchange(shared_.job, nullptr);
        lock.unlock();
        std::exception_ptr error;
        try {
            job(frames_.renderer());
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        shared_.job_error = error;
        shared_.job_done = true;
        shared_.to_window.notify_all();
    }

    void step(std::unique_lock<std::mutex>& lock) {
        if (shared_.pending) {
            running_ = *shared_.pending;
            if (!input_) input_ = running_.input;
            frames_.begin(*std::exchange(shared_.pending, std::nullopt), shared_.submitted);
        }
        const bool reload = std::exchange(shared_.reload, false);
        const std::size_t slot = free_slot();
        enter(reload || frames_.needs_compiling() ? RenderStage::compiling : RenderStage::rendering);
        lock.unlock();
        const Clock::time_point start = Clock::now();
        std::optional<RenderedFrame> frame =
            frames_.render(slot, reload, [&] { return is_wanted(Clock::now() - start); });
        lock.lock();
        enter(RenderStage::idle);
        if (frame) {
            given_up_ = 0;
            frame->input = std::exchange(input_, std::nullopt);
            finish(std::move(*frame), slot, lock);
        } else if (!frames_.refines()) {
            ++given_up_;
        }
    }

    void finish(RenderedFrame frame, std::size_t slot, std::unique_lock<std::mutex>& lock) {
        // A frame that is replaced before it was shown hands its input and its times on.
        if (shared_.finished) keep_from(*shared_.finished, frame);
        shared_.finished = std::move(frame);
        shared_.finished_slot = slot;
        shared_.to_window.notify_all();
        lock.unlock();
        notify_();
        lock.lock();
    }

    /// Whether the frame that is being rendered, since this time, is still worth it.
    [[nodiscard]] bool is_wanted(Clock::duration age) const {
        const std::lock_guard lock(shared_.mutex);
        const bool refines = frames_.refines();
        if (shared_.stop || (refines && (shared_.paused || shared_.hold_refinement))) return false;
        return !shared_.pending || !is_obsolete({.refines = refines, .age = age, .given_up = given_up_},
                                                running_, *shared_.pending);
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

    Shared& shared_;
    std::function<void()> notify_;
    FrameRenderer frames_;
    FrameRequest running_;                    // that frames_ renders
    std::optional<Clock::time_point> input_;  // the oldest that no frame has answered
    int given_up_ = 0;                        // frames in a row that were to answer a request
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
    shared_->change([&] { shared_->stop = true; });
    thread_.join();
}

std::uint64_t RenderThread::submit(FrameRequest request) {
    std::uint64_t number = 0;
    shared_->change([&] {
        // A request that is replaced before it was rendered hands its input on.
        if (shared_->pending && shared_->pending->input) request.input = shared_->pending->input;
        shared_->pending = std::move(request);
        shared_->hold_refinement = false;
        number = ++shared_->submitted;
    });
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
    shared_->change([&] { shared_->paused = paused; });
}

void RenderThread::hold_refinement(bool on) {
    shared_->change([&] { shared_->hold_refinement = on; });
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
    shared_->change([&] { shared_->reload = true; });
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
