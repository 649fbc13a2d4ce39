#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "tests/reference/path_tracer.hpp"
#include "tests/study/json_line.hpp"

namespace candela::study {

/// What a reference shows, and how it was traced: two of equal requests are the same to the last bit.
struct Request {
    std::string scene_hash;                ///< see scene_hash()
    std::string tracer;                    ///< stands for the path tracer's sources
    glm::uvec2 size{1};                    ///< pixels
    std::uint32_t samples = 0;             ///< paths a pixel
    std::optional<std::uint32_t> bounces;  ///< of indirect light; none: any
    std::uint32_t seed = 0;
    bool operator==(const Request&) const = default;
};

/// Points along a side of the square of them in each pixel that fine direct light is the mean of.
inline constexpr int fine_side = 4;

/// A reference as it lies in a folder: direct.pfm, indirect.pfm, half0.pfm, half1.pfm, direct-fine.pfm, the
/// masks hit.pfm and edge.pfm in black and white, and reference.json.
struct Reference {
    Request request;
    reference::Estimate estimate;
    sandbox::Picture direct_fine;  ///< direct light, the mean over the pixel in place of its centre
};

/// relMSE of the mean of the halves, estimated from how far they are from each other.
struct Noise {
    double indirect = 0.0;
    double total = 0.0;
};
[[nodiscard]] Noise noise(const reference::Estimate& estimate);

/// True if the folder holds a whole reference of this request. Throws std::runtime_error if it holds anything
/// else than a reference.
[[nodiscard]] bool holds(const std::filesystem::path& folder, const Request& request);

/// Writes the whole reference or leaves what was there. `scene` is what reference.json calls the scene.
/// Replaces another reference; throws std::runtime_error if the folder holds anything else.
void write_reference(const std::filesystem::path& folder, const std::string& scene,
                     const Reference& reference);

/// Throws std::runtime_error that names the file and the fault.
[[nodiscard]] Reference read_reference(const std::filesystem::path& folder);

/// The same, if it shows this scene as its files are now.
[[nodiscard]] Reference read_reference_of(const std::filesystem::path& scene,
                                          const std::filesystem::path& folder);

/// Has `fill` write into a new folder beside `folder`, which then takes its place and name. If `fill` throws,
/// what was there stays, and nothing else does.
void replace_folder(const std::filesystem::path& folder,
                    const std::function<void(const std::filesystem::path&)>& fill);

/// Pixel by pixel; both are of the same size.
[[nodiscard]] sandbox::Picture sum(sandbox::Picture a, const sandbox::Picture& b);
[[nodiscard]] sandbox::Picture difference(sandbox::Picture a, const sandbox::Picture& b);

}  // namespace candela::study
