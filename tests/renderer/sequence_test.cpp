// After any edit a frame equals that of a renderer that renders it from scratch: random edits of all kinds.
// The table of edits says the same of single edits, and which passes must run.

#include <doctest/doctest.h>

#include <string>

#include "tests/renderer/random_edits.hpp"
#include "tests/seed.hpp"

TEST_SUITE("sequences") {

using namespace candela;

namespace {

constexpr int steps = 40;

/// Few VPLs and small maps.
Configuration small_configuration(VplPlacement placement, VplVisibility method) {
    Configuration configuration = linear_configuration();
    configuration.vpls = {.placement = placement, .count = 8};
    configuration.visibility = {.method = method, .map_resolution = 16};
    configuration.shadows.cube_resolution = configuration.shadows.map_resolution = 32;
    return configuration;
}

class Sequence : public RenderFixture {
 protected:
    /// `updates`: VplSettings::updates; then several edits may follow each other before a picture is checked.
    void check_sequence(unsigned sequence, VplPlacement placement, VplVisibility method,
                        std::uint32_t updates = 0) {
        CAPTURE(sequence);
        Configuration configuration = small_configuration(placement, method);
        configuration.vpls.updates = updates;
        RandomEdits edits(cornell_box(), configuration, test_seed(sequence));
        edits.emission = sequence == 4;
        std::string history;
        for (int step = 0; step < steps; ++step) {
            history += edits.next();
            CAPTURE(history);
            const Picture shown = show(edits);
            if (updates > 0 && step % 4 != 3) continue;
            const Picture settled = updates > 0 ? settled_picture(edits.scene, edits.size) : shown;
            const bool same = settled == from_scratch(edits.scene, edits.size);
            REQUIRE(same);
        }
        edits.clear_meshes();
        CAPTURE(history);
        CHECK(show(edits) == fresh_picture(edits.scene, edits.size));
    }

 private:
    Picture show(const RandomEdits& edits) {
        configure(edits.configuration);
        return render(edits.scene, edits.size);
    }
};

}  // namespace

TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer: surfels, maps") {
    check_sequence(1, VplPlacement::surfels, VplVisibility::maps);
}

TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer: surfels, rays") {
    check_sequence(2, VplPlacement::surfels, VplVisibility::rays);
}

TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer once nothing waits") {
    check_sequence(5, VplPlacement::surfels, VplVisibility::maps, 3);
    check_sequence(6, VplPlacement::surfels, VplVisibility::rays, 3);
}

TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer: paths, rays") {
    check_sequence(3, VplPlacement::paths, VplVisibility::rays);
}

TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer: lamps and skies") {
    check_sequence(4, VplPlacement::surfels, VplVisibility::maps);
}

}  // TEST_SUITE("sequences")
