// Resources of the running frame graph, shown as pictures.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include <candela/extension.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/inspection.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/texels.hpp"

TEST_SUITE("inspection") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// The picture stores 8 bits a channel.
constexpr double step = 1.0 / 255.0;

double srgb_encoded(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

class InspectionTests : public PathFixture {
 protected:
    /// What is shown in the next frame.
    [[nodiscard]] InspectionResult look(const Scene& scene, const Inspection& wanted,
                                        glm::uvec2 target = size) {
        const std::vector<std::string> errors = inspector.show(wanted);
        REQUIRE(errors == std::vector<std::string>{});
        static_cast<void>(render(scene, target));
        return inspector.result();
    }

    [[nodiscard]] std::vector<glm::vec4> picture_of(const InspectionResult& result) {
        return texels(device.gl(), {result.texture, result.size});
    }

    void check_range(const InspectionResult& result, double low, double high, double tolerance) {
        CAPTURE(result.description);
        CHECK(std::abs(result.low - low) <= tolerance);
        CHECK(std::abs(result.high - high) <= tolerance);
    }

    /// Lists as the buffer `name` has them, by cell.
    [[nodiscard]] std::vector<std::uint32_t> lengths(std::size_t cells) {
        const BufferElements read = inspector.read_buffer(0, cells);
        CHECK(read.stride == sizeof(std::uint32_t));
        REQUIRE(read.bytes.size() == cells * sizeof(std::uint32_t));
        std::vector<std::uint32_t> counts(cells);
        std::memcpy(counts.data(), read.bytes.data(), read.bytes.size());
        return counts;
    }

    ResourceInspector inspector{renderer};
};

/// Names of the resources of a graph, without those of the inspection itself.
std::vector<std::string> resources_of(const Renderer& renderer, ResourceKind kind) {
    std::vector<std::string> names;
    for (const DescribedResource& resource : renderer.description().resources) {
        if (resource.kind == kind && !resource.name.starts_with("inspect")) names.push_back(resource.name);
    }
    return names;
}

/// A pass of the host's that fills a texture: texel (x, y) of a mip and layer is `value(mip, layer, x, y)`.
template <class T, class Value>
Extension painting(const gl::Functions& gl, const TextureDesc& desc, Value value) {
    Extension extension{.name = "paint", .place = ExtensionPlace::after_surfaces};
    extension.declare = [=, &gl](FrameGraph& graph, ViewFrame&) {
        graph.add("paint", [&](Pass& pass) {
            const TextureHandle blank = graph.texture("painting", desc);
            const TextureHandle out = pass.write(blank, Usage::copy);
            pass.run([=, &gl](Execution& run) {
                const gl::FormatInfo info = gl::format_info(desc.format);
                for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
                    const glm::uvec2 texels = glm::max(desc.size >> mip, glm::uvec2(1));
                    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
                        std::vector<T> content;
                        for (std::uint32_t i = 0; i < texels.x * texels.y; ++i) {
                            content.push_back(value(mip, layer, i % texels.x, i / texels.x));
                        }
                        const auto level = static_cast<GLint>(mip), width = static_cast<GLint>(texels.x),
                                   height = static_cast<GLint>(texels.y);
                        const GLenum type = info.type == GL_HALF_FLOAT ? GL_FLOAT : info.type;
                        if (desc.shape == TextureShape::flat) {
                            gl.TextureSubImage2D(run.object(out), level, 0, 0, width, height, info.layout,
                                                 type, content.data());
                        } else {
                            gl.TextureSubImage3D(run.object(out), level, 0, 0, static_cast<GLint>(layer),
                                                 width, height, 1, info.layout, type, content.data());
                        }
                    }
                }
            });
        });
    };
    return extension;
}

}  // namespace

