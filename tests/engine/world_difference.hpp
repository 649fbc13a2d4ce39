#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include <candela/scene/components.hpp>

namespace candela::test {

/// Compares the content of two worlds: the i-th entities of both (sorted, of all that have a Name), all that
/// their components hold, the order of the components of each kind, and which of them share meshes, materials
/// and images.
class WorldComparison {
 public:
    WorldComparison(const World& a, const World& b)
        : a_(a), b_(b), of_a_(named_entities(a)), of_b_(named_entities(b)) {}

    /// The first difference that was found; empty if there is none.
    [[nodiscard]] std::string difference() {
        if (of_a_.size() != of_b_.size() || a_.size() != b_.size()) {
            return fmt::format("{} and {} entities", of_a_.size(), of_b_.size());
        }
        for (std::size_t i = 0; i < of_a_.size() && found_.empty(); ++i) {
            compare_entities(of_a_[i], of_b_[i]);
        }
        compare_order<MeshInstance>("meshes");
        compare_order<PointLight>("point lights");
        compare_order<SpotLight>("spot lights");
        compare_order<DirectionalLight>("directional lights");
        compare_order<Camera>("cameras");
        return found_;
    }

 private:
    static std::vector<Entity> named_entities(const World& world) {
        std::map<Entity, int> entities;
        for (const auto& [entity, name] : world.view<Name>()) {
            entities[entity] = 0;
        }
        std::vector<Entity> sorted;
        for (const auto& [entity, nothing] : entities) {
            sorted.push_back(entity);
        }
        return sorted;
    }

    void expect(bool same, std::string_view what) {
        if (!same && found_.empty()) found_ = fmt::format("entity \"{}\": {}", at_, what);
    }

    /// The entity's place in the sorted list; its length for the null entity.
    static std::size_t place(const std::vector<Entity>& entities, Entity entity) {
        std::size_t i = 0;
        while (i < entities.size() && entities[i] != entity) {
            ++i;
        }
        return i;
    }

    template <class Component>
    void compare_order(const char* what) {
        std::vector<std::size_t> a;
        std::vector<std::size_t> b;
        for (const auto& row : a_.view<Component>()) {
            a.push_back(place(of_a_, std::get<0>(row)));
        }
        for (const auto& row : b_.view<Component>()) {
            b.push_back(place(of_b_, std::get<0>(row)));
        }
        expect(a == b, fmt::format("the order of {}", what));
    }

    template <class Component>
    void compare_component(Entity a, Entity b, const char* what) {
        const auto* const left = a_.find<Component>(a);
        const auto* const right = b_.find<Component>(b);
        expect(!left == !right && (!left || *left == *right), what);
    }

    void compare_entities(Entity a, Entity b) {
        at_ = a_.get<Name>(a).value;
        compare_component<Name>(a, b, "its name");
        compare_component<PointLight>(a, b, "its point light");
        compare_component<SpotLight>(a, b, "its spot light");
        compare_component<DirectionalLight>(a, b, "its directional light");
        compare_component<Camera>(a, b, "its camera");
        compare(a_.find<Transform>(a), b_.find<Transform>(b));
        compare(a_.find<Environment>(a), b_.find<Environment>(b));
        const auto* const mesh_a = a_.find<MeshInstance>(a);
        const auto* const mesh_b = b_.find<MeshInstance>(b);
        compare_shared(mesh_a ? mesh_a->mesh : nullptr, mesh_b ? mesh_b->mesh : nullptr, meshes_, "its mesh");
    }

    void compare(const Transform* a, const Transform* b) {
        expect(!a == !b, "whether it has a transform");
        if (!a || !b) return;
        expect(a->translation == b->translation, "its translation");
        expect(a->rotation == b->rotation, "its rotation");
        expect(a->scale == b->scale, "its scale");
        expect(place(of_a_, a->parent) == place(of_b_, b->parent), "its parent");
    }

