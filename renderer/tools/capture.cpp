#include <candela/tools/capture.hpp>

#include <cstddef>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <candela/tools/output_file.hpp>
#include <candela/tools/tool_error.hpp>
#include <candela/view.hpp>
#include "renderer/tools/canvas.hpp"

namespace candela::tools {

namespace {

/// Turns tone mapping off during its lifetime, and exposure, which Capture::tone_mapped applies.
class LinearOutput {
 public:
    explicit LinearOutput(Renderer& renderer) : renderer_(renderer), before_(renderer.configuration()) {
        Configuration linear = before_;
        linear.tone_map.enabled = false;
        linear.tone_map.exposure_ev = 0.0F;
        const std::vector<std::string> errors = renderer_.configure(linear);
        if (!errors.empty()) throw ToolError(fmt::format("{}", fmt::join(errors, "; ")));
    }
    ~LinearOutput() {
        // The renderer had this configuration before. If it fails nonetheless, the linear one stays.
        static_cast<void>(renderer_.configure(before_));
    }
    LinearOutput(const LinearOutput&) = delete;
    LinearOutput& operator=(const LinearOutput&) = delete;

 private:
    Renderer& renderer_;
    Configuration before_;
};

/// The sum of the costs of several frames.
FrameReport sum_up(const std::vector<FrameReport>& frames) {
    if (frames.empty()) return {};
    FrameReport sum = frames.front();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        sum.cpu_ms += frames[i].cpu_ms;
        sum.gpu_ms += frames[i].gpu_ms;
        sum.waiting_surfels = frames[i].waiting_surfels;
        for (std::size_t pass = 0; pass < sum.passes.size(); ++pass) {
            sum.passes[pass].ran |= frames[i].passes[pass].ran;
            sum.passes[pass].cpu_ms += frames[i].passes[pass].cpu_ms;
            sum.passes[pass].gpu_ms += frames[i].passes[pass].gpu_ms;
        }
    }
    return sum;
}

}  // namespace

glm::vec2 pixel_jitter(int i, int count) {
    // An even number of samples consists of pairs, without the sample at the centre.
    const int first = count % 2 == 0 ? 1 : 0;
    return pixel_sample(static_cast<std::uint32_t>(first + i));
}

class CANDELA_PRIVATE Capture::State {
 public:
    State(Renderer& renderer, const gl::GetProc& get_proc, glm::uvec2 size)
        : renderer_(renderer),
          size_(size),
          device_(get_proc, gl::DebugOutput::off),
          linear_(device_, size, Format::rgba32f),
          encoded_(device_, size, Format::rgba8) {}

    [[nodiscard]] Picture render(const World& world, Entity camera, int samples, CaptureReport& report,
                                 const std::function<bool()>& goes_on);
    [[nodiscard]] std::optional<double> estimate_error(const World& world, Entity camera);
    [[nodiscard]] std::vector<std::uint8_t> tone_mapped(const Picture& picture);

 private:
    void add_pixels(std::vector<glm::vec3>& sum) const;

    Renderer& renderer_;
    glm::uvec2 size_;
    gl::Device device_;
    Canvas linear_;
    Canvas encoded_;
};

void Capture::State::add_pixels(std::vector<glm::vec3>& sum) const {
    const std::vector<glm::vec4> texels = linear_.texels(device_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += glm::vec3(texels[i]);
}

Picture Capture::State::render(const World& world, Entity camera, int samples, CaptureReport& report,
                               const std::function<bool()>& goes_on) {
    const LinearOutput linear(renderer_);
    const std::vector<FrameReport> earlier = renderer_.take_frames(true);
    std::vector<glm::vec3> sum(static_cast<std::size_t>(size_.x) * size_.y);
    std::vector<FrameReport> frames;
    const bool refines = renderer_.configuration().refinement.enabled;
    int sample = 0;
    do {
        const glm::vec2 jitter = refines ? glm::vec2(0.0F) : pixel_jitter(sample, samples);
        renderer_.render(world, camera, linear_.target(), jitter);
        if (!refines) add_pixels(sum);
        for (FrameReport& frame : renderer_.take_frames(true)) frames.push_back(std::move(frame));
    } while (++sample < samples && (!goes_on || goes_on()));
    if (refines) add_pixels(sum);
    const auto kept = static_cast<float>(refines ? 1 : sample);
    for (glm::vec3& pixel : sum) pixel /= kept;
    report = {sum_up(frames), renderer_.report()};
    return flipped({glm::ivec2(size_), std::move(sum)});
}

std::optional<double> Capture::State::estimate_error(const World& world, Entity camera) {
    const RenderView view{.camera = camera, .target = linear_.target(), .estimate_error = true};
    renderer_.render(world, {&view, 1});
    const std::optional<VplReport> vpls = renderer_.report().vpls;
    return vpls ? vpls->estimated_error : std::nullopt;
}

std::vector<std::uint8_t> Capture::State::tone_mapped(const Picture& picture) {
    renderer_.tone_map(flipped(picture).pixels, encoded_.target());
    return rgb_of_texels(size_, encoded_.texels(device_));
}

Capture::Capture(Renderer& renderer, const gl::GetProc& get_proc, glm::ivec2 size)
    : state_(std::make_unique<State>(renderer, get_proc, glm::uvec2(size))) {}
Capture::~Capture() = default;

Picture Capture::render(const World& world, Entity camera, int samples, CaptureReport& report,
                        const std::function<bool()>& goes_on) {
    return state_->render(world, camera, samples, report, goes_on);
}

Picture Capture::render(const World& world, Entity camera, int samples) {
    CaptureReport ignored;
    return state_->render(world, camera, samples, ignored, {});
}

std::optional<double> Capture::estimate_error(const World& world, Entity camera) {
    return state_->estimate_error(world, camera);
}

std::vector<std::uint8_t> Capture::tone_mapped(const Picture& picture) {
    return state_->tone_mapped(picture);
}

void Capture::write(const std::filesystem::path& path, const Picture& picture) {
    const std::string extension = lower_extension(path);
    if (extension == ".exr") return write_exr(path, picture);
    if (extension == ".pfm") return write_pfm(path, picture);
    write_png(path, picture.size, tone_mapped(picture));
}

}  // namespace candela::tools
