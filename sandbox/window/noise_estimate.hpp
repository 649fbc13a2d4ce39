#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec4.hpp>

namespace candela::sandbox {

/// How noisy the mean of a growing number of frames still is, estimated from how far it is from the mean of
/// fewer of them.
class NoiseEstimate {
 public:
    /// Whether the mean of so many frames tells more than those that were added: that of half as many frames
    /// more, or of fewer, which are the first ones of another picture.
    [[nodiscard]] bool wants(std::uint32_t frames) const;
    /// Adds the mean of the first `frames` frames: linear radiance, alpha is not used. Fewer frames or
    /// another size than before begin another picture.
    void add(std::uint32_t frames, std::vector<glm::vec4> mean);
    /// Forgets the picture.
    void reset() { *this = {}; }

    /// The standard deviation of a pixel's mean over equally many other frames, as the root mean square over
    /// all pixels and channels, relative to their mean. It takes frames for independent, or groups of a few,
    /// such as those with the same surfels: as their samples complement each other, the picture is rather
    /// better than that. None before there are means to compare.
    [[nodiscard]] std::optional<double> value() const { return value_; }

 private:
    std::uint32_t newest_ = 0;  // number of frames that was added last
    std::uint32_t frames_ = 0;  // of `mean_`, which the next ones are compared with
    std::vector<glm::vec4> mean_;
    std::optional<double> value_;
};

}  // namespace candela::sandbox
