#include <candela/scene/gltf_export.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/animation.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/gltf.hpp>
#include <candela/scene/tangents.hpp>
#include "sandbox/files/shipped_file.hpp"
#include "tests/engine/gltf_builder.hpp"
#include "tests/engine/saved_world.hpp"
#include "tests/engine/world_difference.hpp"

TEST_SUITE("glTF export") {

using namespace candela;
using namespace candela::test;
namespace fs = std::filesystem;

namespace {

constexpr Entity first_entity{0, 1};  // of any world
constexpr float infinity = std::numeric_limits<float>::infinity();

const fs::path scenes = sandbox::shipped_file("scenes", "");

/// A triangle of any material.
std::shared_ptr<const Mesh> triangle(std::shared_ptr<const Material> material) {
    const glm::vec3 normal(0.0F, 0.0F, 1.0F);
    Primitive primitive{
        {{{0, 0, 0}, normal, {0, 0}}, {{1, 0, 0}, normal, {1, 0}}, {{0, 1, 0}, normal, {0, 1}}},
        {0, 1, 2},
        std::move(material)};
    return std::make_shared<const Mesh>(Mesh{"triangle", {std::move(primitive)}});
}

/// A world with a mesh of this material.
World with_material(const Material& material) {
    World world;
    world.set(add(world, "triangle"), MeshInstance{triangle(std::make_shared<const Material>(material))});
    return world;
}

/// A world with a texture and a picture of the sky, which are files of their own.
World with_pictures() {
    Material material;
    material.base_colour_texture = image(4, 2, 1, Wrap::repeat, Wrap::repeat);
    World world = with_material(material);
    const Entity sky = world.create();
    world.set(sky, Name{"sky"});
    world.set(sky, Environment{glm::vec3(1.0F), sky_picture(), 0.0F});
    return world;
}

template <class Component>
World with(const Component& component) {
    World world;
    world.set(add(world, "it"), component);
    return world;
}

}  // namespace

TEST_CASE("every shipped scene is the same after it was saved and opened") {
    int count = 0;
    for (const fs::directory_entry& file : fs::directory_iterator(scenes)) {
        if (file.path().extension() == ".gltf") {
            CAPTURE(file.path().string());
            CHECK(difference_after(imported(file.path())) == "");
            ++count;
        }
    }
    CHECK(count >= 8);
}

TEST_CASE("the atrium, and a court with a picture of a sky, are the same after they were saved and opened" *
          doctest::test_suite("posix")) {
    const TemporaryDirectory folder;
    const std::string command = fmt::format("python3 '{}' --out '{}' atrium > /dev/null",
                                            (scenes / "generate.py").string(), (folder / "").string());
    REQUIRE(std::system(command.c_str()) == 0);
    World world = imported(folder / "atrium.gltf");
    CHECK(difference_after(world) == "");
    const Entity sky = world.create();
    world.set(sky, Name{"sky"});
    world.set(sky, Environment{glm::vec3(0.1F, 0.2F, 3.0F), sky_picture(), 0.3F});
    CHECK(difference_after(world) == "");
}

TEST_CASE("an empty world is saved") {
    CHECK(difference_after(World()) == "");
}

TEST_CASE("every bit of an emission is kept, however large") {
    for (const float strength : {1e-40F, 0.1F, 1.0F, 1.0000001F, 17.3F, 3.4e38F}) {
        Material material;
        material.emissive = {strength, strength / 3.0F, strength * 0.7F};
        CHECK(difference_after(with_material(material)) == "");
    }
}

TEST_CASE("a surface that shows its colour unlit emits the same after it was saved and opened") {
    GltfBuilder file = right_triangle();
    file.document["extensionsUsed"] = {"KHR_materials_unlit"};
    file.document["images"] = Json::parse(fmt::format(R"([{{"uri": "{}"}}])", sixteen_bit_png));
    file.document["textures"] = Json::parse(R"([{"source": 0}])");
    for (const char* colour : {"[0.3, 0.2, 0.1, 1]", "[0, 0, 0, 1]"}) {
        file.document["materials"] = Json::parse(fmt::format(
            R"([{{"extensions": {{"KHR_materials_unlit": {{}}}}, "pbrMetallicRoughness":
                     {{"baseColorFactor": {}, "baseColorTexture": {{"index": 0}}}}}}])",
            colour));
        file.primitive()["material"] = 0;
        CHECK(difference_after(Imported(file).world) == "");
    }
}