TEST_CASE_FIXTURE(InspectionTests, "the camera's depth in metres") {
    Scene scene = ground();
    scene.world.set(scene.camera, looking({0.0F, 3.0F, 0.0F}, {0, 0, 0}, {0, 0, -1}));
    configure(linear_configuration());
    for (const float far_plane : {infinity, 20.0F}) {
        for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
            scene.world.set(scene.camera, Camera{.projection = projection, .far_plane = far_plane});
            if (projection == Camera::Projection::orthographic && far_plane == infinity) continue;
            // Depths are rounded to 2^-24.
            const InspectionResult result = look(scene, {.resource = "depth"});
            check_range(result, 3.0, 3.0, 1e-4);
            CHECK(result.unit == "m");
            CHECK(result.mapping == Mapping::depth);
            CHECK(result.size == size);
        }
    }
    // A grey for every depth, black where there is nothing.
    scene.world.set(scene.camera, looking({0.0F, 1.0F, 3.0F}, {0, 1, 0}));
    scene.world.set(scene.camera, Camera{});
    const InspectionResult result = look(scene, {.resource = "depth"});
    REQUIRE(result.high > result.low);
    const std::vector<glm::vec4> picture = picture_of(result);
    const Camera camera;
    const auto& pose = scene.world.get<Transform>(scene.camera);
    std::size_t surfaces = 0;
    for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
        const PixelRay ray = pixel_ray(camera, pose, size, i % size.x, i / size.x);
        const double t = -ray.origin.y / ray.direction.y;
        const glm::dvec3 hit = ray.origin + t * ray.direction;
        double grey = 0.0;
        if (t > 0.0 && std::max(std::abs(hit.x), std::abs(hit.z)) < 4.0) {
            grey = 1.0 - (3.0 - hit.z - result.low) / (result.high - result.low);
            ++surfaces;
        }
        CHECK(std::abs(picture[i].r - grey) < step);
    }
    CHECK(surfaces > 50);
    CHECK(surfaces < picture.size());
}

TEST_CASE_FIXTURE(InspectionTests, "shadow maps in metres along their axes, face by face") {
    Scene scene = ground();
    configure(linear_configuration());
    scene.world.set(scene.light, at({0.0F, 2.0F, 0.0F}));
    scene.world.set(scene.light, PointLight{});
    // The ground has no slope in the face that looks down, and so no offset.
    const InspectionResult down = look(scene, {.resource = "shadow cubes", .layer = 3});
    check_range(down, 2.0, 2.0, 1e-3);
    CHECK(down.layers == 6);
    CHECK(down.unit == "m");
    const InspectionResult up = look(scene, {.resource = "shadow cubes", .layer = 2});
    check_range(up, 0.0, 0.0, 0.0);
    CHECK(
        std::ranges::all_of(picture_of(up), [](glm::vec4 texel) { return texel == glm::vec4(0, 0, 0, 1); }));

    // Parallel light from above: an object half a metre above the ground.
    scene.world.remove<PointLight>(scene.light);
    scene.world.set(scene.light, looking({0, 0, 0}, {0, -1, 0}, {0, 0, -1}));
    scene.world.set(scene.light, DirectionalLight{});
    add(scene.world, at({0.0F, 0.5F, 0.0F}), MeshInstance{square(0.4F, diffuse(glm::vec3(0.5F)))});
    const InspectionResult sun = look(scene, {.resource = "shadow maps"});
    CHECK(std::abs(sun.high - sun.low - 0.5F) < 1e-3);
    CHECK(sun.unit == "m");

    // As stored, the values are those of reversed depth.
    const InspectionResult stored = look(scene, {.resource = "shadow maps", .mapping = Mapping::colour});
    CHECK(stored.unit.empty());
    CHECK(stored.low == 0.0F);
    CHECK(stored.high > 0.0F);
    CHECK(stored.high <= 1.0F);
}

TEST_CASE_FIXTURE(InspectionTests, "depth maps of VPLs hold the distances in a closed box") {
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::maps;
    configure(configuration);
    const InspectionResult result = look(furnace_box(0.5F), {.resource = "vpl maps", .longest = 512});
    CHECK(result.unit == "m");
    // The box is 2 m wide, and octahedral distances are up to √3 times as long as distances.
    CHECK(result.low > 0.0F);
    CHECK(result.high > 2.0F);
    CHECK(result.high < 6.0F);
    CHECK(std::max(result.size.x, result.size.y) == 512);
}

