#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace candela::study {

/// A picture of linear radiance, PFM or EXR, and its reference of the same size: another such picture, or a
/// folder of `candela-study reference`, whose noise and background then do not count.
struct Comparison {
    std::filesystem::path picture;
    std::filesystem::path reference;
    std::optional<std::filesystem::path> mask;  ///< PFM or EXR; pixels count where it is not 0
    std::optional<std::filesystem::path> heat;  ///< PNG to write the heat map to
    std::optional<double> scale;                ///< relative error at the brightest colour of the heat map
    std::string light = "total";                ///< of a folder: "total", "direct" or "indirect"
};

/// Returns all measures as lines of text, and writes the heat map if one is requested. Throws
/// std::runtime_error that names the file and the error; then nothing is written.
[[nodiscard]] std::string compare(const Comparison& comparison);

}  // namespace candela::study
