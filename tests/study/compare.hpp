#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace candela::study {

/// Two pictures of linear radiance, PFM or EXR, of equal size.
struct Comparison {
    std::filesystem::path picture;
    std::filesystem::path reference;
    std::optional<std::filesystem::path> mask;  ///< PFM or EXR; pixels count where it is not 0
    std::optional<std::filesystem::path> heat;  ///< PNG to write the heat map to
    std::optional<double> scale;                ///< relative error of the heat map's brightest colour
};

/// All measures as lines of text, and the heat map where one is asked for. Throws std::runtime_error that
/// names the file and the fault; nothing is written then.
[[nodiscard]] std::string compare(const Comparison& comparison);

}  // namespace candela::study