TEST_CASE_FIXTURE(InspectionTests, "lengths of light lists, by tile and by cluster") {
    const Scene scene = shipped_scene("hall-256");
    constexpr glm::uvec2 target{150, 110};
    for (const ShadingPath path : {ShadingPath::tiled_forward, ShadingPath::clustered_forward}) {
        CAPTURE(to_string(path));
        Configuration configuration = direct_only();
        configuration.path = path;
        configure(configuration);
        const bool tiled = path == ShadingPath::tiled_forward;
        const std::uint32_t side = configuration.lists.tile_size;
        const glm::uvec2 tiles = (target + side - 1U) / side;
        const std::uint32_t slices = tiled ? 1 : configuration.lists.slices;
        Inspection wanted{.resource = tiled ? "light-tiles count" : "light-clusters count",
                          .layer = Inspection::all_slices};
        const InspectionResult all = look(scene, wanted, target);
        CHECK(all.unit == "lights");
        CHECK(all.mapping == Mapping::heat);
        CHECK(all.layers == slices);
        CHECK(all.size == target);
        const std::vector<std::uint32_t> counts = lengths(std::size_t{tiles.x} * tiles.y * slices);
        const LightReport lights = renderer.report().lights;
        CHECK(static_cast<std::uint32_t>(all.high) + lights.global == lights.tile_max);
        CHECK(all.high > all.low);

        for (const std::uint32_t slice : {Inspection::all_slices, slices / 2}) {
            wanted.layer = slice;
            wanted.range = ValueRange{0.0F, all.high};
            const InspectionResult result = look(scene, wanted, target);
            const std::vector<glm::vec4> picture = picture_of(result);
            std::size_t wrong = 0;
            for (std::uint32_t i = 0; i < target.x * target.y; ++i) {
                const glm::uvec2 tile = glm::uvec2(i % target.x, i / target.x) / side;
                std::uint32_t longest = 0;
                for (std::uint32_t z = 0; z < slices; ++z) {
                    const std::uint32_t count = counts[(z * tiles.y + tile.y) * tiles.x + tile.x];
                    if (slice == Inspection::all_slices || slice == z) longest = std::max(longest, count);
                }
                const glm::vec3 expected = heat_colour(static_cast<float>(longest) / all.high);
                wrong += glm::distance(expected, glm::vec3(picture[i])) < 2.0 * step ? 0 : 1;
            }
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE_FIXTURE(InspectionTests, "mip levels and layers, of floats and of integers") {
    configure(linear_configuration());
    const Scene scene = ground();
    const TextureDesc floats{{8, 4}, Format::rgba32f, TextureShape::array, 3, 3};
    const auto colour = [](std::uint32_t mip, std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
        return glm::vec4(mip * 10 + layer, x, y, 0.5F);
    };
    REQUIRE(renderer.extend(painting<glm::vec4>(device.gl(), floats, colour)).empty());
    Inspection wanted{.resource = "painting", .channels = Channels::red};
    for (std::uint32_t mip = 0; mip < 3; ++mip) {
        for (std::uint32_t layer = 0; layer < 3; ++layer) {
            wanted.mip = mip;
            wanted.layer = layer;
            wanted.mapping = Mapping::heat;
            const InspectionResult result = look(scene, wanted);
            check_range(result, mip * 10 + layer, mip * 10 + layer, 0.0);
            CHECK(result.size == glm::uvec2(8 >> mip, 4 >> mip));
            CHECK(result.mips == 3);
            CHECK(result.layers == 3);
        }
    }
    // What does not exist is the last that does.
    wanted.mip = wanted.layer = 9;
    check_range(look(scene, wanted), 22.0, 22.0, 0.0);
    // Each channel on its own, in a given range.
    wanted = {.resource = "painting", .mapping = Mapping::colour, .range = ValueRange{0.0F, 16.0F}};
    const std::array<double, 4> values{2.0, 7.0, 3.0, 0.5};
    wanted.layer = 2;
    for (const auto channel : {Channels::red, Channels::green, Channels::blue, Channels::alpha}) {
        wanted.channels = channel;
        const glm::vec4 last = picture_of(look(scene, wanted)).back();  // texel (7, 3)
        const double grey = srgb_encoded(values.at(static_cast<std::size_t>(channel)) / 16.0);
        CHECK(std::abs(last.r - grey) < step);
        CHECK(last.r == last.g);
        CHECK(last.r == last.b);
    }
    wanted.channels = Channels::rgb;
    const glm::vec4 last = picture_of(look(scene, wanted)).back();
    CHECK(std::abs(last.g - srgb_encoded(7.0 / 16.0)) < step);
    CHECK(std::abs(last.b - srgb_encoded(3.0 / 16.0)) < step);

    const TextureDesc integers{{5, 3}, Format::r32ui};
    const auto count = [](std::uint32_t, std::uint32_t, std::uint32_t x, std::uint32_t y) {
        return 1000 + 5 * y + x;
    };
    REQUIRE(renderer.extend(painting<std::uint32_t>(device.gl(), integers, count)).empty());
    const InspectionResult result = look(scene, {.resource = "painting"});
    check_range(result, 1000.0, 1014.0, 0.0);
    CHECK(result.mapping == Mapping::heat);
    const std::vector<glm::vec4> picture = picture_of(result);
    for (std::size_t i = 0; i < picture.size(); ++i) {
        CHECK(glm::distance(glm::vec3(picture[i]), heat_colour(static_cast<float>(i) / 14.0F)) < 2.0 * step);
    }
}

TEST_CASE_FIXTURE(InspectionTests, "faulty values are magenta, and do not count for the range") {
    configure(linear_configuration());
    const std::array<float, 6> row{not_a_number, 2.0F, infinity, -infinity, -4.0F, 0.0F};
    const auto value = [&](std::uint32_t, std::uint32_t, std::uint32_t x, std::uint32_t) {
        return row.at(x);
    };
    REQUIRE(renderer.extend(painting<float>(device.gl(), {{6, 1}, Format::r32f}, value)).empty());
    const Scene scene = ground();
    const InspectionResult result = look(scene, {.resource = "painting"});
    check_range(result, -4.0, 2.0, 0.0);
    const std::vector<glm::vec4> picture = picture_of(result);
    for (const std::size_t faulty : {0U, 2U, 3U}) {
        CHECK(picture[faulty] == glm::vec4(1.0F, 0.0F, 1.0F, 1.0F));
    }
    CHECK(glm::distance(glm::vec3(picture[1]), heat_colour(1.0F)) < 2.0 * step);
    CHECK(glm::distance(glm::vec3(picture[4]), heat_colour(0.0F)) < 2.0 * step);
    // The range of colours includes black.
    check_range(look(scene, {.resource = "painting", .mapping = Mapping::colour}), -4.0, 2.0, 0.0);
}

TEST_CASE_FIXTURE(InspectionTests,
                  "values are counted in equal parts of the range, and faulty ones by themselves") {
    configure(linear_configuration());
    // 0 to 127, and two that are no numbers, in 13 rows of 10.
    const auto value = [&](std::uint32_t, std::uint32_t, std::uint32_t x, std::uint32_t y) {
        const std::uint32_t i = 10 * y + x;
        return i < 128 ? static_cast<float>(i) : i == 128 ? not_a_number : infinity;
    };
    REQUIRE(renderer.extend(painting<float>(device.gl(), {{10, 13}, Format::r32f}, value)).empty());
    const Scene scene = ground();
    const InspectionResult all = look(scene, {.resource = "painting"});
    CHECK(all.least == 0.0F);
    CHECK(all.greatest == 127.0F);
    CHECK(all.faulty == 2);
    CHECK(all.histogram == std::vector<std::uint32_t>(64, 2));
    // The range that is shown is not that of the values.
    const InspectionResult part = look(scene, {.resource = "painting", .range = ValueRange{31.5F, 95.5F}});
    CHECK(part.histogram == std::vector<std::uint32_t>(64, 1));
    CHECK(part.least == 0.0F);
    CHECK(part.greatest == 127.0F);
    CHECK(part.faulty == 2);

    // Of colours, each channel.
    const auto colour = [](std::uint32_t, std::uint32_t, std::uint32_t x, std::uint32_t) {
        return glm::vec4(x < 3 ? 0.0F : 1.0F, 0.5F, 1.0F, 9.0F);
    };
    REQUIRE(renderer.extend(painting<glm::vec4>(device.gl(), {{4, 2}, Format::rgba32f}, colour)).empty());
    const InspectionResult coloured = look(scene, {.resource = "painting"});
    REQUIRE(coloured.histogram.size() == 3 * 64);
    CHECK(coloured.histogram[0] == 6);
    CHECK(coloured.histogram[63] == 2);
    CHECK(coloured.histogram[64 + 32] == 8);
    CHECK(coloured.histogram[128 + 63] == 8);
}

TEST_CASE_FIXTURE(InspectionTests, "the values of a texel, of its mip and layer, and of depths in metres") {
    configure(linear_configuration());
    Scene scene = ground();
    const TextureDesc floats{{8, 4}, Format::rgba32f, TextureShape::array, 3, 3};
    const auto colour = [](std::uint32_t mip, std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
        return glm::vec4(mip * 10 + layer, x, y, 0.5F);
    };
    REQUIRE(renderer.extend(painting<glm::vec4>(device.gl(), floats, colour)).empty());
    Inspection wanted{.resource = "painting"};
    CHECK_FALSE(look(scene, wanted).texel);
    wanted.texel = glm::uvec2(5, 3);
    wanted.layer = 2;
    const InspectionResult first = look(scene, wanted);
    CHECK(first.extent == glm::uvec2(8, 4));
    REQUIRE(first.texel);
    CHECK(*first.texel == InspectedTexel{{5, 3}, {2.0F, 5.0F, 3.0F, 0.5F}, 4, {}});
    // Another texel changes nothing else.
    wanted.texel = glm::uvec2(1, 0);
    CHECK(look(scene, wanted).texel->channels == glm::vec4(2.0F, 1.0F, 0.0F, 0.5F));
    CHECK(ran("inspect-texel"));
    CHECK_FALSE(ran("inspect-range"));
    CHECK_FALSE(ran("inspect-histogram"));
    wanted.mip = 1;
    wanted.texel = glm::uvec2(99, 99);
    CHECK(look(scene, wanted).texel == InspectedTexel{{3, 1}, {12.0F, 3.0F, 1.0F, 0.5F}, 4, {}});

    scene.world.set(scene.camera, looking({0.0F, 3.0F, 0.0F}, {0, 0, 0}, {0, 0, -1}));
    const InspectionResult depth = look(scene, {.resource = "depth", .texel = size / 2U});
    REQUIRE(depth.texel);
    REQUIRE(depth.texel->metres);
    CHECK(std::abs(*depth.texel->metres - 3.0F) < 1e-4F);
    CHECK(depth.texel->channel_count == 1);
}

TEST_CASE("the colours of a heat map become lighter with the value") {
    const auto decoded = [](float c) {
        return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
    };
    float before = -1.0F;
    for (int i = 0; i <= 32; ++i) {
        const glm::vec3 colour = heat_colour(static_cast<float>(i) / 32.0F);
        const float luminance =
            0.2126F * decoded(colour.r) + 0.7152F * decoded(colour.g) + 0.0722F * decoded(colour.b);
        CHECK(luminance > before);
        before = luminance;
    }
    CHECK(heat_colour(-1.0F) == heat_colour(0.0F));
    CHECK(heat_colour(2.0F) == heat_colour(1.0F));
}

TEST_CASE_FIXTURE(InspectionTests, "every resource of every path can be inspected") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::maps;
    configuration.interleave = Interleave::two;
    configuration.refinement = {.enabled = true, .frames = 4};
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        configuration.path = path;
        configure(configuration);
        static_cast<void>(render(scene, size));
        for (const std::string& name : resources_of(renderer, ResourceKind::texture)) {
            CAPTURE(name);
            const InspectionResult result = look(scene, {.resource = name, .longest = 64});
            CHECK((result.texture == 0) == (name == "target"));
            CHECK(result.high >= result.low);
        }
        for (const std::string& name : resources_of(renderer, ResourceKind::buffer)) {
            CAPTURE(name);
            const InspectionResult result = look(scene, {.resource = name, .longest = 64});
            CHECK((result.texture != 0) == name.ends_with(" count"));
            const BufferElements read = inspector.read_buffer(0, 5);
            CHECK(read.count > 0);
            CHECK(read.bytes.size() == std::min<std::uint64_t>(read.count, 5) * read.stride);
            CHECK(inspector.read_buffer(read.count, 1).bytes.empty());
            CHECK_FALSE(read.fields.empty());
        }
        CHECK(inspector.show({}).empty());
    }
}

TEST_CASE_FIXTURE(InspectionTests, "numbers of vertices are those of the scene's mesh, by their types") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    static_cast<void>(look(scene, {.resource = "vertices"}));
    const BufferElements read = inspector.read_buffer(0, 4);
    REQUIRE(read.fields.size() == 5);
    const auto numbers = [&](std::string_view name) {
        const auto field = std::ranges::find(read.fields, name, &ElementField::name);
        REQUIRE(field != read.fields.end());
        return numbers_of(read, *field, 0);
    };
    // A white vertex without a tangent. As floats, the 16-bit numbers of white are no numbers.
    CHECK(numbers("colour") == std::vector<double>{1.0, 1.0, 1.0, 1.0});
    CHECK(numbers("tangent") == std::vector<double>(4, 0.0));
    const std::vector<double> normal = numbers("normal");
    CHECK(std::abs(std::hypot(normal[0], normal[1], normal[2]) - 1.0) < 1e-6);
    CHECK_THROWS_AS(static_cast<void>(numbers_of(read, read.fields[0], 4)), std::out_of_range);
}

