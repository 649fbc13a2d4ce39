// A long run of everything that happens to an embedded renderer: edits, switches of configurations, resizes
// and scenes that are loaded again.

#include <doctest/doctest.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "renderer/facade/device_of.hpp"
#include "tests/memory.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/random_edits.hpp"
#include "tests/seed.hpp"

TEST_SUITE("soak") {

using namespace candela;

namespace {

constexpr int frames_per_round = 40;

/// CANDELA_SOAK_FRAMES from the environment, or a number that takes a few seconds.
int soak_frames() {
    const char* const given = std::getenv("CANDELA_SOAK_FRAMES");
    if (!given) return 3 * frames_per_round;
    const std::string_view text(given);
    int frames = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frames);
    if (error != std::errc{} || end != text.data() + text.size() || frames < 1) {
        throw std::runtime_error("CANDELA_SOAK_FRAMES is not a number of frames");
    }
    return frames;
}

Configuration small_configuration() {
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::rays;
    configuration.vpls.count = 8;
    return configuration;
}

class SoakFixture : public RenderFixture {
 protected:
    /// Loads the scene again and edits it in each frame.
    void edit_for_a_round(int round) {
        RandomEdits edits(cornell_box(), small_configuration(), test_seed(static_cast<std::uint32_t>(round)));
        std::string story;
        for (int frame = 0; frame < frames_per_round; ++frame) {
            story += edits.next();
            CAPTURE(story);
            configure(edits.configuration);
            REQUIRE(is_sane(render(edits.scene, edits.size)));
        }
        REQUIRE(render(edits.scene, edits.size) == fresh_picture(edits.scene, edits.size));
    }

    /// The objects that exist for a given scene and configuration. Passes through a graph that needs few of
    /// them, so that the free pool holds the same each time.
    gl::ObjectCounts objects_at_rest() {
        const Scene scene = cornell_box();
        for (const Configuration& configuration : {direct_only(), small_configuration()}) {
            configure(configuration);
            for (int frame = 0; frame < 2; ++frame) {
                static_cast<void>(render(scene, {40, 30}));
                static_cast<void>(renderer.take_frames(true));
            }
        }
        return device_of(renderer).live();
    }
};

}  // namespace

TEST_CASE_FIXTURE(SoakFixture, "edits, switches, resizes and reloads leave nothing behind") {
    using enum gl::ObjectKind;
    const int rounds = (soak_frames() + frames_per_round - 1) / frames_per_round;
    for (int round = 0; round < 3; ++round) edit_for_a_round(round);  // fills the driver's caches
    const gl::ObjectCounts objects = objects_at_rest();
    const std::uint64_t memory = test::resident_bytes();
    for (int round = 0; round < rounds; ++round) {
        edit_for_a_round(3 + round);
        CAPTURE(round);
        const gl::ObjectCounts now = objects_at_rest();
        for (const auto kind : {buffer, texture, vertex_array, sampler}) {
            REQUIRE(now[kind] == objects[kind]);
        }
        // The rest is kept for reuse: programs of all variants that were needed so far, queries for the
        // most passes of a frame, and framebuffers for all attachments together that passes have used
        // while these exist.
        REQUIRE(now[program] <= 4 * objects[program]);
        REQUIRE(now[query] <= 2 * objects[query]);
        REQUIRE(now[framebuffer] <= 2 * objects[framebuffer]);
    }
    const std::uint64_t grown = test::resident_bytes() - memory;
    MESSAGE((rounds * frames_per_round) << " frames, resident memory from " << (memory >> 20U) << " MiB by "
                                        << (static_cast<std::int64_t>(grown) >> 20) << " MiB");
    // A software driver keeps code for each state in which a shader was used: about 90 MiB until frame 2,000,
    // and no more until frame 10,000; what a GPU's keeps is its own affair. AddressSanitizer delays freeing
    // memory, and finds leaks by itself.
    if (test::is_sanitized || !device.limits().software) return;
    CHECK(static_cast<std::int64_t>(grown) < std::int64_t{128} << 20);
}

}  // TEST_SUITE("soak")
