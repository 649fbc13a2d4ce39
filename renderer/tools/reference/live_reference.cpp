#include <candela/tools/live_reference.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <iterator>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <glm/common.hpp>

#include "renderer/tools/reference/path_tracer.hpp"

namespace candela::reference {

namespace {

using tools::Picture;
using tools::ReferencePicture;
using tools::ReferenceRequest;
using Clock = std::chrono::steady_clock;

// The fewest that the tracer takes: pictures come soon and often.
constexpr std::uint32_t samples_of_pass = 2;
// The previews have this many times fewer pixels along each side.
constexpr std::array<std::uint32_t, 2> preview_scales{4, 2};
// Other threads of the app get the processor whenever they need it. A thread that always needs it leaves
// about a tenth of its core.
constexpr int niceness = 10;

unsigned threads_of(const ReferenceRequest& request) {
    return request.threads > 0 ? request.threads : std::max(std::thread::hardware_concurrency() / 2, 1U);
}

/// Where pass `index` looks, from the pixels' centres: the first pass at the centre, the others evenly spread
/// over the pixel (the R2 sequence: Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences",
/// 2018).
glm::dvec2 offset_of(std::uint32_t index) {
    return glm::fract(0.5 + static_cast<double>(index) * glm::dvec2(0.7548776662466927, 0.5698402909980532)) -
           0.5;
}

/// Each pixel repeated.
Picture enlarged(const Picture& picture, glm::ivec2 size) {
    Picture large{size, {}};
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::ivec2 from = glm::ivec2(x, y) * picture.size / size;
            const int index = from.y * picture.size.x + from.x;
            large.pixels.push_back(picture.pixels[static_cast<std::size_t>(index)]);
        }
    }
    return large;
}

/// The mean of passes with the same number of samples.
struct Mean {
    Picture picture;
    std::uint32_t passes = 0;

    void add(const Picture& pass) {
        ++passes;
        if (passes == 1) picture = pass;
        const float share = 1.0F / static_cast<float>(passes);
        for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
            picture.pixels[i] += share * (pass.pixels[i] - picture.pixels[i]);
        }
    }
};

/// The mean of passes. Even and odd ones have different seeds: two independent estimates of the same picture.
class Passes {
 public:
    void add(const Estimate& pass) {
        halves_[count() % 2].add(total(pass));
        hit_.resize(pass.hit.size(), 0);
        std::ranges::transform(hit_, pass.hit, hit_.begin(), std::bit_or<std::uint8_t>());
    }

    [[nodiscard]] std::uint32_t count() const { return halves_[0].passes + halves_[1].passes; }

    [[nodiscard]] ReferencePicture result() const {
        ReferencePicture result{
            .radiance = halves_[0].picture, .hit = hit_, .samples = samples_of_pass * count(), .noise = {}};
        const float share = static_cast<float>(halves_[1].passes) / static_cast<float>(count());
        for (std::size_t i = 0; i < halves_[1].picture.pixels.size(); ++i) {
            result.radiance.pixels[i] += share * (halves_[1].picture.pixels[i] - result.radiance.pixels[i]);
        }
        result.noise = noise(result.radiance);
        return result;
    }

 private:
    /// With passes of variance v, half A of a passes and half B of b passes differ by (a + b) / ab · v in the
    /// mean square. A differs from the mean of all by b / (a + b) of that difference: by b / (a (a + b)) · v
    /// in the mean square, which is b / a times the variance of the mean of all, v / (a + b).
    [[nodiscard]] std::optional<double> noise(const Picture& mean) const {
        const auto& [a, b] = halves_;
        const bool any_hit = std::ranges::count(hit_, 0) < std::ssize(hit_);
        if (b.passes == 0 || !any_hit) return std::nullopt;
        return relative_mse(a.picture, mean, hit_) * a.passes / b.passes;
    }

    std::array<Mean, 2> halves_;
    tools::Mask hit_;
};