TEST_CASE("numbers are read by their type") {
    BufferElements elements{.bytes = {}, .stride = 8, .count = 1};
    const std::array<std::uint16_t, 4> halves{0xffff, 0x8000, 0x7fff, 0xffff};
    elements.bytes.resize(sizeof halves);
    std::memcpy(elements.bytes.data(), halves.data(), sizeof halves);
    const auto read = [&](NumberType type, std::uint32_t offset) {
        return numbers_of(elements, {"", type, 1, offset}, 0).front();
    };
    CHECK(read(NumberType::unorm16, 0) == 1.0);
    CHECK(read(NumberType::snorm16, 2) == -1.0);
    CHECK(read(NumberType::snorm16, 4) == 1.0);
    CHECK(read(NumberType::snorm16, 6) == -1.0 / 32767.0);
    CHECK(read(NumberType::uint32, 4) == 4294934527.0);  // 0xffff7fff
    CHECK(read(NumberType::int32, 4) == -32769.0);
    CHECK(std::isnan(read(NumberType::float32, 4)));
}

TEST_CASE_FIXTURE(InspectionTests, "a description has the sizes of what exists") {
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::maps;
    configure(configuration);
    const auto maps_of = [&] {
        const GraphDescription graph = renderer.description();
        const auto maps = std::ranges::find(graph.resources, "vpl maps", &DescribedResource::name);
        REQUIRE(maps != graph.resources.end());
        return maps->texture;
    };
    const InspectionResult result = look(cornell_box(), {.resource = "vpl maps"});
    const TextureDesc maps = maps_of();
    CHECK(maps.size.x > 1);
    CHECK(result.description.find(fmt::format("{} × {} texels", maps.size.x, maps.size.y)) !=
          std::string::npos);
}

