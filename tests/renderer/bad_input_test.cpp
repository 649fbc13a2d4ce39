#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/scene_error.hpp>
#include <candela/scene/tangents.hpp>
#include "renderer/passes/scene/scene_check.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/throws.hpp"

TEST_SUITE("bad input") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{16, 12};
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Sets components of an entity.
using Change = std::function<void(World&, Entity)>;

template <class C>
Change sets(C component) {
    return [=](World& world, Entity entity) { world.set(entity, component); };
}

/// Components with a fault, the words that a message has for it, and components to replace them that have
/// none.
struct FaultCase {
    std::string words;
    Change spoil;
    Change repair;
};

constexpr glm::vec3 in_the_box{0.0F, 1.0F, 0.0F};

MeshInstance square_instance() {
    return {square(0.3F, diffuse({0.9F, 0.1F, 0.2F}))};
}

/// A square with a changed primitive.
Change spoils_primitive(const std::function<void(Primitive&)>& change) {
    Mesh mesh = *square_instance().mesh;
    mesh.name = "patch";
    change(mesh.primitives.at(0));
    return sets(MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
}

/// A square with a changed material.
Change spoils_material(const std::function<void(Material&)>& change) {
    return spoils_primitive([&](Primitive& primitive) {
        Material material = *primitive.material;
        material.name = "paint";
        change(material);
        primitive.material = std::make_shared<const Material>(std::move(material));
    });
}

std::shared_ptr<const Image> image(std::uint32_t width, std::uint32_t height, std::size_t texels) {
    return std::make_shared<const Image>(
        Image{.width = width, .height = height, .texels = std::vector(texels, glm::u8vec4(255))});
}

/// A normal texture.
std::shared_ptr<const Image> flat_normals() {
    return std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {{128, 128, 255, 255}}, .encoding = Encoding::linear});
}

std::vector<FaultCase> mesh_faults() {
    const auto primitive = [](std::string words, const std::function<void(Primitive&)>& change) {
        return FaultCase{std::move(words), spoils_primitive(change), sets(square_instance())};
    };
    const auto material = [](std::string words, const std::function<void(Material&)>& change) {
        return FaultCase{std::move(words), spoils_material(change), sets(square_instance())};
    };
    return {
        {"MeshInstance: left out, because there is no mesh", sets(MeshInstance{}), sets(square_instance())},
        primitive("primitive 0 of mesh \"patch\": it has no material", [](Primitive& p) { p.material = {}; }),
        primitive("index 4, but there are 4 vertices", [](Primitive& p) { p.indices.back() = 4; }),
        primitive("index 4294967295, but", [](Primitive& p) { p.indices.front() = ~0U; }),
        primitive("its 5 indices make no whole number of triangles",
                  [](Primitive& p) { p.indices.pop_back(); }),
        primitive("vertex 2: its position is not finite",
                  [](Primitive& p) { p.vertices[2].position.y = not_a_number; }),
        primitive("vertex 0: its position is not finite",
                  [](Primitive& p) { p.vertices[0].position.x = -infinity; }),
        primitive("vertex 0: its position is farther than 1e+09 metres from the origin",
                  [](Primitive& p) { p.vertices[0].position.x = -1.1e9F; }),
        primitive("vertex 1: its normal is not finite",
                  [](Primitive& p) { p.vertices[1].normal.z = infinity; }),
        primitive("vertex 3: its texture coordinates are not finite",
                  [](Primitive& p) { p.vertices[3].uv.x = not_a_number; }),
        material("material \"paint\": the base colour is negative or not finite",
                 [](Material& m) { m.base_colour.g = not_a_number; }),
        material("the base colour is negative or not finite", [](Material& m) { m.base_colour.r = -1.0F; }),
        material("the base colour is negative or not finite",
                 [](Material& m) { m.base_colour.a = not_a_number; }),
        material("the emission is negative or not finite", [](Material& m) { m.emissive.b = infinity; }),
        material("the emission is negative or not finite", [](Material& m) { m.emissive.b = -1.0F; }),
        material("the alpha cutoff is negative or not a number",
                 [](Material& m) { m.alpha_cutoff = not_a_number; }),
        material("the base colour texture has 5 texels for 2 × 3",
                 [](Material& m) { m.base_colour_texture = image(2, 3, 5); }),
        material("the base colour texture has 0 texels for 0 × 4",
                 [](Material& m) { m.base_colour_texture = image(0, 4, 0); }),
        material("the metalness is not between 0 and 1", [](Material& m) { m.metalness = 1.5F; }),
        material("the roughness is not between 0 and 1", [](Material& m) { m.roughness = not_a_number; }),
        material("the specular strength is not between 0 and 1", [](Material& m) { m.specular = -0.5F; }),
        material("the specular colour is negative or not finite",
                 [](Material& m) { m.specular_colour.g = infinity; }),
        material("the index of refraction is neither 0 nor a finite number of at least 1",
                 [](Material& m) { m.ior = 0.5F; }),
        material("the metal-roughness texture is not encoded as linear values",
                 [](Material& m) { m.metal_roughness_texture = image(2, 3, 6); }),
        material("the emissive texture has 7 texels for 2 × 3",
                 [](Material& m) { m.emissive_texture = image(2, 3, 7); }),
        material("vertex 0 has no tangent, which its normal texture needs: see derive_tangents",
                 [](Material& m) { m.normal_texture = flat_normals(); })};
}