TEST_CASE("derived tangents are kept, factors of 1 are not written, and other meshes have no tangents") {
    const TemporaryDirectory folder;
    Image bumps = *image(2, 2, 1, Wrap::repeat, Wrap::repeat);
    bumps.encoding = Encoding::linear;
    Material material;
    material.normal_texture = std::make_shared<const Image>(bumps);
    material.occlusion_texture = material.normal_texture;
    Mesh mesh = *triangle(std::make_shared<const Material>(material));
    mesh.primitives[0].vertices[0].normal = glm::normalize(glm::vec3(0.3F, -0.2F, 1.0F));
    derive_tangents(mesh.primitives[0]);
    World world;
    world.set(add(world, "bumpy"), MeshInstance{std::make_shared<const Mesh>(mesh)});
    world.set(add(world, "flat"), MeshInstance{triangle(std::make_shared<const Material>())});
    CHECK(difference_after(world) == "");
    static_cast<void>(export_gltf(world, folder / "a.gltf"));
    const Json document = Json::parse(contents(folder / "a.gltf"));
    CHECK(document["meshes"][0]["primitives"][0]["attributes"].contains("TANGENT"));
    CHECK_FALSE(document["meshes"][1]["primitives"][0]["attributes"].contains("TANGENT"));
    CHECK(document["materials"][0]["normalTexture"].dump() == R"({"index":0})");
    CHECK(document["materials"][0]["occlusionTexture"].dump() == R"({"index":0})");
    CHECK_FALSE(document["materials"][1].contains("normalTexture"));
}

TEST_CASE("a mesh without the tangents that its normal texture needs is not written") {
    Image bumps = *image(2, 2, 1, Wrap::repeat, Wrap::repeat);
    bumps.encoding = Encoding::linear;
    Material material;
    material.normal_texture = std::make_shared<const Image>(bumps);
    const TemporaryDirectory folder;
    CHECK(error_of_export(with_material(material), folder / "a.gltf").find("vertex 0 has no tangent") !=
          std::string::npos);
}

TEST_CASE("numbers are written with as few digits as they need") {
    const TemporaryDirectory folder;
    World world;
    world.set(add(world, "it"), Transform{.translation = {0.1F, 1e-7F, 16777216.0F}});
    static_cast<void>(export_gltf(world, folder / "a.gltf"));
    const Json document = Json::parse(contents(folder / "a.gltf"));
    CHECK(document["nodes"][0]["translation"].dump() == "[0.1,1e-07,16777216.0]");
    CHECK_FALSE(document["nodes"][0].contains("rotation"));
    CHECK_FALSE(document["nodes"][0].contains("matrix"));
}

TEST_CASE("shared meshes, materials and images are written once, and surfaces are diffuse") {
    const TemporaryDirectory folder;
    Material material;
    material.base_colour_texture = image(4, 2, 1, Wrap::repeat, Wrap::clamp_to_edge);
    material.emissive = glm::vec3(1.0F);
    material.emissive_texture = material.base_colour_texture;
    const auto shared = std::make_shared<const Material>(material);
    World world;
    const auto mesh = triangle(shared);
    for (const auto& instance : {mesh, mesh, triangle(shared)}) {
        world.set(add(world, "triangle"), MeshInstance{instance});
    }
    static_cast<void>(export_gltf(world, folder / "a.gltf"));
    const Json document = Json::parse(contents(folder / "a.gltf"));
    CHECK(document["nodes"].size() == 3);
    CHECK(document["meshes"].size() == 2);
    CHECK(document["materials"].size() == 1);
    CHECK(document["textures"].size() == 1);
    CHECK(document["images"].size() == 1);
    CHECK(document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] == 0);
    CHECK(files_of(folder / "").size() == 3);  // a.gltf, a.bin, a-0.png
}