TEST_CASE_FIXTURE(InspectionTests, "the picture is the same with and without, and only what changes runs") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.refinement = {.enabled = true, .frames = 6};
    configure(configuration);
    const auto frames = [&](bool inspects) {
        renderer.invalidate();
        std::vector<Picture> pictures;
        for (int frame = 0; frame < 8; ++frame) {
            if (inspects && frame == 1) {
                REQUIRE(inspector.show(Inspection{.resource = "radiance"}).empty());
            }
            if (inspects && frame == 3) REQUIRE(inspector.show(Inspection{.resource = "depth"}).empty());
            if (inspects && frame == 5) REQUIRE(inspector.show({}).empty());
            if (inspects && frame == 7) REQUIRE(inspector.show(Inspection{.resource = "albedo"}).empty());
            pictures.push_back(render(scene, size));
        }
        return pictures;
    };
    const std::vector<Picture> without = frames(false);
    const std::vector<Picture> with = frames(true);
    for (std::size_t i = 0; i < with.size(); ++i) CHECK(with[i] == without[i]);
    CHECK(without[0] != without[5]);

    CHECK(picture_of(inspector.result()).size() == std::size_t{size.x} * size.y);
    static_cast<void>(render(scene, size));
    CHECK_FALSE(ran("inspect-range"));
    CHECK_FALSE(ran("inspect"));
    CHECK_FALSE(ran("gbuffer"));
    static_cast<void>(look(scene, {.resource = "albedo", .channels = Channels::green}));
    CHECK(ran("inspect"));
    CHECK_FALSE(ran("deferred"));
    CHECK_FALSE(ran("shadow-maps"));
}

