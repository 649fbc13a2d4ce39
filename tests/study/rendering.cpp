#include "tests/study/rendering.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace candela::study {

Configuration configuration_of(const Point& point) {
    const ConfigurationResult result = read_configuration(point.request);
    if (!result.configuration) throw std::invalid_argument(fmt::format("{}", fmt::join(result.errors, "; ")));
    Configuration configuration = *result.configuration;
    configuration.show = Show::total;
    configuration.vpls.seed = point.seeds.front();
    return configuration;
}

tools::Picture finite_picture(Bench& bench) {
    tools::Picture picture = bench.picture();
    if (const auto pixel = first_not_finite(picture)) {
        const Configuration& configuration = bench.renderer().configuration();
        throw std::runtime_error(fmt::format("the {} light of seed {} is NaN or infinite at pixel ({}, {})",
                                             to_string(configuration.show), configuration.vpls.seed, pixel->x,
                                             pixel->y));
    }
    return picture;
}

}  // namespace candela::study
