#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("masks") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{96, 64};
constexpr double tolerance = 0.005;  // as for the closed forms: floats, and albedos in half floats
constexpr std::uint32_t blocks = 4;  // along an edge of the image
constexpr double cutoff = 0.3;
constexpr double half = 2.0;            // half the size of the square that the image covers once, metres
constexpr double shading_height = 1.5;  // height of a square that shades the ground, metres

/// Alpha of a block, in 255ths. With the alpha of the factor the products are 0, 0.2, 0.4 and 0.8.
std::uint8_t stored_alpha(std::uint32_t x, std::uint32_t y) {
    constexpr std::array<std::uint8_t, 4> levels{0, 64, 128, 255};
    return levels[(x + 3 * y) % 4];
}
constexpr float factor_alpha = 0.8F;

enum class Spot { solid, hole, edge };

/// The mask at a place on the square, in metres from its centre; `edge` where filtering may reach.
Spot spot_at(glm::dvec2 place) {
    const glm::dvec2 at = (place / (2.0 * half) + 0.5) * static_cast<double>(blocks);
    const glm::dvec2 from_middle = glm::abs(glm::fract(at) - 0.5);
    const bool near_rim = std::min({at.x, at.y, blocks - at.x, blocks - at.y}) < 0.05;
    // A block is at least 4 texels wide. Half a texel at its edge is filtered, and shadow maps add their own
    // error.
    if (std::max(from_middle.x, from_middle.y) > 0.33 || near_rim) return Spot::edge;
    if (std::min({at.x, at.y, blocks - at.x, blocks - at.y}) < 0.0) return Spot::hole;
    const double alpha = static_cast<double>(factor_alpha) *
                         stored_alpha(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y)) /
                         255.0;
    return alpha < cutoff ? Spot::hole : Spot::solid;
}

template <class Alpha>
std::shared_ptr<const Image> block_image(std::uint32_t texels, const Alpha& alpha) {
    Image image{.width = texels,
                .height = texels,
                .texels = {},
                .wrap_u = Wrap::clamp_to_edge,
                .wrap_v = Wrap::clamp_to_edge};
    for (std::uint32_t y = 0; y < texels; ++y) {
        for (std::uint32_t x = 0; x < texels; ++x) {
            image.texels.emplace_back(255, 255, 255, alpha(x * blocks / texels, y * blocks / texels));
        }
    }
    return std::make_shared<const Image>(std::move(image));
}

std::shared_ptr<const Material> masked(float albedo, float alpha,
                                       std::shared_ptr<const Image> image = nullptr) {
    Material material;
    material.base_colour = glm::vec4(glm::vec3(albedo), alpha);
    material.base_colour_texture = std::move(image);
    material.double_sided = true;
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = static_cast<float>(cutoff);
    return std::make_shared<const Material>(std::move(material));
}

/// A square with holes over the ground.
Scene masked_scene(float height) {
    Scene scene = ground();
    add(scene.world, at({0, height, 0}),
        MeshInstance{
            square(static_cast<float>(half), masked(0.9F, factor_alpha, block_image(16, stored_alpha)))});
    return scene;
}

/// The intersection of a line with the horizontal plane at `height`, as (x, z).
glm::dvec2 meets(glm::dvec3 origin, glm::dvec3 direction, double height) {
    const glm::dvec3 point = origin + (height - origin.y) / direction.y * direction;
    return {point.x, point.z};
}

class Masks : public RenderFixture {
 protected:
    Picture direct_light(const Scene& scene, ShadingPath path, bool shadows = true) {
        Configuration configuration = linear_configuration(path);
        configuration.indirect = false;
        configuration.shadows.enabled = shadows;
        configure(configuration);
        renderer.invalidate();
        return render(scene, size);
    }

    /// Compares the pixels that see a place away from edges with the radiance `wanted(spot, pixel)`.
    template <class SpotUnder, class Wanted>
    void check(const Scene& scene, const Picture& picture, const SpotUnder& spot_under,
               const Wanted& wanted) {
        const auto& camera = scene.world.get<Camera>(scene.camera);
        const auto& pose = scene.world.get<Transform>(scene.camera);
        std::size_t solids = 0, holes = 0, wrong = 0;
        for (std::uint32_t i = 0; i < picture.pixels.size(); ++i) {
            const Spot spot = spot_under(pixel_ray(camera, pose, size, i % size.x, i / size.x));
            if (spot == Spot::edge) continue;
            (spot == Spot::solid ? solids : holes) += 1;
            const double radiance = static_cast<double>(picture.pixels[i].r);
            wrong += std::abs(radiance - wanted(spot, i)) > tolerance * wanted(Spot::hole, i) ? 1 : 0;
        }
        CHECK(solids > 200);
        CHECK(holes > 200);
        CHECK(wrong == 0);
    }

