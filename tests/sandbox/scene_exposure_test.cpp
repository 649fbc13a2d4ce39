#include "sandbox/scene/scene_exposure.hpp"

#include <filesystem>

#include <doctest/doctest.h>

#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("exposure of scenes") {

TEST_CASE("it is automatic for files other than the shipped scenes, also those of the same name") {
    const TemporaryFolder folder;
    const std::filesystem::path shipped = shipped_file("scenes", "cornell.gltf");
    const std::filesystem::path copy = folder / "cornell.gltf";
    std::filesystem::copy(shipped, copy);
    CHECK(is_shipped("scenes", shipped));
    CHECK_FALSE(is_shipped("scenes", copy));
    CHECK_FALSE(is_shipped("scenes", folder / "none.gltf"));

    SceneExposure exposure(true);
    ToneMapSettings settings{.curve = ToneCurve::neutral};
    for (const bool other : {false, true, true, false, true}) {
        exposure.choose(other ? copy : shipped, settings);
        CHECK(settings == ToneMapSettings{.curve = ToneCurve::neutral, .automatic_exposure = other});
    }
}

TEST_CASE("it stays as it is if it is given, or was changed since") {
    const std::filesystem::path other = "other.gltf";
    ToneMapSettings settings;
    SceneExposure(false).choose(other, settings);
    CHECK(settings == ToneMapSettings{});

    SceneExposure exposure(true);
    exposure.choose(other, settings);
    settings.automatic_exposure = false;
    exposure.choose(other, settings);
    CHECK_FALSE(settings.automatic_exposure);
    settings = {.exposure_ev = 1.0F, .automatic_exposure = true};
    exposure.choose(shipped_file("scenes", "cornell.gltf"), settings);
    CHECK(settings.automatic_exposure);
}
}  // TEST_SUITE("exposure of scenes")

}  // namespace candela::sandbox