std::vector<FaultCase> deformation_faults() {
    const auto deformed = [](const MeshInstance& instance, std::string words,
                             const std::function<void(DeformedMesh::Vertices&)>& change) {
        const DeformedMesh::Vertices good{instance.mesh->primitives.at(0).vertices};
        DeformedMesh::Vertices bad = good;
        change(bad);
        return FaultCase{std::move(words),
                         [=](World& world, Entity entity) {
                             world.set(entity, instance);
                             world.set(entity,
                                       DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(bad)});
                         },
                         sets(DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(good)})};
    };
    const MeshInstance plain = square_instance();
    FaultCase none = deformed(plain, "DeformedMesh: left out, because there are no vertices", [](auto&) {});
    none.spoil = [=](World& world, Entity entity) {
        world.set(entity, plain);
        world.set(entity, DeformedMesh{});
    };
    Material bumpy = *diffuse({0.9F, 0.1F, 0.2F});
    bumpy.normal_texture = flat_normals();
    Mesh with_tangents = *square(0.3F, std::make_shared<const Material>(std::move(bumpy)));
    derive_tangents(with_tangents.primitives[0]);
    const MeshInstance bumpy_instance{std::make_shared<const Mesh>(std::move(with_tangents))};
    return {
        none,
        deformed(bumpy_instance,
                 "primitive 0: vertex 3 has no tangent, which its normal texture needs: see derive_tangents",
                 [](auto& all) { all[0][3].tangent = glm::i16vec4(0); }),
        deformed(plain, "2 lists of vertices, but mesh \"\" has 1 primitives",
                 [](auto& all) { all.push_back({}); }),
        deformed(plain, "3 vertices, but primitive 0 of mesh \"\" has 4",
                 [](auto& all) { all[0].pop_back(); }),
        deformed(plain, "DeformedMesh: left out, because primitive 0: vertex 1: its position is not finite",
                 [](auto& all) { all[0][1].position.z = not_a_number; })};
}

/// A transform that is not finite, of an entity with a component to be shown.
template <class C>
FaultCase misplaced(C component, Transform transform, Transform right,
                    std::string words = "left out, because the world matrix is not finite") {
    return {std::move(words),
            [=](World& world, Entity entity) {
                world.set(entity, component);
                world.set(entity, transform);
            },
            sets(right)};
}

