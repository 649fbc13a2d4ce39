#include "tests/study/compare.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <candela/tools/flip.hpp>
#include <candela/tools/output_file.hpp>
#include <candela/tools/picture.hpp>
#include "tests/sandbox/picture_reader.hpp"
#include "tests/study/heat.hpp"
#include "tests/study/measures.hpp"
#include "tests/study/reference_files.hpp"

namespace candela::study {
namespace {

using tools::Picture;
using Path = std::filesystem::path;

[[noreturn]] void fail(const Path& path, std::string_view error) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), error));
}

Picture read_by_extension(const Path& path) {
    const std::string extension = tools::lower_extension(path);
    if (extension == ".pfm") return sandbox::read_pfm(path);
    if (extension == ".exr") return sandbox::read_exr(path);
    fail(path, "is named neither .pfm nor .exr");
}

Picture read_finite(const Path& path) {
    Picture picture = read_by_extension(path);
    if (const auto pixel = first_not_finite(picture)) {
        fail(path, fmt::format("pixel ({}, {}) is not finite", pixel->x, pixel->y));
    }
    return picture;
}

void require_size(const Path& path, glm::ivec2 found, glm::ivec2 size) {
    if (found == size) return;
    fail(path,
         fmt::format("is {}x{}, not {}x{} as the picture to compare", found.x, found.y, size.x, size.y));
}

/// Reads a picture, which must be finite and have this size.
Picture read_matching(const Path& path, glm::ivec2 size) {
    Picture picture = read_finite(path);
    require_size(path, picture.size, size);
    return picture;
}

/// Empty without a file, which means all pixels.
Mask read_mask(const std::optional<Path>& path, glm::ivec2 size) {
    if (!path) return {};
    const Picture picture = read_matching(*path, size);
    Mask mask;
    mask.reserve(picture.pixels.size());
    for (const glm::vec3& pixel : picture.pixels) mask.push_back(pixel != glm::vec3(0.0F) ? 1 : 0);
    if (std::none_of(mask.begin(), mask.end(), [](std::uint8_t hit) { return hit != 0; })) {
        fail(*path, "masks every pixel");
    }
    return mask;
}

struct Target {
    Halves halves;
    Mask hit;  ///< empty: all pixels
};

Halves light_of(reference::Estimate estimate, std::string_view light) {
    if (light == "direct") return {estimate.direct, estimate.direct};
    if (light == "indirect") return std::move(estimate.halves);
    return halves_of_total(estimate);
}

Target read_target(const Comparison& comparison, glm::ivec2 size) {
    const Path& path = comparison.reference;
    if (!std::filesystem::is_directory(path)) {
        const Picture picture = read_matching(path, size);
        return {{picture, picture}, read_mask(comparison.mask, size)};
    }
    reference::Estimate estimate = read_reference(path).estimate;
    require_size(path, estimate.direct.size, size);
    Mask hit = comparison.mask ? read_mask(comparison.mask, size) : std::move(estimate.hit);
    return {light_of(std::move(estimate), comparison.light), std::move(hit)};
}

void check_flags(const Comparison& comparison) {
    if (comparison.scale && !(*comparison.scale > 0.0 && std::isfinite(*comparison.scale))) {
        throw std::runtime_error(fmt::format("--scale: {} is no relative error above 0", *comparison.scale));
    }
    if (comparison.heat && tools::lower_extension(*comparison.heat) != ".png") {
        fail(*comparison.heat, "a heat map is a PNG picture, and is to be named .png");
    }
}

}  // namespace

std::string compare(const Comparison& comparison) {
    check_flags(comparison);
    const Picture picture = read_finite(comparison.picture);
    const Target target = read_target(comparison, picture.size);
    const Picture reference = mean_of(target.halves);

    const Errors errors = measure(picture, target.halves, target.hit);
    std::string text;
    const auto add = [&](std::string_view name, double value) {
        text += fmt::format("{:<8} {:.6g}\n", name, value);
    };
    add("relMSE", errors.rel_mse);
    add("RMSE", errors.rmse);
    add("bias", errors.bias);
    add("spikes", errors.spikes);
    add("blotch", errors.blotch);
    add("FLIP", tools::flip_of_light(picture, reference, target.hit).mean);
    if (!comparison.heat) return text;
    const HeatMap heat = heat_map(picture, reference, target.hit, comparison.scale);
    tools::write_png(*comparison.heat, heat.size, heat.rgb);
    add("heat", heat.scale);
    return text;
}

}  // namespace candela::study
