#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/scene/use_cache.hpp"

namespace candela {

/// By slot: one more than the number of a material's image in a MaterialTable; 0: no image.
using MaterialImages = std::array<std::uint32_t, material_image_slots.size()>;

/// An image, and what its mip levels depend on.
struct ImageUse {
    const Image* image = nullptr;
    bool normals = false;  ///< it has the levels of normal_levels
    float cutoff = 0.0F;   ///< of a mask, for the image's own alpha; 0: none
    bool operator==(const ImageUse&) const = default;
    [[nodiscard]] bool operator<(const ImageUse& other) const {
        return std::tie(image, normals, cutoff) < std::tie(other.image, other.normals, other.cutoff);
    }
};

/// An image on the GPU: as a texture for rasterisation, and in the buffer of texels for tracing, where large
/// ones are reduced to a mip level.
struct UploadedImage {
    std::shared_ptr<const Image> image;
    std::shared_ptr<const MaterialTexture> texture;
    std::uint32_t width = 0;  ///< of the reduced image
    std::uint32_t height = 0;
    /// Of the reduced image: 8 bits per channel, red the lowest; colours in sRGB, normals as normal_levels
    /// has them. None of other images.
    std::vector<std::uint32_t> texels;
    BufferRange range;     ///< of these texels
    glm::vec3 mean{0.0F};  ///< of the image, decoded
};

/// The materials in use, with their images on the GPU.
class MaterialTable {
 public:
    explicit MaterialTable(Gpu& gpu) : gpu_(&gpu) {}

    /// Returns the index of a material, which stays the same while it is in use, and counts one more use.
    [[nodiscard]] std::uint32_t take(const std::shared_ptr<const Material>& material);
    /// Ends one use. Without any, the material is forgotten by drop_unused.
    void release(const Material& material) { materials_.release(&material); }
    void drop_unused();
    /// Uploads what is new, and brings the materials of the layout up to date.
    void upload(Execution& run, BufferHandle<gpu::Material> materials, BufferHandle<std::uint32_t> texels,
                SceneLayout& layout);

    /// The numbers of a material's images, equal for materials that share an image.
    [[nodiscard]] const MaterialImages& images_of(std::uint32_t material) const {
        return materials_[material].images;
    }
    /// Mean albedo of a material where light is traced; linear RGB.
    [[nodiscard]] glm::vec3 mean_albedo(std::uint32_t material) const;
    [[nodiscard]] MaterialBinding binding_of(std::uint32_t material) const;

 private:
    struct Listed {
        std::shared_ptr<const Material> material;  // null: the index is free
        MaterialImages images{};
    };
    [[nodiscard]] std::uint32_t number_of(const Material& material, std::size_t slot);
    [[nodiscard]] const UploadedImage& image_of(const Listed& listed, std::size_t slot) const;
    [[nodiscard]] gpu::Material record_of(const Listed& listed) const;
    [[nodiscard]] glm::vec3 mean_of_image(const Listed& listed, std::size_t slot) const;
    [[nodiscard]] bool upload_texels(Execution& run, BufferHandle<std::uint32_t> texels);

    Gpu* gpu_;
    UseCache<const Material*, Listed> materials_;
    UseCache<ImageUse, UploadedImage> images_;
    std::vector<std::uint32_t> dropped_;  // indices of materials since the last upload
    RangePlaces texel_places_;
};

}  // namespace candela