std::vector<FaultCase> transform_faults() {
    const Transform right = at(in_the_box);
    Transform nowhere = right;
    nowhere.translation.y = not_a_number;
    Transform endless = right;
    endless.scale.x = infinity;
    Transform huge = right;
    huge.scale = glm::vec3(1.1e9F);
    Transform wide = right;
    wide.scale = glm::vec3(1e5F);
    Transform far = right;
    far.translation.z = -1e19F;
    Transform turned = right;
    turned.rotation.w = not_a_number;
    const Change by_parent = [=](World& world, Entity entity) {
        world.set(entity, square_instance());
        world.set(entity, Transform{.parent = add(world, nowhere)});
    };
    return {
        misplaced(square_instance(), nowhere, right),
        misplaced(square_instance(), endless, right),
        misplaced(square_instance(), turned, right),
        misplaced(square_instance(), huge, right, "the world matrix scales by more than 1e+09"),
        misplaced(square_instance(), far, right, "it is farther than 1e+09 metres from the origin"),
        misplaced(MeshInstance{square(1e5F, diffuse(glm::vec3(0.5F)))}, wide, right,
                  "it reaches farther than 1e+09 metres from the origin"),
        misplaced(MeshInstance{square(0.3F, emitter(glm::vec3(2.0F)))}, nowhere, upside_down_at(in_the_box)),
        misplaced(PointLight{.intensity = 0.1F}, nowhere, right),
        misplaced(SpotLight{.intensity = 1.0F, .outer_cone = 1.3F}, turned, right),
        misplaced(DirectionalLight{.illuminance = 0.5F}, turned, looking({0, 1, 3}, {0, 1, 0})),
        {"left out, because the world matrix is not finite", by_parent, sets(right)}};
}

template <class Light>
FaultCase bad_light(std::string words, Light good, const std::function<void(Light&)>& change) {
    Light bad = good;
    change(bad);
    return {std::move(words), sets(bad), sets(good)};
}

std::vector<FaultCase> light_faults() {
    const auto point = [](std::string words, const std::function<void(PointLight&)>& change) {
        return bad_light<PointLight>(std::move(words), {.intensity = 0.1F}, change);
    };
    const auto spot = [](std::string words, const std::function<void(SpotLight&)>& change) {
        return bad_light<SpotLight>(std::move(words), {.intensity = 1.0F, .outer_cone = 1.3F}, change);
    };
    const auto sun = [](std::string words, const std::function<void(DirectionalLight&)>& change) {
        return bad_light<DirectionalLight>(std::move(words), {.illuminance = 0.5F}, change);
    };
    return {
        point("PointLight: left out, because the colour is negative or not finite",
              [](PointLight& light) { light.colour.g = not_a_number; }),
        point("the colour is negative or not finite", [](PointLight& light) { light.colour.r = -1.0F; }),
        point("the intensity is negative or not finite",
              [](PointLight& light) { light.intensity = not_a_number; }),
        point("the intensity is negative or not finite",
              [](PointLight& light) { light.intensity = infinity; }),
        point("the intensity is negative or not finite", [](PointLight& light) { light.intensity = -1.0F; }),
        point("the range is negative or not a number", [](PointLight& light) { light.range = not_a_number; }),
        point("the range is negative or not a number", [](PointLight& light) { light.range = -1.0F; }),
        point("the product of colour and intensity is not finite",
              [](PointLight& light) {
                  light.colour = glm::vec3(1e30F);
                  light.intensity = 1e30F;
              }),
        point("the product of colour and intensity is above 1e+32",
              [](PointLight& light) { light.intensity = 3e37F; }),
        spot("SpotLight: left out, because a cone is negative or not finite",
             [](SpotLight& light) { light.inner_cone = not_a_number; }),
        spot("a cone is negative or not finite", [](SpotLight& light) { light.outer_cone = infinity; }),
        spot("the outer cone of 0 is narrower than 0.0001 radians",
             [](SpotLight& light) { light.outer_cone = 0.0F; }),
        spot("the intensity is negative or not finite",
             [](SpotLight& light) { light.intensity = not_a_number; }),
        spot("the range is negative or not a number", [](SpotLight& light) { light.range = not_a_number; }),
        sun("DirectionalLight: left out, because the illuminance is negative or not finite",
            [](DirectionalLight& light) { light.illuminance = infinity; }),
        sun("the colour is negative or not finite",
            [](DirectionalLight& light) { light.colour.b = not_a_number; })};
}

std::shared_ptr<const SkyPicture> sky_picture(std::uint32_t width, std::uint32_t height, std::size_t texels,
                                              float last = 1.0F) {
    SkyPicture picture{.width = width, .height = height, .texels = std::vector(texels, glm::vec3(1.0F))};
    if (texels > 0) picture.texels.back().g = last;
    return std::make_shared<const SkyPicture>(std::move(picture));
}

