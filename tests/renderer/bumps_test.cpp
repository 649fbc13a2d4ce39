// Normal and occlusion textures against closed forms, and against surfaces without them.

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "renderer/passes/scene/normal_levels.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("bumps") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 few{9, 9};

std::shared_ptr<const Image> texel(glm::u8vec3 value) {
    return std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {glm::u8vec4(value, 255)}, .encoding = Encoding::linear});
}

/// The normal that a texel stores: glTF 2.0, section 3.9.3.
glm::dvec3 normal_of(glm::u8vec3 value, double scale = 1.0) {
    return glm::normalize((glm::dvec3(value) / 255.0 * 2.0 - 1.0) * glm::dvec3(scale, scale, 1.0));
}

/// A square as `square`, with tangents: u grows along x, or along -x if it is mirrored.
std::shared_ptr<const Mesh> square_with_tangents(float half, std::shared_ptr<const Material> material,
                                                 bool mirrored = false) {
    Mesh mesh = *square(half, std::move(material));
    for (Vertex& vertex : mesh.primitives[0].vertices) {
        const int sign = mirrored ? -32767 : 32767;
        vertex.tangent = glm::i16vec4(sign, 0, 0, sign);
        if (mirrored) vertex.uv.x = 1.0F - vertex.uv.x;
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

std::shared_ptr<const Material> bumpy(glm::vec3 albedo, glm::u8vec3 normal, float scale = 1.0F) {
    Material material = *diffuse(albedo, true);
    material.normal_texture = texel(normal);
    material.normal_scale = scale;
    return std::make_shared<const Material>(std::move(material));
}

std::shared_ptr<const Material> occluded(glm::vec3 albedo, std::uint8_t open, float strength) {
    Material material = *diffuse(albedo);
    material.occlusion_texture = texel({open, 0, 0});
    material.occlusion_strength = strength;
    return std::make_shared<const Material>(std::move(material));
}

/// The ground, seen from 2 m above at 45°, with a tiny view.
Scene seen(std::shared_ptr<const Mesh> ground, const Transform& pose = {}) {
    Scene scene;
    add(scene.world, pose, MeshInstance{std::move(ground)});
    scene.camera = add(scene.world, looking({2, 2, 0}, {0, 0, 0}), Camera{.vertical_fov = 0.02F});
    return scene;
}

Environment sky_of(float radiance) {
    Environment sky;
    sky.radiance = glm::vec3(radiance);
    return sky;
}

Image normals_of(glm::uvec2 size, std::vector<glm::u8vec4> texels) {
    return {.width = size.x, .height = size.y, .texels = std::move(texels), .encoding = Encoding::linear};
}

/// A texel whose normal has these slopes.
glm::u8vec4 sloped(glm::dvec2 slopes) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(slopes, 1.0));
    return {glm::round(127.5 * normal + 127.5), 255};
}

/// Normals whose slopes along both axes are random numbers of a normal distribution.
Image rough_normals(double deviation) {
    constexpr glm::uvec2 size{64, 64};
    std::mt19937 random(1);
    std::normal_distribution<double> slope(0.0, deviation);
    std::vector<glm::u8vec4> texels;
    for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
        const double x = slope(random);
        texels.push_back(sloped({x, slope(random)}));
    }
    return normals_of(size, std::move(texels));
}

/// A ground of metal that reflects all light, with these normals 512 times along each side, so that a pixel
/// has thousands of them.
std::shared_ptr<const Mesh> fine_ground(std::shared_ptr<const Image> normals, float roughness,
                                        float scale = 1.0F) {
    Material material;
    material.metalness = 1.0F;
    material.roughness = roughness;
    material.normal_texture = std::move(normals);
    material.normal_scale = scale;
    Mesh mesh = *square_with_tangents(1.0F, std::make_shared<const Material>(std::move(material)));
    for (Vertex& vertex : mesh.primitives[0].vertices) vertex.uv *= 512.0F;
    return std::make_shared<const Mesh>(std::move(mesh));
}

