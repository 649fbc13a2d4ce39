#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <utility>

#include <candela/scene/components.hpp>
#include "engine/import/export_draft.hpp"

namespace candela::gltf {

/// Adds materials and their textures to a draft, each once.
class MaterialWriter {
 public:
    explicit MaterialWriter(Draft& draft) : draft_(draft) {}

    /// The index of the material. Throws SceneError, which names the material, if glTF does not allow a
    /// value.
    std::size_t index_of(const std::shared_ptr<const Material>& material);

 private:
    [[nodiscard]] Json describe(const Material& material);
    [[nodiscard]] Json texture_info(const std::shared_ptr<const Image>& image, bool has_second_uvs = false);
    std::size_t add_texture(const Image& image);
    std::size_t sampler_of(Wrap u, Wrap v);

    Draft& draft_;
    std::map<std::shared_ptr<const Material>, std::size_t> materials_;
    std::map<std::shared_ptr<const Image>, std::size_t> textures_;
    std::map<std::pair<Wrap, Wrap>, std::size_t> samplers_;
};

}  // namespace candela::gltf