TEST_CASE("equal worlds give equal files, also after they were saved and opened") {
    const TemporaryDirectory folder;
    for (const char* name : {"a.gltf", "a.glb"}) {
        World world = imported(scenes / "glass.gltf");
        static_cast<void>(export_gltf(world, folder / name));
        const auto first = files_of(folder / "");
        static_cast<void>(export_gltf(world, folder / name));
        CHECK(files_of(folder / "") == first);
        static_cast<void>(export_gltf(imported(folder / name), folder / name));
        CHECK(files_of(folder / "") == first);
    }
}

TEST_CASE("files beside the scene are found whatever its name is") {
    const TemporaryDirectory folder;
    const World world = with_pictures();
    for (const char* name :
         {"a b.gltf", "100%25.gltf", "Lämpchen#.gltf", ".gltf.gltf", "a.b.GLTF", "x.GLB"}) {
        CAPTURE(name);
        CHECK(difference_after(world, folder / name) == "");
    }
}

TEST_CASE("they are found, too, if its name is one that Windows does not allow" *
          doctest::test_suite("posix")) {
    const TemporaryDirectory folder;
    const World world = with_pictures();
    for (const char* name : {"data:x.gltf", "who?.gltf", "back\\slash.gltf"}) {
        CAPTURE(name);
        CHECK(difference_after(world, folder / name) == "");
    }
}

TEST_CASE("a light that casts no shadow is one after it was saved and opened, and by default it casts one") {
    for (const bool casts_shadow : {false, true}) {
        CHECK(difference_after(with(PointLight{.casts_shadow = casts_shadow})) == "");
        CHECK(difference_after(with(SpotLight{.casts_shadow = casts_shadow})) == "");
        CHECK(difference_after(with(DirectionalLight{.casts_shadow = casts_shadow})) == "");
    }
}

TEST_CASE("an empty name is a name, and without one, the import makes one up") {
    const TemporaryDirectory folder;
    World world;
    world.set(add(world, ""), PointLight{});
    world.set(world.create(), Transform{});
    world.set(world.create(), PointLight{});
    static_cast<void>(export_gltf(world, folder / "a.glb"));
    const World opened = imported(folder / "a.glb");
    std::vector<std::string> names;
    for (const auto& [entity, name] : opened.view<Name>()) {
        names.push_back(name.value);
    }
    CHECK(names == std::vector<std::string>{"", "node 1", "node 2"});
    CHECK(opened.count<PointLight>() == 2);
}

TEST_CASE("a colour above 1 moves to the intensity, and a range of zero becomes tiny") {
    const TemporaryDirectory folder;
    static_cast<void>(export_gltf(
        with(PointLight{.colour = {3.0F, 1.0F, 0.0F}, .intensity = 0.7F, .range = 0.0F}), folder / "a.gltf"));
    const World world = imported(folder / "a.gltf");
    for (const auto& [entity, light] : world.view<PointLight>()) {
        // Two roundings in single precision.
        CHECK(glm::distance(light.colour * light.intensity, glm::vec3(2.1F, 0.7F, 0.0F)) < 1e-6F);
        CHECK(light.range < 1e-30F);
    }
    CHECK(world.count<PointLight>() == 1);
}