/// glTF 2.0, appendix B.3: microfacets that reflect all light, for a surface of this normal, times the cosine
/// of the light.
double reflected_share(const glm::dvec3& light, const glm::dvec3& viewer, const glm::dvec3& normal,
                       double alpha) {
    const double a2 = alpha * alpha;
    const double nh = glm::dot(normal, glm::normalize(light + viewer));
    const double nl = glm::dot(normal, light), nv = glm::dot(normal, viewer);
    if (nl <= 0.0 || nv <= 0.0) return 0.0;
    const double d = a2 / (pi * std::pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    return d * 0.5 / (nl * std::sqrt(a2 + (1.0 - a2) * nv * nv) + nv * std::sqrt(a2 + (1.0 - a2) * nl * nl)) *
           nl;
}

/// The mean over the normals of a ground, seen as in `seen`.
double mean_share(const glm::dvec3& light, const Image& normals, double scale, double alpha) {
    const glm::dvec3 viewer = glm::normalize(glm::dvec3(2, 2, 0));
    double sum = 0.0;
    for (const glm::u8vec4& texel : normals.texels) {
        const glm::dvec3 n = normal_of(texel, scale);
        sum += reflected_share(light, viewer, {n.x, n.z, -n.y}, alpha);
    }
    return sum / static_cast<double>(normals.texels.size());
}

double at_middle(const Picture& picture) {
    return static_cast<double>(picture.at(picture.size.x / 2, picture.size.y / 2).g);
}

}  // namespace

TEST_CASE_FIXTURE(RenderFixture, "a point light on a ground with one tilted normal: Lambert's law") {
    const glm::u8vec3 stored(190, 150, 220);
    const glm::vec3 from(-1.0F, 2.0F, 0.7F);
    configure(direct_only());
    const auto expect = [&](std::shared_ptr<const Mesh> mesh, const Transform& pose, glm::dvec3 normal) {
        Scene scene = seen(std::move(mesh), pose);
        add(scene.world, at(from), PointLight{.intensity = 5.0F});
        const glm::dvec3 light = glm::normalize(glm::dvec3(from));
        const double irradiance =
            5.0 / glm::dot(glm::dvec3(from), glm::dvec3(from)) * glm::dot(normal, light);
        // The albedo is rounded to a half float: 5e-4.
        CHECK(at_middle(render(scene, few)) == doctest::Approx(0.5 / pi * irradiance).epsilon(0.001));
    };
    for (const float scale : {1.0F, 0.4F, 2.0F}) {
        CAPTURE(scale);
        const glm::dvec3 n = normal_of(stored, static_cast<double>(scale));
        const auto material = bumpy(glm::vec3(0.5F), stored, scale);
        // Green points to decreasing v, which is -z here.
        expect(square_with_tangents(1.0F, material), Transform{}, {n.x, n.z, -n.y});
        expect(square_with_tangents(1.0F, material, true), Transform{}, {-n.x, n.z, -n.y});
        // The instance is mirrored: so is the image on it.
        expect(square_with_tangents(1.0F, material), Transform{.scale = {-1, 1, 1}}, {-n.x, n.z, -n.y});
        // Seen from below, the whole frame of the tangent is turned round.
        expect(square_with_tangents(1.0F, material), Transform{.scale = {1, -1, 1}}, {-n.x, n.z, n.y});
    }
}

TEST_CASE("mip levels of normals have their mean direction and the spread of their slopes") {
    // Columns that slope to both sides; both means, and the spread against them, are those of one pair.
    constexpr double slope = 0.3;
    std::vector<glm::u8vec4> texels;
    for (int i = 0; i < 8 * 4; ++i) texels.push_back(sloped({i % 2 == 0 ? slope : -slope, 0.1}));
    const std::vector<NormalLevel> levels = normal_levels(normals_of({8, 4}, texels));
    REQUIRE(levels.size() == 4);
    CHECK(levels[0].size() == 32);
    CHECK(levels[1].size() == 8);
    CHECK(levels[2].size() == 2);
    CHECK(levels[3].size() == 1);
    CHECK(levels[0][0] == glm::u8vec4(glm::u8vec3(texels[0]), 0));
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const glm::dvec3 mean = normal_of(levels[i][0]);
        CHECK(std::abs(mean.x) < 0.005);  // a rounding of 8 bits
        CHECK(mean.y / mean.z == doctest::Approx(0.1).epsilon(0.05));
        // Toksvig's variance is that of small slopes: it is less by a quarter of the square of the slope.
        CHECK(levels[i][0].a / 255.0 == doctest::Approx(slope).epsilon(0.03));
    }
}