    /// The ground must be dark where the light, which arrives at a point along `direction_to(point)`, hits
    /// the square, and as bright as without shadows where the light passes through a hole.
    template <class Direction>
    void check_shadow(const Scene& scene, const Direction& direction_to) {
        const Picture lit = direct_light(scene, ShadingPath::deferred, false);
        const auto spot_under = [&](const PixelRay& ray) {
            const glm::dvec2 seen = meets(ray.origin, ray.direction, 0.0);
            const glm::dvec3 point(seen.x, 0.0, seen.y);
            return spot_at(meets(point, direction_to(point), shading_height));
        };
        check(scene, direct_light(scene, ShadingPath::deferred), spot_under,
              [&](Spot spot, std::uint32_t pixel) {
                  return spot == Spot::solid ? 0.0 : static_cast<double>(lit.pixels[pixel].r);
              });
    }

    EnergyAccount trace(const Scene& scene, const VplSettings& settings) {
        Configuration configuration = linear_configuration();
        configuration.vpls = settings;
        configuration.vpls.placement = VplPlacement::paths;
        configure(configuration);
        renderer.invalidate();
        static_cast<void>(render(scene, {4, 4}));
        const auto report = renderer.report().vpls;
        REQUIRE(report);
        return report->flux;
    }
};

/// Which blocks of an image are solid.
using Blocks = bool (*)(std::uint32_t x, std::uint32_t y);

bool is_checked(std::uint32_t x, std::uint32_t y) {
    return (x + y) % 2 == 0;
}

bool is_sparse(std::uint32_t x, std::uint32_t y) {
    return x % 2 == 0 && y % 2 == 0;
}

/// A double-sided square of albedo 0.5, 1 m above a ground of the same albedo in the sun, of which only some
/// blocks are there. The camera is between both and sees the ground.
Scene blocks_over_ground(Blocks are_solid, bool by_mask) {
    Scene scene = ground();
    scene.world.set(scene.light, looking({0, 0, 0}, {0.3F, -1.0F, 0.2F}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 3.0F});
    scene.world.set(scene.camera, looking({0, 0.9F, 0}, {0, 0, 0}, {0, 0, -1}));
    if (by_mask) {
        const auto alpha = [&](std::uint32_t x, std::uint32_t y) {
            return static_cast<std::uint8_t>(are_solid(x, y) ? 255 : 0);
        };
        Material material = *masked(0.5F, 1.0F, block_image(64, alpha));
        material.alpha_cutoff = 0.5F;  // edges are midway between the middles of texels
        add(scene.world, at({0, 1, 0}),
            MeshInstance{
                square(static_cast<float>(half), std::make_shared<const Material>(std::move(material)))});
        return scene;
    }
    constexpr auto of_block = static_cast<float>(half / blocks);
    for (std::uint32_t i = 0; i < blocks * blocks; ++i) {
        const glm::uvec2 block(i % blocks, i / blocks);
        if (!are_solid(block.x, block.y)) continue;
        const glm::vec2 middle = of_block * (2.0F * glm::vec2(block) + 1.0F) - static_cast<float>(half);
        add(scene.world, at({middle.x, 1, middle.y}),
            MeshInstance{square(of_block, diffuse(glm::vec3(0.5F), true))});
    }
    return scene;
}

/// Bars of which each is `width` texels of 16 wide.
std::shared_ptr<const Image> bars(std::uint32_t width) {
    Image image{.width = 1024, .height = 4, .texels = {}};
    for (std::uint32_t i = 0; i < image.width * image.height; ++i) {
        image.texels.emplace_back(255, 255, 255, i % 16 < width ? 255 : 0);
    }
    return std::make_shared<const Image>(std::move(image));
}

/// Where bars of one image are squares of 2 m, 10 m apart along x.
struct Bars {
    float cutoff;
    float factor_alpha;
};
constexpr std::array all_bars{Bars{0.5F, 1.0F}, Bars{0.25F, 1.0F}, Bars{0.6F, 0.8F}};

