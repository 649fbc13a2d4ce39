#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// A part of a buffer that keeps its content between frames. Its place is assigned by place_ranges.
struct BufferRange {
    static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t first = nowhere;  ///< index of its first element
    std::uint32_t count = 0;        ///< elements
    bool uploaded = false;
};

/// Assigns places in a persistent buffer, which the running pass updates, to the ranges that have none:
/// behind the others. If the buffer is too small then, or less than half of it up to there is in use, all
/// ranges get new places and must be uploaded again. `ranges` are all that are in use; `end`, kept between
/// calls, is the index behind the last one ever placed. The first `head` elements are left free. Returns
/// whether all have got new places.
template <class T>
bool place_ranges(Execution& run, BufferHandle<T> buffer, std::span<BufferRange* const> ranges,
                  std::uint32_t& end, std::uint32_t head = 0) {
    std::uint32_t used = head;
    for (BufferRange* range : ranges) {
        used += range->count;
        if (range->first == BufferRange::nowhere) {
            range->first = end;
            end += range->count;
        }
    }
    if (end <= run.count(buffer) && end / 2 <= used) return false;
    end = head;
    for (BufferRange* range : ranges) {
        *range = {.first = end, .count = range->count};
        end += range->count;
    }
    // With room for additions.
    run.reserve(buffer, end + end / 8 + 256);
    return true;
}

/// Uploads the ranges that are not uploaded. `append(i, elements)` appends the elements of range i to a
/// vector.
template <class T, class Append>
void upload_ranges(const Gpu& gpu, Execution& run, BufferHandle<T> buffer,
                   std::span<BufferRange* const> ranges, Append append) {
    std::vector<T> elements;
    elements.reserve(std::transform_reduce(
        ranges.begin(), ranges.end(), std::size_t{0}, std::plus<>(),
        [](const BufferRange* range) { return range->uploaded ? std::size_t{0} : range->count; }));
    std::size_t first = 0;
    const auto flush = [&] {
        if (!elements.empty()) {
            gpu.gl().NamedBufferSubData(run.object(buffer), static_cast<GLintptr>(first * sizeof(T)),
                                        static_cast<GLsizeiptr>(elements.size() * sizeof(T)),
                                        elements.data());
        }
        elements.clear();
    };
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        BufferRange& range = *ranges[i];
        if (range.uploaded) continue;
        if (range.first != first + elements.size()) {
            flush();
            first = range.first;
        }
        append(i, elements);
        range.uploaded = true;
    }
    flush();
}

}  // namespace candela