TEST_CASE("mip levels of normals that only their rounding tells apart have no spread") {
    for (const glm::uvec2 size : {glm::uvec2(4, 4), glm::uvec2(5, 3), glm::uvec2(1, 7)}) {
        std::vector<glm::u8vec4> texels;
        std::mt19937 random(2);
        for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
            texels.emplace_back(127 + random() % 2, 127 + random() % 2, 255, 255);
        }
        for (const NormalLevel& level : normal_levels(normals_of(size, texels))) {
            for (const glm::u8vec4& texel : level) CHECK(texel.a == 0);
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "bumps too small to be seen: the mean over all normals") {
    configure(direct_only());
    constexpr float roughness = 0.4F;
    constexpr double alpha = 0.16;
    for (const float scale : {1.0F, 2.0F}) {
        CAPTURE(scale);
        // The mean square of the slopes, of both axes together, is α².
        const auto normals = std::make_shared<const Image>(
            rough_normals(alpha / std::numbers::sqrt2 / static_cast<double>(scale)));
        double error = 0.0, error_of_flat = 0.0, all = 0.0;
        for (const float aside : {-0.3F, 0.0F, 0.3F, 0.6F, 0.9F}) {
            const glm::vec3 from(-2.0F, 2.0F, 2.0F * aside);
            const auto lit = [&](std::shared_ptr<const Image> image) {
                Scene scene = seen(fine_ground(std::move(image), roughness, scale));
                add(scene.world, at(from), PointLight{.intensity = 5.0F});
                return at_middle(render(scene, few));
            };
            const double expected =
                5.0 / glm::dot(glm::dvec3(from), glm::dvec3(from)) *
                mean_share(glm::normalize(glm::dvec3(from)), *normals, static_cast<double>(scale), alpha);
            error += std::pow(lit(normals) - expected, 2.0);
            error_of_flat += std::pow(lit(texel({128, 128, 255})) - expected, 2.0);
            all += expected * expected;
        }
        // A lobe of GGX is not the mean of those of many normals. By shaders/README.md, the integral of the
        // square of the error is 0.018 of that of the square, and without wider lobes 0.38. Here places
        // near the peak count for more, where the error is largest: 1.24² - 1 at the peak itself, at
        // most.
        CHECK(error < 0.06 * all);
        CHECK(error_of_flat > 0.3 * all);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "a flat normal texture with mip levels leaves metal as smooth as it is") {
    configure(direct_only());
    for (const float roughness : {0.0F, 0.1F}) {
        const auto lit = [&](std::shared_ptr<const Image> image) {
            Scene scene = seen(fine_ground(std::move(image), roughness));
            add(scene.world, at({-2, 2, 0}), PointLight{.intensity = 5.0F});
            return render(scene, few);
        };
        const Picture plain = lit(texel({128, 128, 255}));
        CHECK(mean(plain) > 0.0);
        const std::vector<glm::u8vec4> flat(64, {128, 128, 255, 255});
        CHECK(lit(std::make_shared<const Image>(normals_of({8, 8}, flat))) == plain);
    }
}

TEST_CASE_FIXTURE(RenderFixture, "a light below the ground does not shine on normals that face it") {
    configure(direct_only());
    Scene scene = seen(square_with_tangents(1.0F, bumpy(glm::vec3(0.5F), {10, 127, 160})));
    add(scene.world, at({-2.0F, -0.1F, 0.0F}), PointLight{.intensity = 5.0F, .casts_shadow = false});
    CHECK(at_middle(render(scene, few)) == 0.0);
}

TEST_CASE_FIXTURE(RenderFixture, "a tilted normal under a sky that is the same everywhere") {
    // The ground hides the lower half. Light from the hemisphere around n on a surface of normal m: the
    // share (1 + n·m)/2 of what n receives.
    for (const Interleave interleave : {Interleave::one, Interleave::four}) {
        CAPTURE(to_string(interleave));
        Configuration configuration = linear_configuration();
        configuration.interleave = interleave;
        configure(configuration);
        for (const glm::u8vec3 stored : {glm::u8vec3(200, 128, 210), glm::u8vec3(128, 230, 190)}) {
            Scene scene = seen(square_with_tangents(4.0F, bumpy(glm::vec3(0.5F), stored)));
            add(scene.world, sky_of(2.0F));
            const double tilted = 0.5 + 0.5 * normal_of(stored).z;
            REQUIRE(tilted < 0.92);
            // Patches of the sky near the horizon count as if they were 3° above it: LEAST_FACING. Their
            // sum is right to 1 %.
            CHECK(at_middle(render(scene, few)) == doctest::Approx(0.5 * 2.0 * tilted).epsilon(0.02));
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "a tilted normal under a small lamp: the cosine") {
    configure(linear_configuration());
    const glm::u8vec3 stored(180, 128, 220);
    const glm::vec3 from(2.0F, 3.0F, 0.0F);
    const auto lit = [&](std::shared_ptr<const Mesh> ground) {
        Scene scene = seen(std::move(ground));
        Transform pose = looking(from, {0, 0, 0}, {0, 0, 1});
        pose.rotation = pose.rotation * glm::angleAxis(-0.5F * std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
        add(scene.world, pose, MeshInstance{square(0.1F, emitter(glm::vec3(100.0F)))});
        return at_middle(render(scene, few));
    };
    const double flat = lit(square(1.0F, diffuse(glm::vec3(0.5F))));
    const double turned = lit(square_with_tangents(1.0F, bumpy(glm::vec3(0.5F), stored)));
    REQUIRE(flat > 0.0);
    const glm::dvec3 n = normal_of(stored), light = glm::normalize(glm::dvec3(from));
    const double expected = (n.x * light.x + n.z * light.y - n.y * light.z) / light.y;
    // The lamp is 0.2 m wide, 3.6 m away: directions differ by up to 0.03, and even out over its surfels.
    CHECK(turned / flat == doctest::Approx(expected).epsilon(0.01));
}

TEST_CASE_FIXTURE(RenderFixture, "occlusion takes away light of the sky, and none of a lamp without extent") {
    const auto with = [&](std::shared_ptr<const Material> material, bool sky) {
        Scene scene = seen(square(4.0F, std::move(material)));
        if (sky) {
            add(scene.world, sky_of(2.0F));
        } else {
            add(scene.world, at({0, 3, 0}), PointLight{.intensity = 5.0F});
        }
        return at_middle(render(scene, few));
    };
    configure(linear_configuration());
    const auto open = diffuse(glm::vec3(0.5F));
    for (const float strength : {1.0F, 0.5F}) {
        const auto material = occluded(glm::vec3(0.5F), 51, strength);
        const double share = 1.0 - static_cast<double>(strength) * 0.8;
        CHECK(with(material, true) == doctest::Approx(share * with(open, true)).epsilon(1e-5));
        CHECK(with(material, false) == doctest::Approx(with(open, false)).epsilon(1e-6));
    }
}

TEST_CASE_FIXTURE(RenderFixture, "surfaces without normal textures look the same beside one that has one") {
    configure(linear_configuration());
    // Outside the room, where it is not seen and reflects no light.
    const auto with = [&](const std::shared_ptr<const Material>& material) {
        Scene scene = cornell_box();
        add(scene.world, at({0, -3, 0}), MeshInstance{square_with_tangents(0.1F, material)});
        return render(scene, {32, 32});
    };
    const Picture plain = with(diffuse(glm::vec3(0.0F), true));
    CHECK(mean(plain) > 0.0);
    // Other programs: a driver may round otherwise in each.
    CHECK(relative_mean_square(with(bumpy(glm::vec3(0.0F), {200, 128, 200})), plain) < 1e-10);
}

TEST_CASE_FIXTURE(PathFixture, "paths agree on bumpy surfaces, also glossy ones, and panes") {
    Scene scene = cornell_box();
    Material rough = *bumpy(glm::vec3(0.5F), {180, 140, 220});
    rough.occlusion_texture = texel({100, 0, 0});
    const auto floor = std::make_shared<const Material>(rough);
    add(scene.world, at({0, 0.01F, 0}), MeshInstance{square_with_tangents(0.9F, floor)});
    Material pane = rough;
    pane.alpha_mode = AlphaMode::blend;
    pane.base_colour.a = 0.4F;
    const Transform pose{.translation = {0.3F, 0.8F, 0.5F},
                         .rotation = glm::angleAxis(1.3F, glm::vec3(1, 0, 0))};
    add(scene.world, pose, MeshInstance{square_with_tangents(0.3F, std::make_shared<const Material>(pane))});
    for (const bool glossy : {false, true}) {
        CAPTURE(glossy);
        if (glossy) {
            rough.specular = 1.0F;
            rough.roughness = 0.3F;
            add(scene.world, at({0.2F, 0.02F, 0.3F}),
                MeshInstance{square_with_tangents(0.4F, std::make_shared<const Material>(rough))});
        }
        for (const Interleave interleave : {Interleave::one, Interleave::four}) {
            Configuration configuration = linear_configuration();
            configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
            configuration.interleave = interleave;
            check_paths(scene, {52, 36}, configuration);
        }
    }
}

}  // TEST_SUITE("bumps")
