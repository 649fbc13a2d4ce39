#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "renderer/tools/reference/path_tracer.hpp"
#include "tests/study/json_line.hpp"
#include "tests/study/measures.hpp"

namespace candela::study {

/// What a reference shows, and how it was traced: equal requests give bit-identical references.
struct Request {
    std::string scene_hash;                ///< see scene_hash()
    std::string tracer;                    ///< identifies the path tracer's sources
    glm::uvec2 size{1};                    ///< pixels
    std::uint32_t samples = 0;             ///< paths per pixel
    std::optional<std::uint32_t> bounces;  ///< of indirect light; nullopt: unlimited
    std::uint32_t seed = 0;
    bool caustics = true;  ///< see reference::Settings
    bool operator==(const Request&) const = default;
};

/// The mean for fine direct light is over a square of points in each pixel, with this many on each side.
inline constexpr int fine_side = 4;

/// The contents of a reference's folder: direct.pfm, indirect.pfm, half0.pfm, half1.pfm, direct-fine.pfm, the
/// masks hit.pfm and edge.pfm in black and white, and reference.json.
struct Reference {
    Request request;
    reference::Estimate estimate;
    tools::Picture direct_fine;  ///< direct light: the mean over the pixel instead of its centre
};

/// All light, as the halves of the indirect light have it.
[[nodiscard]] Halves halves_of_total(const reference::Estimate& estimate);

/// The relMSE of the mean of the halves, estimated from their difference.
struct Noise {
    double indirect = 0.0;
    double total = 0.0;
};
[[nodiscard]] Noise noise(const reference::Estimate& estimate);

/// Whether the folder contains a complete reference of this request. Throws std::runtime_error if it contains
/// anything other than a reference.
[[nodiscard]] bool holds(const std::filesystem::path& folder, const Request& request);

/// Writes the whole reference or leaves the folder unchanged. `scene` is the name of the scene in
/// reference.json. Replaces another reference; throws std::runtime_error if the folder contains anything
/// else.
void write_reference(const std::filesystem::path& folder, const std::string& scene,
                     const Reference& reference);

/// Throws std::runtime_error that names the file and the error.
[[nodiscard]] Reference read_reference(const std::filesystem::path& folder);

/// The same; also throws if it does not show this scene with its current files.
[[nodiscard]] Reference read_reference_of(const std::filesystem::path& scene,
                                          const std::filesystem::path& folder);

/// Calls `fill` to write into a new folder next to `folder`, which then replaces `folder`. If `fill` throws,
/// `folder` is unchanged and the new folder is removed.
void replace_folder(const std::filesystem::path& folder,
                    const std::function<void(const std::filesystem::path&)>& fill);

/// Per pixel; both must have the same size.
[[nodiscard]] tools::Picture sum(tools::Picture a, const tools::Picture& b);
[[nodiscard]] tools::Picture difference(tools::Picture a, const tools::Picture& b);

}  // namespace candela::study
