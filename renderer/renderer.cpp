#include <candela/renderer.hpp>

#include "renderer/device_of.hpp"
#include "renderer/renderer_state.hpp"

namespace candela {

Renderer::Renderer(const gl::GetProc& get_proc, const RendererOptions& options)
    : state_(std::make_unique<State>(get_proc, options)) {}

Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;
Renderer::~Renderer() = default;

std::vector<std::string> Renderer::configure(const Configuration& configuration) {
    return state_->configure(configuration);
}

const Configuration& Renderer::configuration() const {
    return state_->configuration();
}

void Renderer::render(const World& world, Entity camera, const Target& target, glm::vec2 jitter) {
    state_->render(world, camera, target, jitter);
}

void Renderer::invalidate() {
    state_->invalidate();
}

void Renderer::verify(bool on) {
    state_->verify(on);
}

void Renderer::tone_map(const std::vector<glm::vec3>& radiance, const Target& target) {
    state_->tone_map(radiance, target);
}

std::vector<FrameReport> Renderer::take_frames(bool wait) {
    return state_->take_frames(wait);
}

Report Renderer::report() {
    return state_->report();
}

std::string Renderer::describe(GraphFormat format) const {
    return state_->describe(format);
}

Quality Renderer::quality() const {
    return state_->quality();
}

const std::vector<PassRecord>& Renderer::last_passes() const {
    return state_->last_passes();
}

gl::Device& device_of(Renderer& renderer) {
    return renderer.state_->device();
}

}  // namespace candela