std::vector<FaultCase> sky_faults() {
    const auto sky = [](std::string words, glm::vec3 radiance,
                        std::shared_ptr<const SkyPicture> picture = nullptr, float rotation = 0.0F) {
        return FaultCase{
            std::move(words),
            sets(Environment{.radiance = radiance, .picture = std::move(picture), .rotation = rotation}),
            sets(Environment{.radiance = glm::vec3(0.5F), .picture = sky_picture(8, 4, 32)})};
    };
    const glm::vec3 good(1.0F);
    return {sky("Environment: left out, because the radiance is negative or not finite",
                {1.0F, not_a_number, 0.0F}),
            sky("the radiance is negative or not finite", {1.0F, 1.0F, -1.0F}),
            sky("the radiance is negative or not finite", {infinity, 0.0F, 0.0F}),
            sky("the rotation is not finite", good, sky_picture(8, 4, 32), not_a_number),
            sky("the picture has 31 texels for 8 × 4", good, sky_picture(8, 4, 31)),
            sky("the picture has 0 texels for 0 × 0", good, sky_picture(0, 0, 0)),
            sky("the picture holds a radiance that is negative or not finite, in column 7 of row 3", good,
                sky_picture(8, 4, 32, not_a_number)),
            sky("the picture holds a radiance that is negative or not finite, in column 7 of row 3", good,
                sky_picture(8, 4, 32, -1.0F))};
}

Configuration small_configuration() {
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 8;
    configuration.shadows = {.cube_resolution = 16, .map_resolution = 16};
    return configuration;
}

/// A renderer that keeps its warnings.
class Watched {
 public:
    Watched(gl::Device& device, const gl::GetProc& get_proc, bool checked)
        : target_(device, size),
          renderer_(get_proc, {.log = [this](std::string_view line) { lines.emplace_back(line); },
                               .checked = checked}) {
        REQUIRE(renderer_.configure(small_configuration()).empty());
    }

    Picture render(const World& world, Entity camera) {
        renderer_.render(world, camera, target_.target());
        return target_.read();
    }
    [[nodiscard]] Renderer& renderer() { return renderer_; }

    std::vector<std::string> lines;

 private:
    RenderTarget target_;
    TestedRenderer renderer_;
};

class BadInput : public GlFixture {
 protected:
    /// The scene with another entity, which is given these components and is called `name`.
    static Entity add_culprit(Scene& scene, const std::string& name) {
        return add(scene.world, Name{name}, at(in_the_box));
    }

    void check_left_out(const std::vector<FaultCase>& faults) {
        Watched renderer(device, context->get_proc(), false);
        Watched other(device, context->get_proc(), false);
        const Scene usual = cornell_box();
        const Picture without = renderer.render(usual.world, usual.camera);
        CHECK(mean(without) > 0.01);
        for (std::size_t i = 0; i < faults.size(); ++i) {
            CAPTURE(i);
            CAPTURE(faults[i].words);
            Scene scene = usual;
            const std::string name = "culprit " + std::to_string(i);
            const Entity culprit = add_culprit(scene, name);
            renderer.lines.clear();
            faults[i].spoil(scene.world, culprit);
            CHECK(renderer.render(scene.world, scene.camera) == without);
            // Once more, with a pass that finds the fault again.
            scene.world.set(culprit, Transform(scene.world.get<Transform>(culprit)));
            scene.world.edit<Transform>(scene.light, [](Transform& t) { t.translation.x += 0.1F; });
            const Picture moved = renderer.render(scene.world, scene.camera);
            CHECK(is_sane(moved));
            CHECK(moved != without);
            REQUIRE(renderer.lines.size() == 1);
            CHECK(renderer.lines[0].starts_with("entity \"" + name + "\""));
            CHECK(renderer.lines[0].find(faults[i].words) != std::string::npos);

            faults[i].repair(scene.world, culprit);
            const Picture repaired = renderer.render(scene.world, scene.camera);
            CHECK(is_sane(repaired));
            CHECK(repaired != moved);
            other.renderer().invalidate();
            // Drivers may compile the programs of two renderers differently.
            CHECK(relative_mean_square(other.render(scene.world, scene.camera), repaired) < 1e-10);
            CHECK(renderer.lines.size() == 1);
        }
        CHECK(other.lines.empty());
    }