TEST_CASE_FIXTURE(InspectionTests, "a resource that a graph does not have is said to be missing") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    CHECK(inspector.result().description.empty());
    configure(configuration);
    CHECK(look(scene, {.resource = "albedo"}).texture != 0);
    configuration.path = ShadingPath::forward;
    configure(configuration);
    CHECK(inspector.result().description == "no frame yet");
    CHECK(inspector.result().texture == 0);
    static_cast<void>(render(scene, size));
    CHECK(inspector.result().texture == 0);
    CHECK(inspector.result().description.starts_with("not in this graph"));
    CHECK(inspector.read_buffer(0, 1).bytes.empty());
    configuration.path = ShadingPath::tiled_deferred;
    configure(configuration);
    static_cast<void>(render(scene, size));
    CHECK(inspector.result().texture != 0);
    CHECK(look(scene, {.resource = "no such thing"}).texture == 0);
    CHECK(look(scene, {.resource = "view"}).texture == 0);
    CHECK(inspector.shown()->resource == "view");

    // An extension that cannot be declared together with it keeps the configuration as it was.
    REQUIRE(inspector.show(Inspection{.resource = "albedo"}).empty());
    Extension faulty{.name = "faulty"};
    faulty.declare = [](FrameGraph& graph, ViewFrame&) { graph.add("inspect", [](Pass&) {}); };
    CHECK(renderer.extend(faulty).size() == 1);
    static_cast<void>(render(scene, size));
    CHECK(inspector.result().texture != 0);
    CHECK(inspector.show({}).empty());
    REQUIRE(renderer.extend(faulty).empty());
    const std::vector<std::string> errors = inspector.show(Inspection{.resource = "albedo"});
    REQUIRE(errors.size() == 1);
    CHECK(errors.front().find("'inspect'") != std::string::npos);
    CHECK_FALSE(inspector.shown());
    static_cast<void>(render(scene, size));
}

