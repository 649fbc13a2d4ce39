#include "tests/study/reference_files.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <candela/tools/output_file.hpp>
#include "tests/sandbox/picture_reader.hpp"
#include "tests/study/scene_hash.hpp"

namespace candela::study {
namespace {

namespace fs = std::filesystem;
using tools::Picture;

constexpr const char* description_file = "reference.json";
constexpr std::array picture_files{"direct.pfm", "indirect.pfm", "half0.pfm",      "half1.pfm",
                                   "hit.pfm",    "edge.pfm",     "direct-fine.pfm"};

Picture mask_picture(const Mask& mask, glm::ivec2 size) {
    Picture picture{size, {}};
    picture.pixels.reserve(mask.size());
    for (const std::uint8_t counts : mask) {
        picture.pixels.emplace_back(counts != 0 ? 1.0F : 0.0F);
    }
    return picture;
}

Mask picture_mask(const Picture& picture) {
    Mask mask;
    mask.reserve(picture.pixels.size());
    for (const glm::vec3& pixel : picture.pixels) {
        mask.push_back(pixel.r > 0.5F ? 1 : 0);
    }
    return mask;
}

Json to_json(const Request& request) {
    Json json = {{"scene_hash", request.scene_hash},
                 {"tracer", request.tracer},
                 {"size", {request.size.x, request.size.y}},
                 {"samples", request.samples},
                 {"bounces", nullptr},
                 {"seed", request.seed},
                 {"caustics", request.caustics}};
    if (request.bounces) json["bounces"] = *request.bounces;
    return json;
}

Request request_from(const Json& json) {
    Request request{.scene_hash = json.at("scene_hash"),
                    .tracer = json.at("tracer"),
                    .size = {json.at("size").at(0), json.at("size").at(1)},
                    .samples = json.at("samples"),
                    .bounces = std::nullopt,
                    .seed = json.at("seed"),
                    .caustics = json.value("caustics", true)};
    if (!json.at("bounces").is_null()) request.bounces = json.at("bounces").get<std::uint32_t>();
    return request;
}

Json read_description(const fs::path& folder) {
    try {
        return read_json(folder / description_file);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{} (is it a folder of `reference`?)", error.what()));
    }
}

void write_into(const fs::path& folder, const std::string& scene, const Reference& reference) {
    const reference::Estimate& estimate = reference.estimate;
    const std::array pictures{estimate.direct,
                              estimate.indirect,
                              estimate.halves[0],
                              estimate.halves[1],
                              mask_picture(estimate.hit, estimate.direct.size),
                              mask_picture(estimate.edge, estimate.direct.size),
                              reference.direct_fine};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        write_pfm(folder / picture_files.at(i), pictures.at(i));
    }
    Json description = {{"scene", scene}};
    description.update(to_json(reference.request));
    const Noise of_halves = noise(estimate);
    description["seconds"] = estimate.seconds;
    description["noise"] = {{"indirect", of_halves.indirect}, {"total", of_halves.total}};
    tools::write_text(folder / description_file, to_line(description) + "\n");
}

/// Only files of an earlier reference may be deleted.
void require_replaceable(const fs::path& folder) {
    const bool free = !fs::exists(folder) || (fs::is_directory(folder) && fs::is_empty(folder));
    if (!free && !fs::exists(folder / description_file)) {
        throw std::runtime_error(
            fmt::format("{}: is in use for something else than a reference", folder.string()));
    }
}

/// The folder without a "/" at the end, with which a path would have no file name.
fs::path named(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

fs::path beside(const fs::path& folder, const char* suffix) {
    fs::path path = folder;
    path += fmt::format(".{}.{}", ::getpid(), suffix);
    return path;
}

void swap_in(const fs::path& fresh, const fs::path& folder) {
    const fs::path old = beside(folder, "old");
    if (fs::exists(folder)) fs::rename(folder, old);
    fs::rename(fresh, folder);
    fs::remove_all(old);
}

Picture read_sized(const fs::path& file, glm::uvec2 size) {
    Picture picture = sandbox::read_pfm(file);
    if (glm::uvec2(picture.size) != size) {
        throw std::runtime_error(fmt::format("{}: is {}x{} where {} says {}x{}", file.string(),
                                             picture.size.x, picture.size.y, description_file, size.x,
                                             size.y));
    }
    return picture;
}

}  // namespace

Halves halves_of_total(const reference::Estimate& estimate) {
    return {sum(estimate.direct, estimate.halves[0]), sum(estimate.direct, estimate.halves[1])};
}

Noise noise(const reference::Estimate& estimate) {
    // Halves of variance v have a mean squared difference of 2v; their mean has a variance of v/2.
    const auto of_mean = [&](const Halves& halves) {
        return measure(halves[0], halves[1], estimate.hit).rel_mse / 4.0;
    };
    return {.indirect = of_mean(estimate.halves), .total = of_mean(halves_of_total(estimate))};
}

bool holds(const fs::path& folder, const Request& request) {
    require_replaceable(folder);
    const auto there = [&](const char* file) { return fs::is_regular_file(folder / file); };
    if (!there(description_file) || !std::all_of(picture_files.begin(), picture_files.end(), there)) {
        return false;
    }
    try {
        return request_from(read_description(folder)) == request;
    } catch (const std::exception&) {
        return false;  // written by another version of the study
    }
}

void write_reference(const fs::path& folder, const std::string& scene, const Reference& reference) {
    require_replaceable(folder);
    replace_folder(folder, [&](const fs::path& fresh) { write_into(fresh, scene, reference); });
}

Reference read_reference(const fs::path& folder) {
    const Json description = read_description(folder);
    Reference reference;
    try {
        reference.request = request_from(description);
        reference.estimate.seconds = description.at("seconds");
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error(fmt::format("{}: {}", (folder / description_file).string(), error.what()));
    }
    const auto picture = [&](std::size_t i) {
        return read_sized(folder / picture_files.at(i), reference.request.size);
    };
    reference.estimate.direct = picture(0);
    reference.estimate.indirect = picture(1);
    reference.estimate.halves = {picture(2), picture(3)};
    reference.estimate.hit = picture_mask(picture(4));
    reference.estimate.edge = picture_mask(picture(5));
    reference.direct_fine = picture(6);
    return reference;
}

Reference read_reference_of(const fs::path& scene, const fs::path& folder) {
    Reference reference = read_reference(folder);
    if (reference.request.scene_hash != scene_hash(scene)) {
        throw std::runtime_error(
            fmt::format("{}: is a reference of another scene than {}, or of another state of it",
                        folder.string(), scene.string()));
    }
    return reference;
}

void replace_folder(const fs::path& folder, const std::function<void(const fs::path&)>& fill) {
    const fs::path target = named(fs::absolute(folder));
    const fs::path fresh = beside(target, "part");
    try {
        fs::create_directories(fresh);
        fill(fresh);
        swap_in(fresh, target);
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(fresh, ignored);
        throw;
    }
}

Picture sum(Picture a, const Picture& b) {
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        a.pixels[i] += b.pixels[i];
    }
    return a;
}

Picture difference(Picture a, const Picture& b) {
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        a.pixels[i] -= b.pixels[i];
    }
    return a;
}

}  // namespace candela::study
