#include "renderer/passes/emission_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <tuple>

namespace candela {
namespace {

constexpr double pi = std::numbers::pi;

using Polygon = std::vector<glm::dvec3>;  // convex, on the sphere, counter-clockwise from outside

/// The sphere in octants, the upper ones first, as the whole of it has no corners to begin with.
const std::array<std::array<glm::dvec3, 3>, 8> octants{{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                                        {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}},
                                                        {{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
                                                        {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}},
                                                        {{{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}},
                                                        {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}},
                                                        {{{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}}},
                                                        {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}}};

std::span<const std::array<glm::dvec3, 3>> octants_of(EmissionDomain domain) {
    return std::span(octants).first(domain == EmissionDomain::sphere ? 8 : 4);
}

/// Keeps of a polygon what lies in the half space of `normal`: Sutherland and Hodgman (1974). Gives whether
/// that is not all of it.
bool clip(Polygon& polygon, glm::dvec3 normal, Polygon& scratch) {
    const auto behind = [&](glm::dvec3 corner) { return glm::dot(corner, normal) < 0.0; };
    if (std::ranges::none_of(polygon, behind)) {
        return false;
    }
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = polygon[i];
        const glm::dvec3 b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double at_a = glm::dot(a, normal);
        const double at_b = glm::dot(b, normal);
        if (at_a >= 0.0) {
            scratch.push_back(a);
        }
        if ((at_a < 0.0) != (at_b < 0.0)) {
            scratch.push_back(glm::normalize(a + (b - a) * (at_a / (at_a - at_b))));
        }
    }
    polygon.swap(scratch);
    return true;
}

/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983), eq. 8.
double triangle_area(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const double volume = glm::dot(a, glm::cross(b, c));
    return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

double polygon_area(const Polygon& polygon) {
    double area = 0.0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        area += triangle_area(polygon[0], polygon[i - 1], polygon[i]);
    }
    return area;
}

/// What of the domain lies nearest to a site.
struct Cell {
    glm::dvec3 site;
    std::vector<Polygon> pieces;
    double reach = -1.0;  ///< cosine of the angle between the site and the farthest corner
};

double reach_of(const Cell& cell) {
    double reach = 1.0;
    for (const Polygon& piece : cell.pieces) {
        for (const glm::dvec3& corner : piece) {
            reach = std::min(reach, glm::dot(corner, cell.site));
        }
    }
    return reach;
}

void cut(Cell& cell, glm::dvec3 other, Polygon& scratch) {
    // Nothing of the cell is nearer to what is twice as far away as its farthest corner.
    const bool too_far =
        cell.reach > 0.0 && glm::dot(cell.site, other) < 2.0 * cell.reach * cell.reach - 1.0 - 1e-12;
    if (too_far) {
        return;
    }
    bool changed = false;
    for (Polygon& piece : cell.pieces) {
        changed |= clip(piece, cell.site - other, scratch);
    }
    if (changed) {
        std::erase_if(cell.pieces, [](const Polygon& piece) { return piece.size() < 3; });
        cell.reach = reach_of(cell);
    }
}

/// Points without their copies, by height, so that neighbours on the sphere are not far apart.
struct Sites {
    std::vector<glm::dvec3> points;
    std::vector<std::uint32_t> copies;   ///< of each
    std::vector<std::uint32_t> site_of;  ///< each of the caller's points
};

Sites sort_sites(std::span<const glm::dvec3> points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {},
                      [&](std::uint32_t i) { return std::tuple(points[i].z, points[i].x, points[i].y); });
    Sites sites;
    sites.site_of.resize(points.size());
    for (const std::uint32_t i : order) {
        if (sites.points.empty() || sites.points.back() != points[i]) {
            sites.points.push_back(points[i]);
            sites.copies.push_back(0);
        }
        ++sites.copies.back();
        sites.site_of[i] = static_cast<std::uint32_t>(sites.points.size()) - 1;
    }
    return sites;
}