    void check_refused(const std::vector<FaultCase>& faults) {
        Watched renderer(device, context->get_proc(), true);
        Watched other(device, context->get_proc(), false);
        const Scene usual = cornell_box();
        static_cast<void>(renderer.render(usual.world, usual.camera));
        for (const FaultCase& fault : faults) {
            CAPTURE(fault.words);
            Scene scene = usual;
            const Entity culprit = add_culprit(scene, "culprit");
            fault.spoil(scene.world, culprit);
            const auto draw = [&] { static_cast<void>(renderer.render(scene.world, scene.camera)); };
            for (int i = 0; i < 2; ++i) {
                CHECK(throws<SceneError>(draw, "entity \"culprit\""));
                const std::size_t because = fault.words.find("because ");
                CHECK(throws<SceneError>(
                    draw, because == std::string::npos ? fault.words : fault.words.substr(because + 8)));
            }
            fault.repair(scene.world, culprit);
            other.renderer().invalidate();
            CHECK(renderer.render(scene.world, scene.camera) == other.render(scene.world, scene.camera));
        }
        CHECK(renderer.lines.empty());
    }
};

}  // namespace

TEST_CASE_FIXTURE(BadInput, "a mesh with a fault is left out, and the warning names it") {
    check_left_out(mesh_faults());
    check_left_out(deformation_faults());
}
TEST_CASE_FIXTURE(BadInput, "what is nowhere is left out, and the warning names it") {
    check_left_out(transform_faults());
}
TEST_CASE_FIXTURE(BadInput, "a light with a fault is left out, and the warning names it") {
    check_left_out(light_faults());
}
TEST_CASE_FIXTURE(BadInput, "a sky with a fault is left out, and the warning names it") {
    check_left_out(sky_faults());
}

TEST_CASE_FIXTURE(BadInput, "a checked renderer throws, names the entity, and goes on after a repair") {
    check_refused(mesh_faults());
    check_refused(deformation_faults());
    check_refused(transform_faults());
    check_refused(light_faults());
    check_refused(sky_faults());
}

TEST_CASE_FIXTURE(BadInput, "only a checked renderer refuses normals that are not of unit length") {
    Scene scene = cornell_box();
    const Entity culprit = add_culprit(scene, "culprit");
    spoils_primitive([](Primitive& p) { p.vertices[1].normal *= 1.1F; })(scene.world, culprit);
    Watched usual(device, context->get_proc(), false);
    CHECK(is_sane(usual.render(scene.world, scene.camera)));
    CHECK(usual.lines.empty());
    Watched checked(device, context->get_proc(), true);
    CHECK(throws<SceneError>([&] { static_cast<void>(checked.render(scene.world, scene.camera)); },
                             "vertex 1: its normal is 1.1 long"));
}

TEST_CASE_FIXTURE(BadInput, "of several environments, the first without a fault counts") {
    Scene scene = cornell_box();
    Scene good = cornell_box();
    add(scene.world, Environment{.radiance = glm::vec3(not_a_number), .picture = nullptr});
    for (Scene* each : {&scene, &good}) {
        add(each->world, Environment{.radiance = glm::vec3(0.3F), .picture = nullptr});
        add(each->world, Environment{.radiance = glm::vec3(5.0F), .picture = nullptr});
    }
    Watched renderer(device, context->get_proc(), false);
    const Picture picture = renderer.render(scene.world, scene.camera);
    CHECK(renderer.render(good.world, good.camera) == picture);
}

