#include "sandbox/capture.hpp"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace candela::sandbox {

TEST_SUITE("capture") {
    TEST_CASE("one sample is taken at the pixel's centre, many fill the pixel evenly") {
        CHECK(pixel_jitter(0) == glm::vec2(0.0F));
        // Of 64 points of a low-discrepancy sequence every cell of a 4×4 grid gets 4, give or take 2.
        std::vector<int> cells(16);
        glm::vec2 sum(0.0F);
        for (int sample = 0; sample < 64; ++sample) {
            const glm::vec2 at = pixel_jitter(sample);
            REQUIRE((at.x >= -0.5F && at.x < 0.5F && at.y >= -0.5F && at.y < 0.5F));
            sum += at;
            const glm::ivec2 cell((at + 0.5F) * 4.0F);
            ++cells[static_cast<std::size_t>(4 * cell.y + cell.x)];
        }
        CHECK(*std::min_element(cells.begin(), cells.end()) >= 2);
        CHECK(*std::max_element(cells.begin(), cells.end()) <= 6);
        // The picture is not shifted: their mean lies nearer to the centre than that of random points would,
        // whose standard error is 1 / sqrt(12 · 64).
        CHECK(glm::length(sum / 64.0F) < 0.036F);
    }
}

}  // namespace candela::sandbox