/// The reference on a thread that waits for requests.
class TracedReference final : public tools::LiveReference {
 public:
    explicit TracedReference(std::function<void()> notify) : notify_(std::move(notify)) {
        worker_ = std::jthread([this](const std::stop_token& end) { work(end); });
    }
    TracedReference(const TracedReference&) = delete;
    TracedReference& operator=(const TracedReference&) = delete;
    ~TracedReference() override { stop(); }

    void start(ReferenceRequest request) override { replace(std::move(request)); }
    void stop() override { replace(std::nullopt); }

    std::optional<ReferencePicture> newest() override {
        const std::lock_guard lock(mutex_);
        return std::exchange(newest_, std::nullopt);
    }

    [[nodiscard]] std::string fault() const override {
        const std::lock_guard lock(mutex_);
        return fault_;
    }

 private:
    void replace(std::optional<ReferenceRequest> request) {
        {
            const std::lock_guard lock(mutex_);
            running_.request_stop();
            running_ = std::stop_source();
            waiting_ = std::move(request);
            newest_.reset();
            fault_.clear();
        }
        changed_.notify_one();
    }

    void work(const std::stop_token& end) {
        ::setpriority(PRIO_PROCESS, 0, niceness);  // on Linux: of this thread, and of those that it starts
        while (true) {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, end, [this] { return waiting_.has_value(); })) return;
            const ReferenceRequest request = *std::exchange(waiting_, std::nullopt);
            const std::stop_token stop = running_.get_token();
            lock.unlock();
            run(request, stop);
        }
    }

    void run(const ReferenceRequest& request, const std::stop_token& stop) {
        try {
            refine(request, stop);
        } catch (const std::exception& error) {
            publish(stop, [&] { fault_ = error.what(); });
        }
    }

    void refine(const ReferenceRequest& request, const std::stop_token& stop) {
        const Clock::time_point began = Clock::now();
        const auto show = [&](ReferencePicture picture) {
            picture.seconds = std::chrono::duration<double>(Clock::now() - began).count();
            publish(stop, [&] { newest_ = std::move(picture); });
        };
        const Scene scene(*request.world);
        Settings settings{.samples = samples_of_pass, .threads = threads_of(request)};
        for (const std::uint32_t scale : preview_scales) {
            settings.size = (request.size + scale - 1U) / scale;
            const Picture preview = total(trace(scene, request.camera, settings, stop));
            show({.radiance = enlarged(preview, request.size), .hit = {}, .noise = {}});
        }
        settings.size = request.size;
        for (Passes passes; passes.count() * samples_of_pass < request.samples && !stop.stop_requested();) {
            settings.seed = passes.count() % 2;
            settings.first_sample = passes.count() / 2 * samples_of_pass;
            if (request.antialiased) settings.offset = offset_of(passes.count());
            passes.add(trace(scene, request.camera, settings, stop));
            show(passes.result());
        }
    }

    /// Calls `change` under the lock, and tells the app, unless the work was stopped.
    template <typename Change>
    void publish(const std::stop_token& stop, Change change) {
        {
            const std::lock_guard lock(mutex_);
            if (stop.stop_requested()) return;
            change();
        }
        if (notify_) notify_();
    }

    std::function<void()> notify_;
    mutable std::mutex mutex_;  ///< of the following members
    std::stop_source running_;  ///< of the request that runs or waits
    std::optional<ReferenceRequest> waiting_;
    std::optional<ReferencePicture> newest_;
    std::string fault_;
    std::condition_variable_any changed_;  ///< there is a request
    std::jthread worker_;                  ///< last, so that it ends before the others are destroyed
};

}  // namespace

}  // namespace candela::reference

namespace candela::tools {

std::unique_ptr<LiveReference> make_live_reference(std::function<void()> notify) {
    return std::make_unique<reference::TracedReference>(std::move(notify));
}

}  // namespace candela::tools