TEST_CASE("entities are left out with all that is below them") {
    const TemporaryDirectory folder;
    World world;
    const Entity viewer = add(world, "viewer");
    world.set(viewer, Camera{});
    world.set(add(world, "torch", viewer), PointLight{});
    const Entity room = add(world, "room");
    world.set(add(world, "lamp", room), PointLight{});
    const Entity sky = world.create();
    world.set(sky, Name{"sky"});
    world.set(sky, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    const auto names = [&](const std::vector<Entity>& without) {
        CHECK(export_gltf(world, folder / "a.glb", without).empty());
        std::vector<std::string> left;
        const World saved = imported(folder / "a.glb");
        for (const auto& [entity, name] : saved.view<Name>()) {
            left.push_back(name.value);
        }
        return left;
    };
    CHECK(names({}) == std::vector<std::string>{"viewer", "torch", "room", "lamp", "sky"});
    CHECK(names({viewer}) == std::vector<std::string>{"room", "lamp", "sky"});
    CHECK(names({viewer, room, sky}).empty());
}

TEST_CASE("what glTF cannot hold is named") {
    const TemporaryDirectory folder;
    const auto warnings = [&](const World& world) { return export_gltf(world, folder / "a.glb"); };
    using Lines = std::vector<std::string>;

    CHECK(warnings(with(Camera{.projection = Camera::Projection::custom})) ==
          Lines{"entity \"it\": its camera is left out: glTF has no custom projections"});
    CHECK(warnings(with(SpotLight{.inner_cone = 1.0F, .outer_cone = 0.5F})) ==
          Lines{"entity \"it\": its cones are narrowed: the outer one to 90 degrees, the inner one to the "
                "outer one"});
    CHECK(warnings(with(Transform{.rotation = glm::quat(0.0F, 0.0F, 0.0F, 2.0F)})) ==
          Lines{"entity \"it\": its rotation is not of unit length and will be normalised"});
    CHECK(warnings(with(MeshInstance{std::make_shared<const Mesh>()})) ==
          Lines{"entity \"it\": its mesh has no triangles and is left out"});

    World deformed = with_material({});
    deformed.set(first_entity, DeformedMesh{std::make_shared<const DeformedMesh::Vertices>()});
    CHECK(warnings(deformed) ==
          Lines{"entity \"triangle\": its deformation is left out: its mesh will have its own shape"});
    Skin skin;
    skin.joints.push_back(deformed.create());
    deformed.set(first_entity, skin);
    CHECK(warnings(deformed).empty());
    deformed.destroy(skin.joints[0]);
    CHECK(warnings(deformed) ==
          Lines{"entity \"triangle\": its skin is left out: not all of its joints are nodes"});
    deformed.remove<Skin>(first_entity);
    deformed.set(first_entity, MorphWeights{});
    AnimationPlayer player;
    AnimationClip clip;
    clip.channels.push_back({0, AnimatedProperty::scale, 0});
    player.animations =
        std::make_shared<const Animations>(Animations{{std::make_shared<const AnimationClip>(clip)}, {}});
    deformed.set(first_entity, player);
    CHECK(warnings(deformed) == Lines{"entity \"triangle\": its animations of what is no node are left out"});

    World skies;
    for (const float radiance : {0.0F, 1.0F, 2.0F}) {
        const Entity sky = skies.create();
        skies.set(sky, Name{fmt::format("sky {}", radiance)});
        skies.set(sky, Environment{.radiance = glm::vec3(radiance), .picture = nullptr});
    }
    CHECK(warnings(skies) == Lines{"entity \"sky 0\": its environment is left out: a glTF scene has one",
                                   "entity \"sky 2\": its environment is left out: a glTF scene has one"});
    CHECK(environment_of(imported(folder / "a.glb")) == environment_of(skies));
}

TEST_CASE("what cannot be saved is an error that names it, and leaves the files as they were") {
    const TemporaryDirectory folder;
    const std::string file = (folder / "a.gltf").string();
    static_cast<void>(export_gltf(with_material({}), file));
    const auto before = files_of(folder / "");
    const auto error = [&](const World& world) {
        const std::string message = error_of_export(world, file);
        CHECK(message.starts_with(file + ": "));
        CHECK(files_of(folder / "") == before);
        return message.substr(std::min(message.size(), file.size() + 2));
    };
    CHECK(error(with(Transform{.translation = {0.0F, infinity, 0.0F}})) ==
          "entity \"it\": a number is not finite");
    CHECK(error(with(PointLight{.intensity = -1.0F})) ==
          "entity \"it\": the intensity is negative or not finite");
    CHECK(error(with(Camera{.near_plane = 2.0F, .far_plane = 1.0F})) ==
          "entity \"it\": the far plane at 1 is not beyond the near plane at 2");
    CHECK(error(with(Environment{.radiance = glm::vec3(-1.0F), .picture = nullptr})) ==
          "entity \"it\": the radiance is negative or not finite");
    CHECK(error(with(MeshInstance{})) == "entity \"it\": it has no mesh");
    CHECK(error(with(Name{"\xFF"})).ends_with("a name is not valid UTF-8"));
    Material paint;
    paint.name = "paint";
    paint.base_colour = glm::vec4(2.0F);
    CHECK(error(with_material(paint)) ==
          "entity \"triangle\": material \"paint\": a channel of its base colour is above 1, which glTF "
          "does not allow");
    const auto odd = std::make_shared<const SkyPicture>(SkyPicture{1, 1, {glm::vec3(1.0F)}});
    CHECK(error(with(Environment{glm::vec3(1.0F), odd, 0.0F})) ==
          "entity \"it\": it has 1 × 1 pixels and is not twice as wide as high");

    World two = with(PointLight{});
    two.set(first_entity, SpotLight{});
    CHECK(error(two) == "entity \"it\": it has several lights, but a node of glTF has only one");

    World orphan;
    const Entity parent = add(orphan, "parent");
    add(orphan, "child", parent);
    orphan.destroy(parent);
    CHECK(error(orphan) == "entity \"child\": its parent no longer exists");
    World cycle;
    const Entity a = add(cycle, "a");
    cycle.set(a, Transform{.parent = add(cycle, "b", a)});
    CHECK(error(cycle) == "entity \"a\": its parents form a cycle");
}

TEST_CASE("a file that cannot be written is an error that names it") {
    const TemporaryDirectory folder;
    const World other = imported(scenes / "glass.gltf");
    CHECK(error_of_export(other, folder / "none/a.glb")
              .ends_with("cannot be written: No such file or directory"));
    CHECK(error_of_export(other, folder / "a.txt") ==
          (folder / "a.txt").string() + ": the file's name ends neither in .gltf nor in .glb");
    fs::create_directory(folder / "b.bin");
    CHECK(error_of_export(other, folder / "b.gltf") ==
          (folder / "b.bin").string() + ": cannot be written: Is a directory");
    CHECK_FALSE(fs::exists(folder / "b.gltf"));
}

TEST_CASE("scenes can be opened and saved in several threads at once") {
    const TemporaryDirectory folder;
    const World expected = imported(scenes / "glass.gltf");
    static_cast<void>(export_gltf(expected, folder / "a.glb"));
    const auto open_and_save = [&](int number) {
        World world;
        for (int round = 0; round < 5; ++round) {
            world = World();
            static_cast<void>(import_gltf(folder / "a.glb", world));
            static_cast<void>(export_gltf(world, folder / fmt::format("{}.glb", number).c_str()));
        }
        return world;
    };
    std::vector<std::future<World>> threads;
    for (int number = 0; number < 3; ++number) {
        threads.push_back(std::async(std::launch::async, open_and_save, number));
    }
    for (std::future<World>& thread : threads) {
        CHECK(difference(expected, thread.get()) == "");
    }
    CHECK(contents(folder / "2.glb") == contents(folder / "a.glb"));
}

}  // TEST_SUITE("glTF export")