TEST_CASE_FIXTURE(InspectionTests, "resources of the second view") {
    const Scene scene = ground();
    configure(linear_configuration());
    World world = scene.world;
    const Entity low = add(world, looking({0, 2, 0}, {0, 0, 0}, {0, 0, -1}), Camera{});
    const Entity high = add(world, looking({0, 3, 0}, {0, 0, 0}, {0, 0, -1}), Camera{});
    const RenderTarget first(device, size), second(device, size);
    const std::vector<RenderView> views{{.camera = low, .target = first.target()},
                                        {.camera = high, .target = second.target()}};
    REQUIRE(inspector.show(Inspection{.resource = "depth 2"}).empty());
    renderer.render(world, views);
    check_range(inspector.result(), 3.0, 3.0, 1e-4);
    REQUIRE(inspector.show(Inspection{.resource = "depth"}).empty());
    renderer.render(world, views);
    check_range(inspector.result(), 2.0, 2.0, 1e-4);
    renderer.render(world, {views.data(), 1});
    check_range(inspector.result(), 2.0, 2.0, 1e-4);
}

TEST_CASE_FIXTURE(InspectionTests, "its passes declare all that they depend on") {
    renderer.verify(true);
    Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.path = ShadingPath::clustered_deferred;
    configure(configuration);
    for (const char* const name : {"depth", "shadow cubes", "radiance", "light-clusters count"}) {
        static_cast<void>(look(scene, {.resource = name}));
        const ValueRange range = {0.0F, 0.5F};
        static_cast<void>(look(scene, {.resource = name, .mapping = Mapping::heat, .range = range}));
        scene.world.set(scene.camera, looking({0.1F, 1.0F, 3.0F}, {0, 1, 0}));
        static_cast<void>(render(scene, size));
        static_cast<void>(render(scene, {20, 20}));
    }
}