TEST_CASE_FIXTURE(BadInput, "spots that fall between the points of surfels are told, others are not") {
    Scene scene = cornell_box();
    const auto lines_with = [&](float cone, VplPlacement placement) {
        scene.world.set(scene.light, SpotLight{.inner_cone = 0.0F, .outer_cone = cone});
        Watched renderer(device, context->get_proc(), false);
        Configuration configuration = small_configuration();
        configuration.vpls.placement = placement;
        REQUIRE(renderer.renderer().configure(configuration).empty());
        static_cast<void>(renderer.render(scene.world, scene.camera));
        return renderer.lines;
    };
    scene.world.remove<PointLight>(scene.light);
    const std::vector<std::string> lines = lines_with(1e-3F, VplPlacement::surfels);
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].starts_with("spot lights whose light falls between the points of surfels: 1; "));
    CHECK(lines_with(0.5F, VplPlacement::surfels).empty());
    CHECK(lines_with(1e-3F, VplPlacement::paths).empty());
}

TEST_CASE_FIXTURE(BadInput, "more depth maps of VPLs than the driver has room for are refused at once") {
    Watched renderer(device, context->get_proc(), false);
    const Configuration before = renderer.renderer().configuration();
    Configuration configuration = before;
    configuration.vpls.placement = VplPlacement::paths;
    configuration.vpls.count = 1U << 20U;
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 64};
    const std::vector<std::string> errors = renderer.renderer().configure(configuration);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with("depth maps of 1048576 VPLs, 64 texels a side, fill 16384 layers"));
    CHECK(renderer.renderer().configuration() == before);
}

TEST_CASE_FIXTURE(BadInput, "what absorbs next to nothing of its light in a closed room is named") {
    Watched renderer(device, context->get_proc(), false);
    Configuration configuration = small_configuration();
    configuration.vpls.count = 64;
    REQUIRE(renderer.renderer().configure(configuration).empty());
    const auto lines_of = [&](float albedo) {
        renderer.lines.clear();
        const Scene scene = furnace_box(albedo);
        CHECK(is_sane(renderer.render(scene.world, scene.camera)));
        static_cast<void>(renderer.renderer().report());
        return renderer.lines;
    };
    CHECK(lines_of(0.9F).empty());
    CHECK(lines_of(0.999F).empty());
    const std::vector<std::string> of_white = lines_of(1.0F);
    REQUIRE(of_white.size() == 1);
    CHECK(of_white[0].find("absorbs next to nothing") != std::string::npos);
    const std::vector<std::string> of_more = lines_of(1.5F);
    REQUIRE(of_more.size() == 1);  // the other is known already
    CHECK(of_more[0].find("base colour is above 1") != std::string::npos);
}

TEST_CASE_FIXTURE(BadInput, "an entity without a name is called by its index") {
    Scene scene = cornell_box();
    const Entity culprit = add(scene.world, MeshInstance{});
    Watched renderer(device, context->get_proc(), false);
    static_cast<void>(renderer.render(scene.world, scene.camera));
    CHECK(renderer.lines == std::vector{"entity " + std::to_string(culprit.index) +
                                        ", MeshInstance: left out, because there is no mesh"});
}

