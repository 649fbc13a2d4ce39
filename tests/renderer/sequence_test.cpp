#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <string>

#include "tests/renderer/random_edits.hpp"
#include "tests/seed.hpp"

using namespace candela;

namespace {

constexpr int steps = 40;

/// Few VPLs and small maps, so that a new renderer for each step is fast.
Configuration unlimited() {
    Configuration configuration = linear_configuration();
    configuration.vpls = {.count = 8};
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    configuration.shadows.cube_resolution = configuration.shadows.map_resolution = 64;
    return configuration;
}

class Sequence : public RenderFixture {
 protected:
    Picture fresh_picture(const RandomEdits& edits) {
        TestedRenderer fresh(context->get_proc());
        REQUIRE(fresh.configure(edits.configuration).empty());
        const RenderTarget target(device, edits.size);
        fresh.render(edits.scene.world, edits.scene.camera, target.target());
        return target.read();
    }

    void check_frame(const RandomEdits& edits) {
        configure(edits.configuration);
        const bool same = render(edits.scene, edits.size) == fresh_picture(edits);
        REQUIRE(same);
    }
};

}  // namespace

TEST_SUITE("sequences") {
    TEST_CASE_FIXTURE(Sequence, "after random edits a frame equals that of a new renderer, bit for bit") {
        for (const unsigned sequence : {1U, 2U, 3U, 4U}) {
            CAPTURE(sequence);
            RandomEdits edits(cornell_box(), unlimited(), test_seed(sequence));
            edits.emission = sequence == 4;
            std::string history;
            for (std::size_t step = 0; step < steps; ++step) {
                history += edits.next();
                if (step % 8 == 7) {
                    edits.configuration.vpls.count = std::array{0U, 40U, 8U}.at(step / 8 % 3);
                    history += "another count of VPLs; ";
                }
                CAPTURE(history);
                check_frame(edits);
            }
            edits.clear_meshes();
            CAPTURE(history);
            check_frame(edits);
        }
    }
}