/// Those of the sites at about the height of one that are nearest to it, in no order: most of its neighbours.
std::vector<std::uint32_t> near_sites(const Sites& sites, std::size_t index) {
    constexpr std::size_t enough = 10;
    const glm::dvec3 site = sites.points[index];
    const double spacing = std::sqrt(4.0 * pi / static_cast<double>(sites.points.size()));
    const auto height = [](glm::dvec3 point) { return point.z; };
    const auto first = std::ranges::lower_bound(sites.points, site.z - 1.5 * spacing, {}, height);
    const auto last = std::ranges::upper_bound(sites.points, site.z + 1.5 * spacing, {}, height);
    std::vector<std::uint32_t> near;
    near.reserve(static_cast<std::size_t>(last - first));
    for (auto other = first; other != last; ++other) {
        if (glm::dot(*other, site) > 1.0 - 2.0 * spacing * spacing) {
            near.push_back(static_cast<std::uint32_t>(other - sites.points.begin()));
        }
    }
    std::erase(near, static_cast<std::uint32_t>(index));
    if (near.size() > enough) {
        const auto closer = [&](std::uint32_t i, std::uint32_t j) {
            return glm::dot(sites.points[i], site) > glm::dot(sites.points[j], site);
        };
        std::ranges::nth_element(near, near.begin() + enough, closer);
        near.resize(enough);
    }
    return near;
}

/// Cuts with what is near first, then with all sites from the cell's height up and down, until they are too
/// far from it.
Cell cell_of(const Sites& sites, std::size_t index, EmissionDomain domain) {
    Cell cell{.site = sites.points[index], .pieces = {}};
    const std::vector<std::uint32_t> near = near_sites(sites, index);
    Polygon piece;
    Polygon scratch;
    for (const std::array<glm::dvec3, 3>& octant : octants_of(domain)) {
        piece.assign(octant.begin(), octant.end());
        for (std::size_t k = 0; k < near.size() && !piece.empty(); ++k) {
            clip(piece, cell.site - sites.points[near[k]], scratch);
        }
        if (piece.size() > 2) {
            cell.pieces.push_back(piece);
        }
    }
    cell.reach = reach_of(cell);
    const auto height_of = [&](std::size_t i) { return std::abs(sites.points[i].z - cell.site.z); };
    // A chord of twice the cell's angular reach; whatever is left is farther away than that.
    const auto chord = [&] {
        return cell.reach > 0.0 ? 2.0 * std::sqrt(std::max(0.0, 1.0 - cell.reach * cell.reach)) + 1e-9 : 2.0;
    };
    for (std::size_t above = index + 1; above < sites.points.size() && height_of(above) <= chord(); ++above) {
        cut(cell, sites.points[above], scratch);
    }
    for (std::size_t below = index; below > 0 && height_of(below - 1) <= chord(); --below) {
        cut(cell, sites.points[below - 1], scratch);
    }
    return cell;
}

/// The point of the arc from a to b that is farthest from the site, if that is none of its ends.
void add_far_point(const Cell& cell, glm::dvec3 a, glm::dvec3 b, std::vector<EmptyCircle>& circles) {
    const glm::dvec3 normal = glm::cross(a, b);
    const glm::dvec3 far = glm::dot(cell.site, normal) * normal - glm::dot(normal, normal) * cell.site;
    const double length = glm::length(far);
    const bool within =
        glm::dot(glm::cross(a, far), normal) > 0.0 && glm::dot(glm::cross(far, b), normal) > 0.0;
    if (length > 0.0 && within) {
        circles.push_back({far / length, glm::dot(far, cell.site) / length});
    }
}

/// The corners of a cell, and where it spans more than a right angle what lies farthest on its sides and in
/// it: up to a right angle distances on the sphere are convex.
void add_circles(const Cell& cell, std::vector<EmptyCircle>& circles) {
    for (const Polygon& piece : cell.pieces) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            circles.push_back({piece[i], glm::dot(piece[i], cell.site)});
            if (cell.reach <= 0.0) {
                add_far_point(cell, piece[i], piece[i + 1 < piece.size() ? i + 1 : 0], circles);
            }
        }
    }
}

}  // namespace

EmissionDomain emission_domain(gpu::LightKind kind) {
    return kind == gpu::LightKind::point ? EmissionDomain::sphere : EmissionDomain::upper_half;
}

