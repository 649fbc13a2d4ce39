#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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

/// Uploads elements to a buffer in the order in which they come. Collects about a MiB of them: one upload for
/// each would take long, and a copy of all of them much memory.
template <class T>
class BufferWriter {
 public:
    BufferWriter(const Gpu& gpu, ObjectId buffer) : gpu_(gpu), buffer_(buffer) {}

    /// The next element becomes that with this index.
    void seek(std::size_t index) {
        if (index == first_ + elements_.size()) return;
        flush();
        first_ = index;
    }
    void push_back(const T& element) {
        if (elements_.size() == most) flush();
        elements_.push_back(element);
    }
    void append(std::span<const T> added) {
        if (elements_.size() + added.size() > most) flush();
        if (added.size() > most) {
            upload(added);
        } else {
            elements_.insert(elements_.end(), added.begin(), added.end());
        }
    }
    /// Uploads what is left. Must be the last call.
    void flush() {
        upload(elements_);
        elements_.clear();
    }

 private:
    static constexpr std::size_t most = (std::size_t{1} << 20U) / sizeof(T);

    void upload(std::span<const T> elements) {
        if (elements.empty()) return;
        gpu_.gl().NamedBufferSubData(buffer_, static_cast<GLintptr>(first_ * sizeof(T)),
                                     static_cast<GLsizeiptr>(elements.size_bytes()), elements.data());
        first_ += elements.size();
    }

    const Gpu& gpu_;
    ObjectId buffer_;
    std::size_t first_ = 0;  // index of elements_[0]
    std::vector<T> elements_;
};

/// Uploads the ranges that are not uploaded. `write(i, writer)` writes the elements of range i to a
/// BufferWriter.
template <class T, class Write>
void upload_ranges(const Gpu& gpu, Execution& run, BufferHandle<T> buffer,
                   std::span<BufferRange* const> ranges, Write write) {
    BufferWriter<T> writer(gpu, run.object(buffer));
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        BufferRange& range = *ranges[i];
        if (range.uploaded) continue;
        writer.seek(range.first);
        write(i, writer);
        range.uploaded = true;
    }
    writer.flush();
}

}  // namespace candela
