#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/configuration.hpp>
#include <candela/ecs/world.hpp>
#include <candela/gl_error.hpp>
#include <candela/gl_loader.hpp>
#include <candela/graph/errors.hpp>
#include <candela/receiver.hpp>
#include <candela/renderer_options.hpp>
#include <candela/report.hpp>
#include <candela/view.hpp>

namespace candela {

class Gpu;
struct Extension;         // <candela/extension.hpp>
struct GraphDescription;  // <candela/graph/describe.hpp>

/// How many shader programs are compiled, of how many that are needed. Returns whether to go on.
using CompileProgress = std::function<bool(std::size_t done, std::size_t total)>;

/// Renders worlds. An instance belongs to one GL context, which must be current in every call, including the
/// destructor. Instances share nothing. Not synchronised.
class CANDELA_API Renderer {
 public:
    /// `get_proc` returns the addresses of GL functions, as glfwGetProcAddress does; it is called only here.
    /// Throws gl::GlError if no context is current, if it offers less than OpenGL 4.5, lacks a function or
    /// has a limit that is too low, and gl::ProgramError if a shader file is missing. Shaders are compiled
    /// when they are needed: by `prepare`, `configure`, `extend` or the first frame.
    explicit Renderer(const gl::GetProc& get_proc, const RendererOptions& options = {});
    Renderer(Renderer&& other) noexcept;
    Renderer& operator=(Renderer&& other) noexcept;
    ~Renderer();

    /// Switches to `configuration` from the next frame on. Returns the errors, one per string; if there are
    /// any, the current configuration stays. Scene data, VPLs and shadow maps are kept where their settings
    /// do not change. Compiles the shaders that frames like the last one need, and that have not been
    /// compiled yet; before the first frame, those of frames like the one that was prepared last, or else of
    /// a world of opaque surfaces.
    [[nodiscard]] std::vector<std::string> configure(const Configuration& configuration);
    /// Compiles the shaders that frames of `world` in `views` need with `configuration`, so that these frames
    /// need not wait for it. Nothing else changes: not the current configuration, the frame graph or any
    /// result; nothing is drawn or uploaded. The frames need others if the world later shows what it has not
    /// now, for example a first light source of another kind, blended surface or sky. Drivers may leave a
    /// part of the work to the first frame, whatever has been compiled.
    ///
    /// Takes views as `render` does, also such of which the targets and the textures do not exist yet: only
    /// sizes and what is asked for count. Of extensions, only what they need counts; their passes are not
    /// declared. Runs in the calling thread until all is compiled. The driver may use others, and is then
    /// given all shaders at once.
    ///
    /// `progress`, if any, is called in this thread: before anything is compiled, with those in `done` that
    /// were ready before, and whenever another one is. It must not call the renderer. If it returns false,
    /// compilation stops: what is ready stays, and a further call, or the first frame, goes on.
    ///
    /// Returns the errors as `configure` does, with file and line of a shader that does not compile. Throws
    /// gl::GlError if another context is current or if there are no views, SceneError where `render` does
    /// because of RendererOptions::checked, and what `progress` throws.
    [[nodiscard]] std::vector<std::string> prepare(const Configuration& configuration, const World& world,
                                                   std::span<const RenderView> views,
                                                   const CompileProgress& progress = {});
    [[nodiscard]] const Configuration& configuration() const;

    /// Renders one frame: `world` in each of `views`, of which there must be at least one. VPLs, shadow maps
    /// and uploads are made once for all views. Refinement averages frames by view; views are identified by
    /// their position in `views`. Only passes whose inputs have changed since the last frame run.
    ///
    /// All state of OpenGL 4.5 is the same afterwards, and none of the host's changes the picture, with these
    /// exceptions. Conditional rendering must not be active. A query of the host that is active also counts
    /// what is drawn here. A program that the host has deleted while it was current is gone, and the
    /// subroutine uniforms of a current program are reset. The clamp of the polygon offset (OpenGL 4.6) is
    /// reset. Transform feedback is paused meanwhile. Errors that the host has not yet asked for stay.
    ///
    /// What cannot be rendered is left out, as if it were not in the world, with a warning that names the
    /// entity and the fault (see RendererOptions):
    ///
    /// - a mesh that is null, that has a primitive without material, an index out of range, a number of
    ///   indices that is no multiple of 3, or a vertex that is not finite or beyond 10⁹ metres, or whose
    ///   material has a negative or infinite colour or emission, or an image with another number of texels
    ///   than its size says;
    /// - a light with a negative or infinite value, its range excepted, or a cone without width;
    /// - an Environment with a negative or infinite value or another number of texels than its size says;
    /// - all components of an entity whose world matrix is not finite or scales by more than 10⁹.
    ///
    /// To find this, each mesh and each picture is read once, when it is seen for the first time.
    ///
    /// Throws EntityError if there is no such camera, SceneError if the camera or its world matrix is not
    /// finite or cannot show anything, or if an entity's parents form a cycle or were destroyed, and
    /// gl::GlError if another context is current, if there are no views, if a target does not exist, is
    /// incomplete, draws colour into no attachment or into integers, is larger than its framebuffer, or has a
    /// size of 0 or above the driver's limit, if a texture of a HostSurfaces does not exist or has a size or
    /// format that it cannot have, if a driver limit is exceeded, or if the driver runs out of
    /// memory; then GL_OUT_OF_MEMORY is also pending for the host's glGetError. Passes on what an extension
    /// throws. After an exception, the next call runs the passes that did not finish.
    ///
    /// Returns whether the frame is complete: false if `options` say that it is not wanted any more. Each
    /// target then holds what it held before, or its picture. What has been computed is not lost: the next
    /// call runs the passes that are left, and those whose inputs have changed. Until it is complete, nothing
    /// is settled, results and received light may be of either frame, and take_frames reports no times.
    bool render(const World& world, std::span<const RenderView> views, const FrameOptions& options = {});
    /// The same with one view. `jitter`: see RenderView::jitter.
    void render(const World& world, Entity camera, const Target& target, glm::vec2 jitter = glm::vec2(0.0F));