double area_of(EmissionDomain domain) {
    return domain == EmissionDomain::sphere ? 4.0 * pi : 2.0 * pi;
}

glm::dvec3 to_emission_domain(gpu::LightKind kind, glm::dvec2 start) {
    const auto at = [](double z, double azimuth) {
        const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
        return glm::dvec3(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
    };
    if (kind == gpu::LightKind::point) {
        return at(1.0 - 2.0 * start.x, 2.0 * pi * start.y);
    }
    if (kind == gpu::LightKind::spot) {
        return at(1.0 - start.x, 2.0 * pi * start.y);
    }
    const glm::dvec2 p = 2.0 * start - 1.0;
    const bool across = std::abs(p.x) > std::abs(p.y);
    const double radius = across ? p.x : p.y;  // signed
    if (radius == 0.0) {
        return {0.0, 0.0, 1.0};
    }
    const double azimuth = across ? pi / 4.0 * (p.y / p.x) : pi / 2.0 - pi / 4.0 * (p.x / p.y);
    // Of the disc's area r², the cap above z = 1 - r² has the same share.
    return at(1.0 - radius * radius, radius < 0.0 ? azimuth + pi : azimuth);
}

glm::dvec2 from_emission_domain(gpu::LightKind kind, glm::dvec3 point) {
    const double last = std::nextafter(1.0F, 0.0F);  // below 1 as a float, too
    const double azimuth = std::atan2(point.y, point.x);
    const double turn = azimuth / (2.0 * pi) - std::floor(azimuth / (2.0 * pi));
    if (kind != gpu::LightKind::directional) {
        const double x = (1.0 - point.z) / (kind == gpu::LightKind::point ? 2.0 : 1.0);
        return glm::clamp(glm::dvec2(x, turn), 0.0, last);
    }
    const double radius = std::sqrt(std::clamp(1.0 - point.z, 0.0, 1.0));
    // Quadrants around +x, +y, -x, -y; in each the square's far side is at `radius`.
    const double quadrant = std::floor(azimuth / (pi / 2.0) + 0.5);
    const double along = radius * (azimuth - quadrant * pi / 2.0) / (pi / 4.0);
    const std::array<glm::dvec2, 4> corners{
        {{radius, along}, {-along, radius}, {-radius, -along}, {along, -radius}}};
    const glm::dvec2 p = corners.at(static_cast<std::size_t>(static_cast<int>(quadrant + 4.0) % 4));
    return glm::clamp(0.5 * p + 0.5, 0.0, last);
}

EmissionCells emission_cells(std::span<const glm::dvec3> points, EmissionDomain domain) {
    const Sites sites = sort_sites(points);
    EmissionCells cells;
    std::vector<double> shares;
    shares.reserve(sites.points.size());
    for (std::size_t i = 0; i < sites.points.size(); ++i) {
        const Cell cell = cell_of(sites, i, domain);
        const double area =
            std::accumulate(cell.pieces.begin(), cell.pieces.end(), 0.0,
                            [](double sum, const Polygon& piece) { return sum + polygon_area(piece); });
        shares.push_back(area / sites.copies[i]);
        add_circles(cell, cells.corners);
    }
    if (sites.points.size() == 1 && (domain == EmissionDomain::sphere || sites.points[0].z <= 0.0)) {
        cells.corners.push_back({-sites.points[0], -1.0});
    }
    cells.areas.reserve(points.size());
    for (const std::uint32_t site : sites.site_of) {
        cells.areas.push_back(shares[site]);
    }
    return cells;
}

std::vector<EmptyCircle> thinnest_places(const EmissionCells& cells, std::size_t count) {
    std::vector<EmptyCircle> circles = cells.corners;
    std::vector<EmptyCircle> thinnest;
    while (thinnest.size() < count && !circles.empty()) {
        thinnest.push_back(*std::ranges::min_element(circles, {}, &EmptyCircle::cosine));
        for (EmptyCircle& circle : circles) {
            circle.cosine = std::max(circle.cosine, glm::dot(circle.centre, thinnest.back().centre));
        }
    }
    return thinnest;
}

}  // namespace candela
