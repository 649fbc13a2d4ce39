#include <candela/extension.hpp>
#include <candela/graph/describe.hpp>
#include <candela/renderer.hpp>

#include <algorithm>
#include <utility>

#include "renderer/facade/device_of.hpp"
#include "renderer/facade/gpu_of.hpp"
#include "renderer/facade/renderer_state.hpp"
#include "renderer/gl/shader_source.hpp"

namespace candela {

Renderer::Renderer(const gl::GetProc& get_proc, const RendererOptions& options)
    : state_(std::make_unique<State>(get_proc, options)) {}

Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;
Renderer::~Renderer() = default;

std::vector<std::string> Renderer::configure(const Configuration& configuration) {
    return state_->configure(configuration);
}

std::vector<std::string> Renderer::prepare(const Configuration& configuration, const World& world,
                                           std::span<const RenderView> views,
                                           const CompileProgress& progress) {
    return state_->prepare(configuration, world, views, progress);
}

const Configuration& Renderer::configuration() const {
    return state_->configuration();
}

bool Renderer::render(const World& world, std::span<const RenderView> views, const FrameOptions& options) {
    return state_->render(world, views, options);
}

void Renderer::render(const World& world, Entity camera, const Target& target, glm::vec2 jitter) {
    const RenderView view{.camera = camera, .target = target, .jitter = jitter};
    state_->render(world, {&view, 1}, {});
}

FrameResults Renderer::results(std::size_t view) const {
    return state_->results(view);
}

void Renderer::set_receivers(std::vector<Receiver> receivers) {
    state_->set_receivers(std::move(receivers));
}

std::vector<glm::vec3> Renderer::received_light() const {
    return state_->received_light();
}

ResultBuffer Renderer::received_light_buffer() const {
    return state_->received_light_buffer();
}

std::vector<std::string> Renderer::extend(Extension extension) {
    return state_->extend(std::move(extension));
}

void Renderer::remove_extension(std::string_view name) {
    state_->remove_extension(name);
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

void Renderer::tone_map(std::uint32_t texture, const Target& target) {
    state_->tone_map(texture, target);
}

std::vector<FrameReport> Renderer::take_frames(bool wait) {
    return state_->take_frames(wait);
}

Report Renderer::report(std::size_t view) {
    return state_->report(view);
}

GraphDescription Renderer::description() const {
    return state_->description();
}

Quality Renderer::quality() const {
    return state_->quality();
}

bool Renderer::settled() const {
    return state_->settled();
}

const std::vector<PassRecord>& Renderer::last_passes() const {
    return state_->last_passes();
}

std::string_view glsl_types() {
    const auto files = gl::embedded_shaders();
    return std::ranges::find(files, "types.glsl", &gl::EmbeddedShader::name)->text;
}

Gpu& gpu_of(Renderer& renderer) {
    return renderer.state_->gpu();
}

gl::Device& device_of(Renderer& renderer) {
    return gpu_of(renderer).device();
}

}  // namespace candela
