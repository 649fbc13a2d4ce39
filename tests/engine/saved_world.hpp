#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/gltf.hpp>
#include <candela/scene/gltf_export.hpp>
#include <candela/scene/scene_error.hpp>
#include "tests/engine/gltf_builder.hpp"
#include "tests/engine/world_difference.hpp"

/// What tests of the export share: worlds to save, and what differs once they were opened again.
namespace candela::test {

inline World imported(const std::filesystem::path& path) {
    World world;
    CHECK(import_gltf(path, world).warnings.empty());
    return world;
}

/// What differs after saving and opening in one format.
inline std::string difference_after(const World& world, const std::filesystem::path& file) {
    CHECK(export_gltf(world, file).empty());
    return difference(world, imported(file));
}

/// In both formats.
inline std::string difference_after(const World& world) {
    const TemporaryDirectory folder;
    const std::string found = difference_after(world, folder / "a.gltf");
    return found.empty() ? difference_after(world, folder / "a.glb") : found;
}

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The content of each file of a folder, by name.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const std::filesystem::directory_entry& file : std::filesystem::directory_iterator(folder)) {
        files[file.path().filename().string()] = contents(file.path());
    }
    return files;
}

inline std::string error_of_export(const World& world, const std::filesystem::path& path) {
    try {
        static_cast<void>(export_gltf(world, path));
    } catch (const SceneError& error) {
        return error.what();
    }
    return "exported";
}

inline Entity add(World& world, const std::string& name, Entity parent = {}) {
    const Entity entity = world.create();
    world.set(entity, Name{name});
    world.set(entity, Transform{.parent = parent});
    return entity;
}

inline std::shared_ptr<const Image> image(std::uint32_t width, std::uint32_t height, unsigned int seed,
                                          Wrap u, Wrap v) {
    Image made{width, height, {}, u, v};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        seed = seed * 1664525U + 1013904223U;  // Numerical Recipes' generator
        made.texels.emplace_back(seed >> 24U, seed >> 16U & 255U, seed >> 8U & 255U, seed >> 20U & 255U);
    }
    return std::make_shared<const Image>(std::move(made));
}

/// A picture with texels of very different sizes, down to the smallest float.
inline std::shared_ptr<const SkyPicture> sky_picture() {
    SkyPicture picture{8, 4, {}};
    for (int i = 0; i < 32; ++i) {
        picture.texels.emplace_back(std::ldexp(1.1F, i * 4), 1.0F / float(i + 1),
                                    i == 5 ? std::numeric_limits<float>::denorm_min() : 0.0F);
    }
    return std::make_shared<const SkyPicture>(std::move(picture));
}

}  // namespace candela::test
