#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>
#include <candela/tools/picture.hpp>
#include <candela/tools/picture_error.hpp>

namespace candela::tools {

/// What a path tracer has found out about a picture so far.
struct ReferencePicture {
    /// All light, direct and indirect; linear radiance.
    Picture radiance;
    Mask hit;  ///< the pixels that show a surface; others show the sky, or black
    /// Paths per pixel; 0 for a preview, which is a smaller picture, enlarged, and of no use for measuring.
    std::uint32_t samples = 0;
    /// An estimate of the relMSE that the noise of `radiance` causes. A picture's error over `radiance` is
    /// this much above the error over a reference without noise, as both are independent. An estimate above
    /// 0.05 may be a third of the true value: such a reference is too noisy to measure with. Set from the
    /// second pass on.
    std::optional<double> noise;
    double seconds = 0.0;  ///< wall time since the start
};

/// What a reference shows.
struct ReferenceRequest {
    std::shared_ptr<const World> world{};  ///< not null; without faulty meshes (see Renderer::render)
    Entity camera{};
    glm::uvec2 size{1};  ///< pixels
    /// Show the means over the areas of the pixels, which the renderer's refinement converges to, instead of
    /// what is at their centres, as in its frames without refinement. Over the wrong one of both, pixels at
    /// edges have an error that does not get smaller.
    bool antialiased = false;
    unsigned threads = 0;           ///< 0: half of the machine's cores, but at least one
    std::uint32_t samples = 16384;  ///< paths per pixel after which the work ends; even
    bool operator==(const ReferenceRequest&) const = default;
};

/// A reference that gets better in the background, on threads of low priority, with unlimited bounces. Its
/// pictures depend only on the request and on their number of samples. All functions return at once and may
/// be called by any thread.
class CANDELA_API LiveReference {
 public:
    LiveReference() = default;
    LiveReference(const LiveReference&) = delete;
    LiveReference& operator=(const LiveReference&) = delete;
    /// Waits until the threads have ended: for the time of a pixel, or of preparing the world.
    virtual ~LiveReference() = default;

    /// Ends what runs and starts another picture.
    virtual void start(ReferenceRequest request) = 0;
    /// Ends what runs. From now on there is no picture until the next start.
    virtual void stop() = 0;
    /// The newest picture since the start, if it was not returned before.
    [[nodiscard]] virtual std::optional<ReferencePicture> newest() = 0;
    /// Why the work has ended without the wanted samples, such as a camera that does not exist; empty
    /// otherwise.
    [[nodiscard]] virtual std::string fault() const = 0;
};

/// Null where the path tracer is not built in, for which Embree is needed. A thread of the reference's calls
/// `notify` whenever there is a new picture or a fault. It must not destroy the reference.
[[nodiscard]] CANDELA_API std::unique_ptr<LiveReference> make_live_reference(std::function<void()> notify);

}  // namespace candela::tools
