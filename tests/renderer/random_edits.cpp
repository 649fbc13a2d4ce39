#include "tests/renderer/random_edits.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/tangents.hpp>

namespace candela {
namespace {

/// The last entity of the view.
Entity last_mesh(const World& world) {
    Entity last{};
    for (const auto& [entity, mesh] : world.view<MeshInstance>()) {
        last = entity;
    }
    return last;
}

/// Random texels.
Image noise(std::uint32_t side, std::mt19937& random) {
    Image image{.width = side, .height = side, .texels = {}};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const auto texel = static_cast<std::uint32_t>(random());
        image.texels.emplace_back(texel & 255U, texel >> 8U & 255U, texel >> 16U & 255U, texel >> 24U);
    }
    return image;
}

/// The same for values that are not colours.
std::shared_ptr<const Image> linear_noise(std::uint32_t side, std::mt19937& random) {
    Image image = noise(side, random);
    image.encoding = Encoding::linear;
    return std::make_shared<const Image>(std::move(image));
}

/// A material with an image of random texels, some of them holes; some are glossy, some have normal or
/// occlusion textures.
std::shared_ptr<const Material> textured(std::uint32_t texture_size, std::uint32_t seed) {
    std::mt19937 random(seed);
    Material material;
    material.base_colour_texture = std::make_shared<const Image>(noise(texture_size, random));
    if (seed % 2 == 1) {
        material.normal_texture = linear_noise(texture_size, random);
        material.normal_scale = 0.5F;
    }
    if (seed % 5 < 2) material.occlusion_texture = linear_noise(texture_size, random);
    material.double_sided = true;
    material.roughness = 0.3F;
    material.metalness = seed % 3 == 0 ? 0.5F : 0.0F;
    material.alpha_mode = seed % 4 == 0 ? AlphaMode::mask : AlphaMode::opaque;
    return std::make_shared<const Material>(std::move(material));
}

/// A square as `square`, with the tangents that normal textures need.
std::shared_ptr<const Mesh> square_with_tangents(float half, std::shared_ptr<const Material> material) {
    Mesh mesh = *square(half, std::move(material));
    derive_tangents(mesh.primitives[0]);
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// A sky with a bright side.
std::shared_ptr<const SkyPicture> sky_picture() {
    SkyPicture picture{.width = 8, .height = 4, .texels = std::vector(32, glm::vec3(0.3F, 0.4F, 0.5F))};
    picture.texels[9] = glm::vec3(5.0F);
    return std::make_shared<const SkyPicture>(std::move(picture));
}

}  // namespace

RandomEdits::RandomEdits(Scene edited, const Configuration& rendered, unsigned seed)
    : scene(std::move(edited)),
      configuration(rendered),
      random_(seed),
      block_(last_mesh(scene.world)),
      shared_(textured(16, 1)),
      shared_mesh_(square_with_tangents(0.15F, shared_)) {
    parent_ = add(scene.world, Transform{.translation = {0.0F, 1.0F, 0.0F}, .scale = {-1.0F, 0.8F, 1.2F}});
    add(scene.world, Transform{.translation = {0.4F, 0.1F, 0.2F}, .parent = parent_},
        MeshInstance{square(0.2F, diffuse({0.2F, 0.5F, 0.9F}))});
    add(scene.world, Transform{.translation = {0.3F, 0.3F, -0.1F}, .parent = parent_},
        PointLight{.colour = {1.0F, 0.6F, 0.3F}, .intensity = 0.5F, .range = 3.0F});
}

std::string RandomEdits::next() {
    struct Edit {
        std::string_view name;
        void (RandomEdits::*apply)();
    };
    static constexpr std::array edits{Edit{"the light moves", &RandomEdits::move_light},
                                      Edit{"a mesh moves", &RandomEdits::move_mesh},
                                      Edit{"the parent moves", &RandomEdits::move_parent},
                                      Edit{"the parent mirrors", &RandomEdits::mirror_parent},
                                      Edit{"the light toggles", &RandomEdits::toggle_light},
                                      Edit{"a point comes", &RandomEdits::add_point},
                                      Edit{"a spot comes", &RandomEdits::add_spot},
                                      Edit{"a sun comes", &RandomEdits::add_sun},
                                      Edit{"a mesh comes", &RandomEdits::add_mesh},
                                      Edit{"a mesh coincides with another", &RandomEdits::add_coinciding},
                                      Edit{"a mesh is painted", &RandomEdits::paint_mesh},
                                      Edit{"a mesh becomes another", &RandomEdits::replace_mesh},
                                      Edit{"a mesh deforms", &RandomEdits::deform_mesh},
                                      Edit{"something goes", &RandomEdits::remove_something},
                                      Edit{"something moves", &RandomEdits::move_something},
                                      Edit{"the camera moves", &RandomEdits::move_camera},
                                      Edit{"resize", &RandomEdits::resize},
                                      Edit{"path", &RandomEdits::switch_path},
                                      Edit{"shadows", &RandomEdits::switch_shadows},
                                      Edit{"VPLs", &RandomEdits::switch_vpls},
                                      Edit{"a sky comes", &RandomEdits::add_sky},
                                      Edit{"a lamp comes", &RandomEdits::add_lamp}};
    const std::size_t left_out = emission ? 0 : 2;
    const Edit& edit = edits.at(draw(static_cast<std::uint32_t>(edits.size() - left_out)));
    (this->*edit.apply)();
    return std::string(edit.name) + "; ";
}

void RandomEdits::clear_meshes() {
    std::vector<Entity> meshes;
    for (const auto& [entity, mesh] : scene.world.view<MeshInstance>()) {
        meshes.push_back(entity);
    }
    for (const Entity mesh : meshes) {
        scene.world.remove<MeshInstance>(mesh);
    }
}

void RandomEdits::shift(Entity entity) {
    const float x = offset();
    const glm::vec3 by(x, 0.0F, offset());
    scene.world.edit<Transform>(entity, [&](Transform& pose) { pose.translation += by; });
}

void RandomEdits::mirror_parent() {
    scene.world.edit<Transform>(parent_, [](Transform& pose) { pose.scale.x *= -1.0F; });
}

void RandomEdits::toggle_light() {
    scene.world.edit<PointLight>(
        scene.light, [](PointLight& light) { light.intensity = light.intensity > 0.0F ? 0.0F : 2.0F; });
}

void RandomEdits::add_point() {
    const float x = offset();
    extra_.push_back(add(scene.world, at({x, 1.0F + x, offset()}),
                         PointLight{.intensity = 0.1F + std::abs(x), .range = 2.0F}));
}

void RandomEdits::add_spot() {
    const float x = offset();
    extra_.push_back(add(scene.world, looking({x, 1.5F, offset()}, {0.5F * x, 0.0F, x}),
                         SpotLight{.intensity = 1.0F, .inner_cone = 0.0F, .outer_cone = 0.6F}));
}

void RandomEdits::add_sun() {
    extra_.push_back(
        add(scene.world, looking({offset(), 1.0F, 3.0F}, {0, 0, 0}), DirectionalLight{.illuminance = 0.5F}));
}

void RandomEdits::add_sky() {
    extra_.push_back(add(scene.world, Transform{},
                         Environment{.radiance = glm::vec3(std::abs(offset())),
                                     .picture = draw(2) == 0 ? nullptr : sky_picture()}));
}

void RandomEdits::add_lamp() {
    extra_.push_back(add(scene.world, upside_down_at({offset(), 1.5F, 0.0F}),
                         MeshInstance{square(0.2F, emitter(glm::vec3(1.0F, 0.5F, 0.2F)))}));
}

std::shared_ptr<const Mesh> RandomEdits::any_mesh() {
    const auto colour = diffuse({0.9F, std::abs(offset()), 0.1F}, true);
    switch (draw(6)) {
        case 0:
            return soup(draw(1000) + 1, draw(1000), 0.2F);
        case 1:
            return box_inwards(0.15F, colour);
        case 2:  // shares its material with others
            return square_with_tangents(0.2F, shared_);
        case 3:  // shares all with others
            return shared_mesh_;
        case 4:
            return square_with_tangents(0.2F, textured(4U << draw(5), draw(1000)));
        default:
            return square(0.2F, colour);
    }
}

void RandomEdits::add_mesh() {
    const float x = offset();
    meshes_.push_back(add(scene.world, at({x, 0.6F - x, offset()}), MeshInstance{any_mesh()}));
}

void RandomEdits::add_coinciding() {
    const Entity other = any(meshes_).value_or(block_);
    const Transform pose = scene.world.get<Transform>(other);
    meshes_.push_back(add(scene.world, pose, MeshInstance{square(0.2F, diffuse({0.2F, 0.9F, 0.1F}, true))}));
}

void RandomEdits::paint_mesh() {
    if (!scene.world.find<MeshInstance>(block_)) return;
    Mesh painted = *scene.world.get<MeshInstance>(block_).mesh;
    const auto colour = diffuse({0.3F, std::abs(offset()), 0.4F}, true);
    for (Primitive& primitive : painted.primitives) {
        primitive.material = colour;
    }
    scene.world.set(block_, MeshInstance{std::make_shared<const Mesh>(std::move(painted))});
}

void RandomEdits::replace_mesh() {
    if (const auto mesh = any(meshes_)) {
        scene.world.remove<DeformedMesh>(*mesh);
        scene.world.set(*mesh, MeshInstance{any_mesh()});
    }
}

void RandomEdits::deform_mesh() {
    const auto mesh = any(meshes_);
    if (!mesh) return;
    if (draw(4) == 0) {
        scene.world.remove<DeformedMesh>(*mesh);
        return;
    }
    DeformedMesh::Vertices vertices;
    for (const Primitive& primitive : scene.world.get<MeshInstance>(*mesh).mesh->primitives) {
        vertices.push_back(primitive.vertices);
        for (Vertex& vertex : vertices.back()) vertex.position *= 1.0F + offset();
    }
    scene.world.set(*mesh, DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(std::move(vertices))});
}