glm::vec3 place_of_bars(std::size_t i) {
    return {10.0F * static_cast<float>(i), 0.5F, 0.0F};
}

/// A ground of albedo 0.5 in the sun, without shadows, seen from above.
Scene seen_from_above() {
    Scene scene = ground();
    add(scene.world, Transform{}, MeshInstance{square(100.0F, diffuse(glm::vec3(0.5F)))});
    scene.world.set(scene.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 2.0F, .casts_shadow = false});
    scene.world.set(scene.camera, Camera{.projection = Camera::Projection::orthographic,
                                         .half_height = 0.6F,
                                         .near_plane = 0.1F,
                                         .far_plane = 10.0F});
    return scene;
}

void add_bars(Scene& scene, const std::shared_ptr<const Image>& image) {
    for (std::size_t i = 0; i < all_bars.size(); ++i) {
        Material material = *masked(0.9F, all_bars[i].factor_alpha, image);
        material.alpha_cutoff = all_bars[i].cutoff;
        add(scene.world, at(place_of_bars(i)),
            MeshInstance{square(1.0F, std::make_shared<const Material>(std::move(material)))});
    }
}

/// Turned, so that the rows of pixels differ.
void look_down_at(Scene& scene, glm::vec3 place) {
    scene.world.set(scene.camera, looking(place + glm::vec3(0, 3, 0), place, {0.3F, 0, -1}));
}

double relative_to(glm::dvec3 difference, glm::dvec3 whole) {
    const glm::dvec3 d = glm::abs(difference);
    return std::max({d.r, d.g, d.b}) / std::max({whole.r, whole.g, whole.b});
}

}  // namespace

TEST_CASE_FIXTURE(Masks,
                  "a masked surface is visible where alpha reaches the cutoff, and transparent elsewhere") {
    Scene scene = masked_scene(0.5F);
    scene.world.set(scene.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 2.0F, .casts_shadow = false});
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        check(
            scene, direct_light(scene, path),
            [](const PixelRay& ray) { return spot_at(meets(ray.origin, ray.direction, 0.5)); },
            [](Spot spot, std::uint32_t) { return 2.0 / pi * (spot == Spot::solid ? 0.9 : 0.5); });
    }
}

TEST_CASE_FIXTURE(Masks, "an alpha equal to the cutoff is opaque, a lower one is a hole") {
    for (const float alpha : {0.5F, 0.499F}) {
        CAPTURE(alpha);
        Scene scene = ground();
        Material material = *masked(0.9F, alpha);
        material.alpha_cutoff = 0.5F;
        add(scene.world, at({0, 0.5F, 0}),
            MeshInstance{square(4.0F, std::make_shared<const Material>(std::move(material)))});
        scene.world.set(scene.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
        scene.world.set(scene.light, DirectionalLight{});
        for (const ShadingPath path : all_shading_paths) {
            const double albedo = alpha < 0.5F ? 0.5 : 0.9;
            const double radiance = static_cast<double>(direct_light(scene, path).at(48, 32).r);
            CHECK(std::abs(radiance - albedo / pi) < tolerance / pi);
        }
    }
}

TEST_CASE_FIXTURE(Masks, "light passes through holes that are finer than a traced image of a colour is") {
    Image stripes{.width = 1024, .height = 1024, .texels = {}};
    for (std::uint32_t i = 0; i < stripes.width * stripes.height; ++i) {
        stripes.texels.emplace_back(255, 255, 255, i / 2 % 2 * 255);
    }
    Scene scene = ground();
    add(scene.world, at({0, static_cast<float>(shading_height), 0}),
        MeshInstance{square(static_cast<float>(half),
                            masked(0.9F, factor_alpha, std::make_shared<const Image>(stripes)))});
    scene.world.set(scene.camera, looking({0.4F, 1.3F, 1.0F}, {0, 0, 0}));
    scene.world.set(scene.light, looking({0.1F, 1, 0}, {0, 0, 0}));
    scene.world.set(scene.light, DirectionalLight{.illuminance = 2.0F});
    // A stripe is two texels wide. Alpha rises linearly between the middles of neighbouring texels, and
    // reaches the cutoff after 0.375 of a texel: 1.75 texels of four are holes.
    const double lit = mean(direct_light(scene, ShadingPath::deferred, false));
    const double through = mean(direct_light(scene, ShadingPath::deferred));
    // 6,144 pixels: five times the deviation of the mean of as many random places.
    CHECK(std::abs(through / lit - 1.75 / 4.0) < 0.03);
}

TEST_CASE_FIXTURE(Masks, "light passes through the holes: shadows of directional, spot and point lights") {
    // The square is above the camera and invisible.
    Scene scene = masked_scene(static_cast<float>(shading_height));
    scene.world.set(scene.camera, looking({0, 1.2F, 0.6F}, {0, 0, 0}));
    scene.world.set(scene.camera, Camera{.vertical_fov = 1.6F});
    SUBCASE("sun") {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2, -1.0, 0.1));
        scene.world.set(scene.light, looking({0, 0, 0}, glm::vec3(direction)));
        scene.world.set(scene.light, DirectionalLight{});
        check_shadow(scene, [&](glm::dvec3) { return direction; });
    }
    const glm::dvec3 light(0.2, 5.0, 0.1);
    const auto from_light = [&](glm::dvec3 point) { return point - light; };
    SUBCASE("spot") {
        scene.world.set(scene.light, looking(glm::vec3(light), {0.2F, 0.0F, 0.1F}, {0, 0, 1}));
        scene.world.set(scene.light, SpotLight{.inner_cone = 0.9F, .outer_cone = 1.0F});
        check_shadow(scene, from_light);
    }
    SUBCASE("point") {
        scene.world.set(scene.light, at(glm::vec3(light)));
        scene.world.set(scene.light, PointLight{});
        check_shadow(scene, from_light);
    }
}

