#include "sandbox/scene/scene_exposure.hpp"

#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

void SceneExposure::choose(const std::filesystem::path& scene, ToneMapSettings& settings) {
    const bool changed = settings.automatic_exposure != automatic_ || settings.exposure_ev != 0.0F;
    if (!open_ || changed) return;
    automatic_ = !is_shipped("scenes", scene);
    settings.automatic_exposure = automatic_;
}

}  // namespace candela::sandbox