TEST_CASE_FIXTURE(InspectionTests, "many inspections leak nothing") {
    const Scene scene = cornell_box();
    const std::array<const char*, 4> names{"radiance", "shadow cubes", "light-tiles count", "nothing"};
    const auto round = [&] {
        for (const ShadingPath path : {ShadingPath::tiled_deferred, ShadingPath::forward}) {
            Configuration configuration = linear_configuration();
            configuration.path = path;
            configure(configuration);
            for (const char* const name : names) {
                static_cast<void>(look(scene, {.resource = name}));
            }
            REQUIRE(inspector.show({}).empty());
            static_cast<void>(render(scene, size));
            static_cast<void>(render(scene, size));
        }
        static_cast<void>(renderer.take_frames(true));
    };
    // The first rounds fill the free pool of objects.
    for (int i = 0; i < 3; ++i) round();
    const gl::ObjectCounts before = device_of(renderer).live();
    for (int i = 0; i < 10; ++i) round();
    CHECK(device_of(renderer).live() == before);
}

TEST_CASE_FIXTURE(InspectionTests, "the difference of two pictures") {
    constexpr glm::uvec2 pixels{7, 5};
    const auto texture = [&](std::uint32_t seed) {
        gl::Texture made(device, "picture", {pixels, Format::rgba8});
        std::vector<glm::u8vec4> content;
        for (std::uint32_t i = 0; i < pixels.x * pixels.y; ++i) {
            const std::uint32_t bits = (i + seed) * 2654435761U;
            content.emplace_back(bits >> 24U, bits >> 16U & 255U, bits >> 8U & 255U, 255U);
        }
        made.upload(std::as_bytes(std::span(content)));
        return std::pair(std::move(made), std::move(content));
    };
    const auto [first, first_texels] = texture(1);
    const auto [second, second_texels] = texture(99);
    const RenderTarget target(device, pixels + 2U);
    const Target part{target.target().framebuffer, pixels, {2, 1}};
    for (const float factor : {1.0F, 8.0F}) {
        draw_difference(renderer, first.name(), second.name(), factor, part);
        const Picture drawn = target.read();
        for (std::uint32_t i = 0; i < pixels.x * pixels.y; ++i) {
            const glm::vec3 apart =
                glm::abs(glm::vec3(first_texels[i]) - glm::vec3(second_texels[i])) / 255.0F;
            const glm::vec3 expected = glm::min(factor * apart, 1.0F);
            const glm::vec3 found = drawn.at(2 + i % pixels.x, 1 + i / pixels.x);
            // Rounding of the factors and differences in floats.
            CHECK(glm::distance(found, expected) < 1e-5F);
        }
        CHECK(drawn.at(0, 0) == glm::vec3(0.0F));
    }
    draw_difference(renderer, first.name(), first.name(), 100.0F, part);
    CHECK(mean(target.read()) == 0.0);
    CHECK_THROWS_AS(draw_difference(renderer, first.name(), 12345, 1.0F, part), gl::GlError);
    CHECK_THROWS_AS(draw_difference(renderer, first.name(), second.name(), 1.0F, target.target()),
                    gl::GlError);
}

}  // TEST_SUITE("inspection")