TEST_CASE_FIXTURE(Masks, "bars that are thinner than pixels cover as much as near ones do") {
    constexpr glm::uvec2 square_size{64, 64};
    for (const std::uint32_t width : {5U, 10U}) {
        CAPTURE(width);
        Scene scene = seen_from_above();
        add_bars(scene, bars(width));
        for (std::size_t i = 0; i < all_bars.size(); ++i) {
            CAPTURE(i);
            look_down_at(scene, place_of_bars(i));
            // Alpha of the image rises linearly over a texel at each edge. A pixel is 9.6 texels wide.
            const double at_edge = static_cast<double>(all_bars[i].cutoff / all_bars[i].factor_alpha);
            const double wanted = (width + 1.0 - 2.0 * at_edge) / 16.0;
            for (const ShadingPath path : all_shading_paths) {
                CAPTURE(to_string(path));
                Configuration configuration = linear_configuration(path);
                configuration.indirect = false;
                configure(configuration);
                const Picture picture = render(scene, square_size);
                const auto covered = std::ranges::count_if(picture.pixels, [](glm::vec3 pixel) {
                    return static_cast<double>(pixel.r) > 0.7 * 2.0 / pi;
                });
                // A level may be off by a tenth of the smaller share, and 4,096 places by twice 0.8 %.
                CHECK(std::abs(static_cast<double>(covered) / 4096.0 - wanted) < 0.05);
            }
        }
    }
}

TEST_CASE_FIXTURE(Masks, "masks do not change how the same image is blended") {
    const auto image = bars(5);
    Material blended = *masked(0.9F, 1.0F, image);
    blended.alpha_mode = AlphaMode::blend;
    const auto square_of_glass = square(1.0F, std::make_shared<const Material>(std::move(blended)));
    const auto picture_of = [&](bool with_masks) {
        Scene scene = seen_from_above();
        if (with_masks) add_bars(scene, image);
        const glm::vec3 place(-10.0F, 0.5F, 0.0F);
        add(scene.world, at(place), MeshInstance{square_of_glass});
        look_down_at(scene, place);
        return direct_light(scene, ShadingPath::deferred, false);
    };
    const Picture alone = picture_of(false);
    // Mean alpha is 5 / 16, of an albedo of 0.9 over one of 0.5.
    const double wanted = 2.0 / pi * (0.5 + 0.4 * 5.0 / 16.0);
    CHECK(std::abs(mean(alone) / wanted - 1.0) < 0.01);
    CHECK(picture_of(true) == alone);
}

