#include "engine/import/import_budget.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

/// Small files may grow by any factor up to this memory.
constexpr std::uint64_t free_memory = std::uint64_t{64} << 20U;

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return b > most - a ? most : a + b;
}

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > most / b ? most : a * b;
}

/// `what` has a plural verb: "its triangles are ...".
void check(std::string_view what, std::uint64_t used, std::uint64_t limit, std::string_view name) {
    if (used > limit) {
        throw SceneError(
            fmt::format("{} {}, above the limit of {} ({})", what, grouped(used), grouped(limit), name));
    }
}

}  // namespace

void ImportBudget::add_file(std::uint64_t bytes) {
    file_bytes_ = sum(file_bytes_, bytes);
    check("the bytes of its files are", file_bytes_, limits_.bytes, "bytes");
}

void ImportBudget::add_memory(std::uint64_t bytes) {
    memory_ = sum(memory_, bytes);
    const std::uint64_t limit = std::max(free_memory, product(limits_.growth, file_bytes_));
    check("the bytes of memory that it needs are", memory_, limit, "growth");
}

void ImportBudget::add_picture(std::uint64_t width, std::uint64_t height) {
    const std::uint64_t pixels = product(width, height);
    check(fmt::format("its {} x {} pixels are", width, height), pixels, limits_.image_pixels, "image_pixels");
    pixels_ = sum(pixels_, pixels);
    check("the pixels of all pictures so far are", pixels_, limits_.pixels, "pixels");
}

void ImportBudget::add_triangles(std::uint64_t count) {
    triangles_ = sum(triangles_, count);
    check("the triangles of its meshes are", triangles_, limits_.triangles, "triangles");
}

void ImportBudget::check_nodes(std::uint64_t count) const {
    check("its nodes are", count, limits_.nodes, "nodes");
}

void ImportBudget::check_depth(std::uint64_t depth) const {
    check("the levels of its hierarchy are", depth, limits_.depth, "depth");
}

}  // namespace candela::gltf
