#include <candela/tools/capture.hpp>

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("capture") {

TEST_CASE("one sample is taken at the pixel's centre, many fill the pixel evenly") {
    CHECK(tools::pixel_jitter(0, 1) == glm::vec2(0.0F));
    // Of 64 well-distributed points, every cell of a 4×4 grid gets 4 ± 2.
    std::vector<int> cells(16);
    for (int sample = 0; sample < 64; ++sample) {
        const glm::vec2 at = tools::pixel_jitter(sample, 64);
        REQUIRE((at.x >= -0.5F && at.x < 0.5F && at.y >= -0.5F && at.y < 0.5F));
        const glm::ivec2 cell((at + 0.5F) * 4.0F);
        ++cells[static_cast<std::size_t>(4 * cell.y + cell.x)];
    }
    CHECK(*std::min_element(cells.begin(), cells.end()) >= 2);
    CHECK(*std::max_element(cells.begin(), cells.end()) <= 6);
}

TEST_CASE("the mean of any number of samples is the pixel's centre") {
    for (int count = 1; count <= 65; ++count) {
        CAPTURE(count);
        glm::vec2 sum(0.0F);
        for (int sample = 0; sample < count; ++sample) sum += tools::pixel_jitter(sample, count);
        CHECK(std::max(std::abs(sum.x), std::abs(sum.y)) < 1e-6F * static_cast<float>(count));  // rounding
    }
}
}  // TEST_SUITE("capture")

}  // namespace candela::sandbox
