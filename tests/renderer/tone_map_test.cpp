// The curves from light to colours, and automatic exposure.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <candela/tools/flip.hpp>
#include "tests/renderer/path_fixture.hpp"
#include "tests/seed.hpp"

TEST_SUITE("tone map") {

using namespace candela;

namespace {

// The curves again, from their publications, in double precision and without bounds.

glm::dvec3 filmic(glm::dvec3 x) {
    return glm::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

/// "PBR Neutral Specification" in github.com/KhronosGroup/ToneMapping.
glm::dvec3 neutral(glm::dvec3 in) {
    const double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
    const double x = std::min({in.r, in.g, in.b});
    const double f = x <= 2.0 * f90 ? x - x * x / (4.0 * f90) : f90;
    const double p = std::max({in.r - f, in.g - f, in.b - f});
    if (p <= ks) return in - f;
    const double pn = 1.0 - (1.0 - ks) * (1.0 - ks) / (p + 1.0 - 2.0 * ks);
    const double g = 1.0 / (kd * (p - pn) + 1.0);
    return (in - f) * (pn / p) * g + pn * (1.0 - g);
}

/// ACES.hlsl in github.com/TheRealMJP/BakingLab, whose matrices stand here row by row, of light / 0.6.
glm::dvec3 aces(glm::dvec3 light) {
    const glm::dmat3 in_rows(0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777);
    const glm::dmat3 out_rows(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276,
                              1.07602);
    const glm::dvec3 v = glm::transpose(in_rows) * (light / 0.6);
    const glm::dvec3 a = v * (v + 0.0245786) - 0.000090537;
    const glm::dvec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return glm::clamp(glm::transpose(out_rows) * (a / b), 0.0, 1.0);
}

struct NamedCurve {
    ToneCurve curve;
    glm::dvec3 (*of)(glm::dvec3);
};
constexpr std::array curves{NamedCurve{ToneCurve::filmic, filmic}, NamedCurve{ToneCurve::neutral, neutral},
                            NamedCurve{ToneCurve::aces, aces}};

/// IEC 61966-2-1.
double encoded(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}
double decoded(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
glm::dvec3 decoded(glm::vec3 c) {
    return {decoded(double{c.r}), decoded(double{c.g}), decoded(double{c.b})};
}

double luminance(glm::dvec3 c) {
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

/// Of colours from 0 to 1. Drivers take powers with about 1e-5; a step of 8 bits is 4e-3.
constexpr double rounding = 1e-4;

constexpr glm::uvec2 size{32, 24};
constexpr std::size_t pixels = 32UL * 24UL;

class ToneMapTests : public RenderFixture {
 protected:
    void set(const ToneMapSettings& settings) {
        Configuration configuration = linear_configuration();
        configuration.tone_map = settings;
        configure(configuration);
    }

    Picture mapped(const std::vector<glm::vec3>& radiance, glm::uvec2 of = size) {
        const RenderTarget target(device, of);
        renderer.tone_map(radiance, target.target());
        return target.read();
    }

    /// The exposure that a pixel of a picture was given, from its colour by the filmic curve, which rises.
    static double exposure_of(glm::vec3 colour, double radiance) {
        double low = 0.0, high = 10.0;
        for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (low + high);
            (encoded(filmic(glm::dvec3(middle)).r) < double{colour.r} ? low : high) = middle;
        }
        return low / radiance;
    }

    [[nodiscard]] bool has_exposure() const {
        const auto& passes = renderer.last_passes();
        return std::ranges::any_of(passes,
                                   [](const PassRecord& p) { return p.name.starts_with("exposure"); });
    }
};

constexpr ToneMapSettings automatic{.automatic_exposure = true};

}  // namespace

TEST_CASE_FIXTURE(ToneMapTests, "the curves are those of their publications") {
    std::vector<glm::vec3> colours;
    for (const float value : {0.0F, 1e-3F, 0.04F, 0.08F, 0.18F, 0.76F, 0.8F, 0.81F, 1.0F, 10.0F, 1e4F}) {
        for (const glm::vec3 hue :
             {glm::vec3(1), glm::vec3(1, 0, 0), glm::vec3(0.2F, 1, 0.5F), glm::vec3(0.9F, 0.1F, 1)}) {
            colours.push_back(value * hue);
        }
    }
    const glm::uvec2 row(colours.size(), 1);
    for (const NamedCurve& each : curves) {
        CAPTURE(to_string(each.curve));
        for (const float ev : {0.0F, -1.0F}) {
            set({.exposure_ev = ev, .curve = each.curve});
            const Picture shown = mapped(colours, row);
            for (std::size_t i = 0; i < colours.size(); ++i) {
                CAPTURE(i);
                const glm::dvec3 expected = each.of(glm::dvec3(colours[i]) * std::exp2(double{ev}));
                for (int c = 0; c < 3; ++c) {
                    CHECK(std::abs(encoded(expected[c]) - double{shown.pixels[i][c]}) < rounding);
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "the neutral curve keeps base colours but for 0.04, and all hues") {
    set({.curve = ToneCurve::neutral});
    const std::vector<glm::vec3> colours{
        {0.1F, 0.5F, 0.3F}, {0.8F, 0.2F, 0.4F}, {0.5F, 0.5F, 0.5F}, {3.0F, 1.0F, 0.5F}, {2.0F, 9.0F, 4.0F}};
    const Picture shown = mapped(colours, {colours.size(), 1});
    for (std::size_t i = 0; i < colours.size(); ++i) {
        CAPTURE(i);
        const glm::dvec3 in(colours[i]);
        const glm::dvec3 out = decoded(shown.pixels[i]);
        for (int c = 0; c < 3 && i < 3; ++c) CHECK(std::abs(out[c] - (in[c] - 0.04)) < 2.0 * rounding);
        // Hue: where the middle channel lies between the others, which are at least 0.1 apart.
        const auto [least, most] = std::minmax({in.r, in.g, in.b});
        if (least == most) continue;
        const double spread = std::max({out.r, out.g, out.b}) - std::min({out.r, out.g, out.b});
        REQUIRE(spread > 0.1);
        for (int c = 0; c < 3; ++c) {
            const double place = (out[c] - std::min({out.r, out.g, out.b})) / spread;
            CHECK(std::abs(place - (in[c] - least) / (most - least)) < 4.0 * rounding / 0.1);
        }
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "all curves are finite for infinite light") {
    for (const NamedCurve& each : curves) {
        CAPTURE(to_string(each.curve));
        set({.curve = each.curve});
        const float infinity = std::numeric_limits<float>::infinity();
        const Picture shown = mapped({{infinity, infinity, infinity}, {3e38F, 3e38F, 3e38F}}, {2, 1});
        for (const glm::vec3 colour : shown.pixels) CHECK(colour.g == doctest::Approx(1.0));
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "a uniform picture becomes 18 % grey, within ten stops") {
    for (const float level : {2e-4F, 0.01F, 0.18F, 3.0F, 180.0F}) {
        CAPTURE(level);
        for (const float ev : {0.0F, 1.0F, -2.0F}) {
            set({.exposure_ev = ev, .automatic_exposure = true});
            const Picture shown = mapped(std::vector(pixels, glm::vec3(level)));
            const double expected = encoded(filmic(glm::dvec3(0.18 * std::exp2(double{ev}))).r);
            for (const glm::vec3 colour : shown.pixels) {
                REQUIRE(std::abs(double{colour.r} - expected) < rounding);
            }
        }
    }
    set(automatic);
    for (const float level : {1e-5F, 1e3F}) {
        const double exposed = double{level} * (level < 1.0F ? 1024.0 : 1.0 / 1024.0);
        const Picture shown = mapped(std::vector(pixels, glm::vec3(level)));
        CHECK(std::abs(double{shown.pixels[7].r} - encoded(filmic(glm::dvec3(exposed)).r)) < rounding);
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "two halves are exposed for their geometric mean, in pictures of all sizes") {
    set(automatic);
    for (const glm::uvec2 of : {glm::uvec2(2, 1), glm::uvec2(30, 1), size, glm::uvec2(200, 100)}) {
        CAPTURE(of.x);
        std::vector<glm::vec3> radiance(std::size_t{of.x} * of.y, glm::vec3(0.04F));
        std::fill_n(radiance.begin(), radiance.size() / 2, glm::vec3(4.0F));
        const Picture shown = mapped(radiance, of);
        // The darker half counts 1 - 4e-4, which changes the mean of 6.6 stops by 1e-3 of a stop.
        CHECK(exposure_of(shown.pixels.back(), 0.04) == doctest::Approx(0.18 / 0.4).epsilon(2e-3));
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "colours count by their luminance") {
    set(automatic);
    const glm::vec3 colour(0.5F, 0.1F, 2.0F);
    std::vector<glm::vec3> radiance(pixels, colour);
    const Picture shown = mapped(radiance);
    const double exposure = 0.18 / luminance(colour);
    for (int c = 0; c < 3; ++c) {
        const double expected = encoded(filmic(glm::dvec3(colour) * exposure)[c]);
        CHECK(std::abs(double{shown.pixels[5][c]} - expected) < rounding);
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "few bright pixels hardly change the exposure, and black ones not at all") {
    set(automatic);
    std::vector<glm::vec3> radiance(pixels, glm::vec3(1.0F));
    radiance[100] = glm::vec3(1e6F);
    const double exposure = exposure_of(mapped(radiance).pixels[5], 1.0);
    // The arithmetic mean would divide it by 1,300. The colour determines it to 1e-3.
    CHECK(exposure == doctest::Approx(0.18 / std::pow(1e6, 1.0 / 768.0)).epsilon(1e-3));
    CHECK(exposure < 0.18);

    radiance.assign(pixels, glm::vec3(3.0F));
    const glm::vec3 plain = mapped(radiance).pixels.back();
    for (const float dark : {0.0F, 1e-40F, 1e-9F}) {
        CAPTURE(dark);
        std::fill_n(radiance.begin(), pixels / 2, glm::vec3(dark));
        const glm::vec3 beside = mapped(radiance).pixels.back();
        // 1e-9 counts 6.6e-5, which times its 30 stops is 2e-3 of a stop. Sums of other numbers of pixels
        // round differently.
        CHECK(std::abs(double{beside.r} - double{plain.r}) < (dark < 1e-30F ? 1e-5 : 2e-3));
    }
    CHECK(mapped(std::vector(pixels, glm::vec3(0.0F))).pixels == std::vector(pixels, glm::vec3(0.0F)));
}

TEST_CASE_FIXTURE(ToneMapTests, "what is not finite or negative does not count") {
    set(automatic);
    std::vector<glm::vec3> radiance(pixels, glm::vec3(0.3F, 0.7F, 0.2F));
    for (std::size_t i = 0; i < pixels; i += 5) radiance[i] = glm::vec3(0.0F);
    const Picture black = mapped(radiance);
    const float undefined = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const std::array odd{glm::vec3(undefined, 1.0F, 1.0F), glm::vec3(infinity), glm::vec3(-1.0F)};
    for (std::size_t i = 0; i < pixels; i += 5) radiance[i] = odd.at(i / 5 % odd.size());
    const Picture shown = mapped(radiance);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (i % 5 != 0) REQUIRE(shown.pixels[i] == black.pixels[i]);
    }
}

TEST_CASE_FIXTURE(ToneMapTests,
                  "a slow gradient has no bands in 8 bits, and what 8 bits have stays as it is") {
    // Ten steps of 1/255 over 320 pixels, which would be bands of 32 pixels.
    constexpr glm::uvec2 shape(320, 16);
    std::vector<glm::vec3> radiance;
    const auto colour = [](std::size_t x) { return (90.0 + static_cast<double>(x) / 32.0) / 255.0; };
    for (std::size_t i = 0; i < std::size_t{shape.x} * shape.y; ++i) {
        radiance.emplace_back(static_cast<float>(decoded(colour(i % shape.x))));
    }
    // Albedo is encoded, without a curve.
    Configuration configuration = linear_configuration();
    configuration.tone_map = {.enabled = true};
    configuration.show = Show::albedo;
    configure(configuration);
    const auto shown = [&](const std::vector<glm::vec3>& of, Format format) {
        const RenderTarget target(device, shape, format);
        renderer.tone_map(of, target.target());
        return target.read();
    };
    const auto error_of_blocks = [&](const Picture& picture) {
        double worst = 0.0;
        for (std::uint32_t x = 0; x < shape.x; x += 8) {
            double sum = 0.0, expected = 0.0;
            for (std::uint32_t i = 0; i < 128; ++i) {
                sum += double{picture.at(x + i % 8, i / 8).g} / 128.0;
                expected += colour(x + i % 8) / 128.0;
            }
            worst = std::max(worst, std::abs(sum - expected));
        }
        return worst;
    };
    // Rounding to the nearest colour is off by up to half a step. Independent noise of one step would have a
    // deviation of at most 0.5 / √128 = 0.044 steps; this noise is more even.
    CHECK(error_of_blocks(shown(radiance, Format::rgba8)) < 0.1 / 255.0);
    CHECK(error_of_blocks(shown(radiance, Format::rgba32f)) < 1e-5);
    for (const int level : {0, 1, 17, 128, 254, 255}) {
        CAPTURE(level);
        const std::vector<glm::vec3> even(radiance.size(),
                                          glm::vec3(static_cast<float>(decoded(level / 255.0))));
        const Picture picture = shown(even, Format::rgba8);
        for (const glm::vec3 pixel : picture.pixels) {
            REQUIRE(pixel.r == doctest::Approx(level / 255.0).epsilon(1e-6));
        }
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "the tools expose and show a picture in the same way") {
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> stops(-12.0F, 4.0F);
    tools::Picture radiance{glm::ivec2(size), {}};
    for (std::size_t i = 0; i < pixels; ++i) {
        const float level = i % 7 == 0 ? 0.0F : std::exp2(stops(engine));
        radiance.pixels.push_back(level * glm::vec3(1.0F, 0.6F, 0.3F));
    }
    set(automatic);
    const Picture shown = mapped(radiance.pixels);
    const tools::Picture again = tools::displayed(radiance, tools::automatic_exposure(radiance));
    for (std::size_t i = 0; i < pixels; ++i) {
        for (int c = 0; c < 3; ++c) {
            REQUIRE(std::abs(encoded(double{again.pixels[i][c]}) - double{shown.pixels[i][c]}) < rounding);
        }
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "a frame is exposed like a picture from elsewhere, and like a first frame") {
    Scene scene = cornell_box();
    scene.world.set(scene.light, at({0.0F, 1.5F, 0.5F}));
    scene.world.set(scene.light, PointLight{.intensity = 0.01F});
    const RenderTarget target(device, size);
    const RenderTarget other(device, size);
    for (const ToneCurve curve : {ToneCurve::filmic, ToneCurve::neutral, ToneCurve::aces}) {
        set({.exposure_ev = 0.5F, .curve = curve, .automatic_exposure = true});
        for (const float intensity : {0.01F, 100.0F}) {
            scene.world.edit<PointLight>(scene.light, [&](PointLight& l) { l.intensity = intensity; });
            const RenderView view{
                .camera = scene.camera, .target = target.target(), .keep = {.radiance = true}};
            renderer.render(scene.world, {&view, 1});
            CHECK(ran("exposure"));
            renderer.tone_map(renderer.results().radiance.texture, other.target());
            CHECK(target.read() == other.read());
            CHECK(target.read() == from_scratch(scene, size));
            renderer.render(scene.world, {&view, 1});
            CHECK_FALSE(ran("exposure"));
            CHECK(target.read() == other.read());
        }
    }
}

TEST_CASE_FIXTURE(ToneMapTests, "each view has its own exposure") {
    Scene scene = cornell_box();
    const Entity second = add(scene.world, at({0.0F, 1.0F, 0.5F}), Camera{.vertical_fov = 0.3F});
    set(automatic);
    const std::array alone{render(scene.world, scene.camera, size), render(scene.world, second, size)};
    const std::array targets{RenderTarget(device, size), RenderTarget(device, size)};
    const std::array views{RenderView{.camera = scene.camera, .target = targets[0].target()},
                           RenderView{.camera = second, .target = targets[1].target()}};
    renderer.render(scene.world, views);
    CHECK(targets[0].read() == alone[0]);
    CHECK(targets[1].read() == alone[1]);
}

TEST_CASE_FIXTURE(ToneMapTests, "only what is tone-mapped light is exposed automatically") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    for (const Show show : all_shows) {
        for (const bool enabled : {false, true}) {
            CAPTURE(to_string(show));
            CAPTURE(enabled);
            configuration.show = show;
            configuration.tone_map = {.enabled = enabled, .exposure_ev = 1.0F};
            configure(configuration);
            const Picture manual = render(scene, size);
            CHECK_FALSE(has_exposure());
            configuration.tone_map.automatic_exposure = true;
            configure(configuration);
            const Picture shown = render(scene, size);
            CHECK(has_exposure() == (enabled && shows_light(show)));
            if (!has_exposure()) CHECK(shown == manual);
        }
    }
}

}  // TEST_SUITE("tone map")
