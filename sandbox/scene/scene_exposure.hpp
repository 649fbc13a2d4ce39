#pragma once

#include <filesystem>

#include <candela/configuration.hpp>

namespace candela::sandbox {

/// The app's choice between automatic exposure and none. The shipped scenes are lit for exposure 0; in other
/// files lights may have any brightness.
class SceneExposure {
 public:
    /// `open`: nothing else gives the exposure, see leaves_exposure_open.
    explicit SceneExposure(bool open) : open_(open) {}

    /// Chooses for the scene of this file, unless the exposure is given, or `settings` differ from what was
    /// chosen last, as the user has changed them since. In the beginning, that is the default.
    void choose(const std::filesystem::path& scene, ToneMapSettings& settings);

 private:
    bool open_;
    bool automatic_ = false;  ///< chosen last
};

}  // namespace candela::sandbox
