#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Numbers of images in a MaterialTable; 0: no image.
struct MaterialImages {
    std::uint32_t base_colour = 0;
    std::uint32_t emissive = 0;
};

/// The distinct materials of a scene, in the order in which they are added, with their images on the GPU: as
/// textures for rasterisation, and reduced in one buffer of texels for tracing.
class MaterialTable {
 public:
    explicit MaterialTable(Gpu& gpu) : gpu_(&gpu) {}

    /// Index of the material in the table; adds it if it is new.
    [[nodiscard]] std::uint32_t index_of(const std::shared_ptr<const Material>& material);

    /// The numbers of a material's images, equal for materials that share an image; 0: no image.
    [[nodiscard]] const MaterialImages& images_of(std::uint32_t material) const {
        return images_of_[material];
    }
    /// Base colour of a material times the mean of its image; linear RGB.
    [[nodiscard]] glm::vec3 mean_albedo(std::uint32_t material) const { return mean_albedos_[material]; }
    /// An image on the GPU, by its number; null for 0.
    [[nodiscard]] std::shared_ptr<const MaterialTexture> texture(std::uint32_t image) const;

    [[nodiscard]] const std::vector<std::shared_ptr<const Material>>& materials() const { return materials_; }
    [[nodiscard]] std::span<const gpu::Material> records() const { return records_; }
    /// Texels of all reduced images: sRGB, 8 bits per channel, red in the lowest byte.
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
    std::vector<MaterialImages> images_of_;
    std::vector<glm::vec3> mean_albedos_;
    std::vector<UploadedImage> images_{1};  // the first means "no image"
    std::vector<std::uint32_t> texels_;
    std::unordered_map<const Material*, std::uint32_t> material_index_;
    std::unordered_map<const Image*, std::uint32_t> image_index_;
};

}  // namespace candela