    void compare(const Environment* a, const Environment* b) {
        expect(!a == !b, "whether it has an environment");
        if (!a || !b) return;
        expect(a->radiance == b->radiance && a->rotation == b->rotation, "its environment");
        expect(!a->picture == !b->picture, "whether its environment has a picture");
        if (a->picture && b->picture) {
            expect(a->picture->width == b->picture->width && a->picture->height == b->picture->height &&
                       a->picture->texels == b->picture->texels,
                   "the picture of its environment");
        }
    }

    /// Every object of `a` must correspond to a single one of `b`.
    template <class T>
    void compare_shared(const std::shared_ptr<const T>& a, const std::shared_ptr<const T>& b,
                        std::map<const T*, const T*>& known, const char* what) {
        expect(!a == !b, fmt::format("whether it has {}", what));
        if (!a || !b) return;
        const auto [pair, is_new] = known.emplace(a.get(), b.get());
        expect(pair->second == b.get(), fmt::format("what shares {}", what));
        if (is_new) compare(*a, *b);
    }

    void compare(const Mesh& a, const Mesh& b) {
        expect(a.name == b.name, "its mesh's name");
        expect(a.primitives.size() == b.primitives.size(), "the number of its primitives");
        for (std::size_t i = 0; i < a.primitives.size() && i < b.primitives.size(); ++i) {
            expect(a.primitives[i].vertices == b.primitives[i].vertices, "its vertices");
            expect(a.primitives[i].indices == b.primitives[i].indices, "its indices");
            expect(a.primitives[i].second_uvs == b.primitives[i].second_uvs,
                   "its second texture coordinates");
            compare_shared(a.primitives[i].material, b.primitives[i].material, materials_, "its material");
        }
    }

    void compare(const Material& a, const Material& b) {
        expect(a.name == b.name, "its material's name");
        expect(a.base_colour == b.base_colour, "its base colour");
        expect(a.emissive == b.emissive, "its emission");
        expect(a.double_sided == b.double_sided, "whether it is double-sided");
        expect(a.alpha_mode == b.alpha_mode && a.alpha_cutoff == b.alpha_cutoff, "its alpha mode");
        expect(a.metalness == b.metalness && a.roughness == b.roughness, "its metalness and roughness");
        expect(a.specular == b.specular && a.specular_colour == b.specular_colour, "its specular colour");
        expect(a.ior == b.ior, "its index of refraction");
        expect(a.transmission == b.transmission, "its transmission");
        expect(a.normal_scale == b.normal_scale, "the scale of its normal texture");
        expect(a.occlusion_strength == b.occlusion_strength, "the strength of its occlusion");
        expect(a.second_uvs == b.second_uvs, "which textures have second coordinates");
        compare_shared(a.base_colour_texture, b.base_colour_texture, images_, "its texture");
        compare_shared(a.metal_roughness_texture, b.metal_roughness_texture, images_,
                       "its metal-roughness texture");
        compare_shared(a.emissive_texture, b.emissive_texture, images_, "its emissive texture");
        compare_shared(a.normal_texture, b.normal_texture, images_, "its normal texture");
        compare_shared(a.occlusion_texture, b.occlusion_texture, images_, "its occlusion texture");
    }

    void compare(const Image& a, const Image& b) {
        expect(a.width == b.width && a.height == b.height && a.texels == b.texels, "its texels");
        expect(a.encoding == b.encoding, "its texture's encoding");
        expect(a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v, "its texture's wrapping");
    }

    const World& a_;
    const World& b_;
    std::vector<Entity> of_a_;
    std::vector<Entity> of_b_;
    std::map<const Mesh*, const Mesh*> meshes_;
    std::map<const Material*, const Material*> materials_;
    std::map<const Image*, const Image*> images_;
    std::string at_;     ///< name of the entity that is being compared
    std::string found_;  ///< the first difference
};

[[nodiscard]] inline std::string difference(const World& a, const World& b) {
    return WorldComparison(a, b).difference();
}

}  // namespace candela::test