TEST_CASE_FIXTURE(BadInput, "a camera with a fault is a SceneError that names it, until it is repaired") {
    constexpr float pi = std::numbers::pi_v<float>;
    constexpr auto orthographic = Camera::Projection::orthographic;
    constexpr auto custom = Camera::Projection::custom;
    struct CameraCase {
        Camera camera;
        Transform pose;
        std::string words;
    };
    const std::vector<CameraCase> cases{
        {{.vertical_fov = not_a_number}, {}, "the vertical field of view of nan is not between 0 and pi"},
        {{.vertical_fov = 0.0F}, {}, "the vertical field of view of 0 is not"},
        {{.vertical_fov = pi}, {}, "is not between 0 and pi"},
        {{.near_plane = 0.0F}, {}, "the near plane at 0 is not in front of the camera"},
        {{.near_plane = not_a_number}, {}, "the near plane at nan"},
        {{.near_plane = infinity}, {}, "the near plane at inf"},
        {{.near_plane = 2.0F, .far_plane = 2.0F}, {}, "the far plane at 2 is not beyond"},
        {{.far_plane = not_a_number}, {}, "the far plane at nan is not beyond"},
        {{.projection = orthographic, .half_height = 0.0F, .far_plane = 9.0F}, {}, "the half height of 0"},
        {{.projection = orthographic, .half_height = not_a_number, .far_plane = 9.0F},
         {},
         "the half height of nan"},
        {{.projection = orthographic, .near_plane = -1.0F, .far_plane = 9.0F},
         {},
         "the near plane at -1 is behind the camera"},
        {{.projection = orthographic}, {}, "the far plane at inf is not finite"},
        {{.projection = custom, .matrix = glm::mat4(0.0F)}, {}, "the matrix is not a projection"},
        {{.projection = custom, .matrix = glm::mat4(not_a_number)}, {}, "the matrix is not a projection"},
        {{.projection = custom, .matrix = glm::mat4(1.0F)}, {}, "the far plane at inf is not finite"},
        {{.projection = custom, .matrix = glm::scale(glm::mat4(1.0F), {1, -1, 1})}, {}, "the matrix mirrors"},
        {{}, {.translation = {not_a_number, 0, 0}}, "the world matrix is not finite"},
        {{}, {.scale = glm::vec3(0.0F)}, "the world matrix has no direction"}};
    Watched renderer(device, context->get_proc(), false);
    Scene scene = cornell_box();
    const auto draw = [&] { return renderer.render(scene.world, scene.camera); };
    const Picture before = draw();
    const Camera camera = scene.world.get<Camera>(scene.camera);
    const Transform pose = scene.world.get<Transform>(scene.camera);
    scene.world.set(scene.camera, Name{"the eye"});
    for (const CameraCase& bad : cases) {
        CAPTURE(bad.words);
        scene.world.set(scene.camera, bad.camera);
        scene.world.set(scene.camera, bad.pose);
        CHECK(throws<SceneError>(draw, "entity \"the eye\", Camera: "));
        CHECK(throws<SceneError>(draw, bad.words));
        scene.world.set(scene.camera, camera);
        scene.world.set(scene.camera, pose);
        CHECK(draw() == before);
    }
}

TEST_CASE("a mesh is read once, when it is seen for the first time") {
    World world;
    const Entity entity = world.create();
    std::vector<std::string> lines;
    Log log([&](std::string_view line) { lines.emplace_back(line); });
    SceneCheck check(log, false);
    Mesh mesh = *square_instance().mesh;
    const auto share = [&] { return MeshInstance{{&mesh, [](const Mesh*) {}}}; };
    {
        const MeshInstance first = share();
        CHECK(check.accepts(world, entity, first));
        mesh.primitives.clear();
        mesh.primitives.emplace_back();  // without a material
        CHECK(check.accepts(world, entity, first));
    }
    // Another mesh at the same address, after the first one was destroyed.
    CHECK_FALSE(check.accepts(world, entity, share()));
    mesh.primitives.clear();
    CHECK(check.accepts(world, entity, share()));
    CHECK(lines.size() == 1);
}

TEST_CASE("each line is logged once, and is one line") {
    std::vector<std::string> lines;
    Log log([&](std::string_view line) { lines.emplace_back(line); });
    log.warn("one\nline\n");
    log.warn("one line");
    log.warn("another");
    CHECK(lines == std::vector<std::string>{"one line", "another"});
    log.warn("\x1B[2J");
    CHECK(lines.back() == "\\x1B[2J");
    Log silent({});
    silent.warn("unheard");
}

TEST_CASE("of warnings of one kind, ten are logged") {
    std::vector<std::string> lines;
    Log log([&](std::string_view line) { lines.emplace_back(line); });
    for (int i = 0; i < 20'000; ++i) {
        log.warn(fmt::format("entity {}", i), "left out, because it is faulty");
        log.warn("entity 0", "left out, because it is faulty");  // known
    }
    log.warn("entity 3", "left out, because it is far away");
    REQUIRE(lines.size() == 11);
    CHECK(lines[9] == "entity 9: left out, because it is faulty");
    CHECK(lines[10] == "entity 3: left out, because it is far away");
    for (int frame = 0; frame < 2; ++frame) {
        log.tell_counts();
        CHECK(lines.size() == 12);
        CHECK(lines.back() == "19,990 more: left out, because it is faulty");
    }
    log.warn("entity 20000", "left out, because it is faulty");
    log.tell_counts();
    CHECK(lines.back() == "19,991 more: left out, because it is faulty");
}

}  // TEST_SUITE("bad input")