std::optional<Entity> RandomEdits::any(const std::vector<Entity>& entities) {
    if (entities.empty()) return std::nullopt;
    return entities[draw(static_cast<std::uint32_t>(entities.size()))];
}

void RandomEdits::remove_something() {
    std::vector<Entity>& entities = draw(2) == 0 ? meshes_ : extra_;
    if (const auto gone = any(entities)) {
        scene.world.destroy(*gone);
        std::erase(entities, *gone);
    }
}

void RandomEdits::move_something() {
    const auto moved = any(draw(2) == 0 ? meshes_ : extra_);
    if (!moved) return;
    shift(*moved);
    if (scene.world.find<Environment>(*moved)) {
        scene.world.edit<Environment>(*moved, [](Environment& sky) { sky.rotation += 1.0F; });
    }
}

void RandomEdits::move_camera() {
    const float x = 0.1F * offset();
    const glm::vec3 by(x, 0.0F, 0.1F * offset());
    scene.world.edit<Transform>(scene.camera, [&](Transform& pose) { pose.translation += by; });
}

void RandomEdits::resize() {
    size = std::array{glm::uvec2(40, 30), glm::uvec2(33, 21), glm::uvec2(64, 8)}.at(draw(3));
}

void RandomEdits::switch_path() {
    configuration.path = all_shading_paths.at(draw(all_shading_paths.size()));
    configuration.interleave = static_cast<Interleave>(draw(5));
}

void RandomEdits::switch_shadows() {
    configuration.shadows.enabled = !configuration.shadows.enabled;
}

void RandomEdits::switch_vpls() {
    configuration.vpls.count = std::array{0U, 8U, 24U}.at(draw(3));
    configuration.vpls.placement = draw(2) == 0 ? VplPlacement::surfels : VplPlacement::paths;
    configuration.visibility.method = static_cast<VplVisibility>(draw(3));
}

}  // namespace candela
