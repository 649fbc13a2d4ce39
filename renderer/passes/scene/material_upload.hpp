#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <candela/scene/components.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/scene/use_cache.hpp"

namespace candela {

/// By slot: the number of a material's image in the current scene of a MaterialTable, in the order of first
/// use, normals counted for themselves; 0: no image.
using MaterialImages = std::array<std::uint32_t, material_image_slots.size()>;

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

/// The distinct materials of the scenes, one after the other, with their images on the GPU. What two
/// successive scenes share is uploaded once, and a material keeps its index as long as each scene uses it.
class MaterialTable {
 public:
    explicit MaterialTable(Gpu& gpu) : gpu_(&gpu) {}

    /// Starts another scene. After that, list its materials with `index_of`, and `upload` them.
    void begin();
    /// Index of the material in the table; adds it if it is new.
    [[nodiscard]] std::uint32_t index_of(const std::shared_ptr<const Material>& material);
    /// Uploads what is new, and forgets what is no longer used.
    void upload(Execution& run, BufferHandle<gpu::Material> materials, BufferHandle<std::uint32_t> texels);

    /// The numbers of a material's images, equal for materials that share an image.
    [[nodiscard]] const MaterialImages& images_of(std::uint32_t material) const {
        return by_index_[material].images;
    }
    /// Mean albedo of a material where light is traced; linear RGB.
    [[nodiscard]] glm::vec3 mean_albedo(std::uint32_t material) const;
    [[nodiscard]] MaterialBinding binding_of(std::uint32_t material) const;

    /// By index; null where an index is not in use.
    [[nodiscard]] std::vector<std::shared_ptr<const Material>> materials() const;

 private:
    struct Listed {
        std::shared_ptr<const Material> material;  // null: the index is free
        MaterialImages images{};
    };
    [[nodiscard]] std::uint32_t take_index();
    [[nodiscard]] std::uint32_t number_of(const std::shared_ptr<const Image>& image, std::size_t slot);
    [[nodiscard]] const UploadedImage& image_of(const Listed& listed, std::size_t slot) const;
    [[nodiscard]] gpu::Material record_of(const Listed& listed) const;
    [[nodiscard]] glm::vec3 mean_of_image(const Listed& listed, std::size_t slot) const;

    Gpu* gpu_;
    std::vector<Listed> by_index_;
    std::vector<std::uint32_t> free_;              // indices
    UseCache<Material, std::uint32_t> materials_;  // their indices
    UseCache<Image, UploadedImage> images_;
    UseCache<Image, UploadedImage> normals_;  // of normal_slot
    std::uint32_t texels_end_ = 0;            // see place_ranges
};

}  // namespace candela