TEST_CASE_FIXTURE(Masks,
                  "holes of a mask let as much bounced light pass as holes that are cut into the mesh") {
    for (const Blocks are_solid : {&is_checked, &is_sparse}) {
        const auto indirect = [&](bool by_mask) {
            Configuration configuration = linear_configuration();
            configuration.show = Show::indirect;
            configuration.vpls.count = 512;
            configuration.visibility.method = VplVisibility::rays;
            configure(configuration);
            renderer.invalidate();
            return mean(render(blocks_over_ground(are_solid, by_mask), {32, 32}));
        };
        const double cut = indirect(false);
        REQUIRE(cut > 0.0);
        // Other sets of surfels of these numbers differ by some 4 %.
        CHECK(std::abs(indirect(true) / cut - 1.0) < 0.12);
    }
}

TEST_CASE_FIXTURE(Masks, "a surface that is all hole changes nothing") {
    Scene without = ground();
    Scene with = ground();
    add(with.world, at({0, 0.7F, 0}), MeshInstance{square(1.0F, masked(0.9F, 0.2F))});
    for (Scene* scene : {&without, &with}) {
        scene->world.set(scene->light, at({0.1F, 1.5F, 0.2F}));
        scene->world.set(scene->light, PointLight{});
    }
    const VplSettings settings{.count = 500, .bounces = 1};
    const EnergyAccount expected = trace(without, settings);
    const EnergyAccount found = trace(with, settings);
    CHECK(found.absorbed == expected.absorbed);
    CHECK(found.escaped == expected.escaped);
    CHECK(found.truncated == expected.truncated);

    const Picture picture = direct_light(without, ShadingPath::forward);
    CHECK(mean(picture) > 0.01);
    CHECK(direct_light(with, ShadingPath::forward) == picture);
}

TEST_CASE_FIXTURE(Masks, "for traced light, too, an alpha equal to the cutoff is opaque") {
    const auto traced = [&](float alpha) {
        Scene scene = ground();
        scene.world.set(scene.light, at({0.1F, 1.5F, 0.2F}));
        scene.world.set(scene.light, PointLight{});
        Material material = *masked(0.9F, alpha);
        material.alpha_cutoff = 0.5F;
        add(scene.world, at({0, 0.7F, 0}),
            MeshInstance{square(1.0F, std::make_shared<const Material>(std::move(material)))});
        return trace(scene, {.count = 500, .bounces = 1}).absorbed;
    };
    // The square absorbs 0.1 of what meets it, the ground 0.5.
    CHECK(traced(0.5F) == traced(1.0F));
    CHECK(traced(0.499F).r > traced(1.0F).r);
}

TEST_CASE_FIXTURE(Masks, "traced light passes through the holes and no energy is lost") {
    // The light is 0.5 m below a square of half width 0.5 m, which covers a sixth of its directions (one
    // face of a cube around it). The checkerboard maps onto itself with solid blocks and holes exchanged
    // when it is rotated by 90°, so the solid blocks absorb half of that.
    const auto checker = [](std::uint32_t x, std::uint32_t y) {
        return static_cast<std::uint8_t>((x + y) % 2 * 255);
    };
    // The larger image is traced at a reduced resolution.
    for (const std::uint32_t texels : {64U, 512U}) {
        CAPTURE(texels);
        Scene scene = furnace_box(1.0F);
        scene.world.set(scene.light, at({0, 0, 0}));
        add(scene.world, at({0, 0.5F, 0}),
            MeshInstance{square(0.5F, masked(0.0F, 0.6F, block_image(texels, checker)))});
        const EnergyAccount once = trace(scene, {.count = 4000, .bounces = 1});
        CHECK(relative_to(once.absorbed + once.truncated - once.emitted, once.emitted) < 1e-4);
        // The error of 4,000 low-discrepancy points on 8 blocks is of the order of 10 · log N / N.
        CHECK(relative_to(once.absorbed - once.emitted / 12.0, once.emitted) < 0.01);

        const EnergyAccount flux = trace(scene, {.count = 4000, .bounces = 8});
        const glm::dvec3 accounted = flux.absorbed + flux.escaped + flux.truncated + flux.roulette;
        CHECK(relative_to(accounted - flux.emitted, flux.emitted) < 1e-3);
        CHECK(flux.escaped == glm::dvec3(0.0));
        CHECK(flux.absorbed.r > once.absorbed.r);
    }
}

}  // TEST_SUITE("masks")
