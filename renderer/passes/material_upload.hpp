#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/scene/components.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

/// The materials of a scene, each once, in the order in which they are met, with their images on the GPU: as
/// textures for rasterising, and reduced in a buffer of texels for tracing.
class MaterialTable {
 public:
    explicit MaterialTable(Gpu& gpu) : gpu_(&gpu) {}

    /// Place of the material in the table, added if it is new.
    [[nodiscard]] std::uint32_t index_of(const std::shared_ptr<const Material>& material);

    /// Groups materials by image; 0 is none.
    [[nodiscard]] std::uint32_t image_index(std::uint32_t material) const { return image_of_[material]; }
    [[nodiscard]] std::shared_ptr<const MaterialTexture> texture(std::uint32_t material) const;

    [[nodiscard]] const std::vector<std::shared_ptr<const Material>>& materials() const { return materials_; }
    [[nodiscard]] std::span<const gpu::Material> records() const { return records_; }
    /// sRGB, 8 bits a channel, red in the lowest byte.
    [[nodiscard]] std::span<const std::uint32_t> texels() const { return texels_; }

 private:
    struct UploadedImage {
        std::shared_ptr<const MaterialTexture> texture;
        std::uint32_t first_texel = 0;
        std::uint32_t width = 0;
        std::uint32_t height = 0;
    };
    [[nodiscard]] std::uint32_t add_image(const std::shared_ptr<const Image>& image);

    Gpu* gpu_;
    std::vector<std::shared_ptr<const Material>> materials_;
    std::vector<gpu::Material> records_;
    std::vector<std::uint32_t> image_of_;
    std::vector<UploadedImage> images_{1};  // the first stands for none
    std::vector<std::uint32_t> texels_;
    std::unordered_map<const Material*, std::uint32_t> material_index_;
    std::unordered_map<const Image*, std::uint32_t> image_index_;
};

/// Mean albedo of a material over its image, linear.
[[nodiscard]] glm::vec3 mean_albedo(const Material& material);

}  // namespace candela