    /// What the last frame has left of view number `view`, as far as its RenderView::keep asked for it. Valid
    /// until the next call of a function that is not const. Throws GraphError if there is no such view.
    [[nodiscard]] FrameResults results(std::size_t view = 0) const;

    /// From the next frame on, also finds the light at these places, from which the host can light what it
    /// draws itself: that of lights, with their shadows, of surfaces that emit or reflect light, and of the
    /// sky, as far as the configuration shows them. It is computed again only when it may have changed. A
    /// receiver then costs as much as a pixel that evaluates all lights and all VPLs. Throws SceneError, and
    /// changes nothing, if a position is not finite or a normal not of unit length.
    void set_receivers(std::vector<Receiver> receivers);
    /// The irradiance at each receiver in the last frame, in lux or W/m²; zero if no light is shown. Waits
    /// for the GPU. Empty before the first frame with receivers.
    [[nodiscard]] std::vector<glm::vec3> received_light() const;
    /// The same on the GPU, as vec4s; valid like `results`.
    [[nodiscard]] ResultBuffer received_light_buffer() const;

    /// Adds passes of the host's to the frames of all views from now on; extensions at the same place follow
    /// each other in the order of these calls. An extension with the name of another one takes its place.
    /// Returns the errors, one per string, with the names of the passes; if there are any, nothing changes.
    [[nodiscard]] std::vector<std::string> extend(Extension extension);
    /// Removes an extension; does nothing if there is none with the name. Throws GraphError, and changes
    /// nothing, if another extension cannot do without it.
    void remove_extension(std::string_view name);

    /// Makes the next frame compute everything again. Not needed for another world, wherever it is: worlds
    /// are told apart by the revisions of their component pools.
    void invalidate();

    /// For tests. Runs the passes of every frame a second time where that is possible, including passes that
    /// had nothing to do. `render` then throws GraphError where a pass gives another result than before,
    /// because it depends on an input that it does not declare: see GraphRuntime::verify. Reads all results
    /// back and takes more than twice the time.
    void verify(bool on);

    /// Tone-maps a picture of linear radiance, or of what else Configuration::show selects, that was computed
    /// elsewhere, for example an average of frames, into `target`. An automatic exposure is that of this
    /// picture. `radiance` holds target.size.x × target.size.y pixels row by row, the bottom row first.
    /// Throws gl::GlError if it holds another number of pixels, and where `render` does because of a context
    /// or target.
    void tone_map(const std::vector<glm::vec3>& radiance, const Target& target);
    /// The same for a 2D texture of linear radiance on the GPU, by its GL name. It is scaled to the target.
    void tone_map(std::uint32_t texture, const Target& target);

    /// CPU and GPU times of the frames whose GPU times have arrived since the last call, oldest first. Does
    /// not wait for the GPU unless `wait` is set; then it returns all finished frames. Of frames that are not
    /// taken, the latest `kept_frames` are kept.
    [[nodiscard]] std::vector<FrameReport> take_frames(bool wait = false);
    static constexpr std::size_t kept_frames = 1024;

    /// Reads counts and sums of the last frame back, those that depend on the view from view number `view`;
    /// waits for the GPU. Call it after a frame was rendered with the current configuration; before the first
    /// frame, or if there is no such view, it throws GraphError.
    [[nodiscard]] Report report(std::size_t view = 0);

    /// The frame graph of the current configuration: passes, resources and barriers.
    [[nodiscard]] GraphDescription description() const;

    /// Quality of the last frame, the same for all views. `scale` is below 1 only to keep the frame within
    /// its budget; `interleave` is the factor n that was used in the first view.
    [[nodiscard]] Quality quality() const;

    /// Whether rendering the same views of the same world again would give the same pictures: refinement is
    /// complete or off, no surfels wait to be traced (VplSettings::updates), and the frame budget does not
    /// reduce the quality.
    [[nodiscard]] bool settled() const;

    /// All passes of the last frame, with whether each ran. Empty between a change of the configuration and
    /// the next frame.
    [[nodiscard]] const std::vector<PassRecord>& last_passes() const;

 private:
    class State;
    friend Gpu& gpu_of(Renderer& renderer);

    std::unique_ptr<State> state_;
};

}  // namespace candela
