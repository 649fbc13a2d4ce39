#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
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

/// Which parts of a persistent buffer are in use.
class RangePlaces {
 public:
    /// Gives the range a place: one of the same size that has become free, or one behind all others.
    void give(BufferRange& range) {
        used_ += range.count;
        range.uploaded = false;
        std::vector<std::uint32_t>& free = free_[range.count];
        if (free.empty()) {
            range.first = end_;
            end_ += range.count;
        } else {
            range.first = free.back();
            free.pop_back();
        }
    }
    /// Frees the place of a range, if it has one.
    void take_back(BufferRange& range) {
        if (range.first == BufferRange::nowhere) return;
        used_ -= range.count;
        free_[range.count].push_back(range.first);
        range = {.count = range.count};
    }
    /// Nothing is in use but the first `head` elements.
    void clear(std::uint32_t head) {
        used_ = end_ = head;
        free_.clear();
    }
    /// Whether a buffer of so many elements is too small, or less than half of it up to the end is in use.
    [[nodiscard]] bool is_crowded(std::uint64_t capacity) const {
        return end_ > capacity || end_ / 2 > used_;
    }
    /// Index behind the last element ever in use.
    [[nodiscard]] std::uint32_t end() const { return end_; }

 private:
    std::uint32_t end_ = 0;
    std::uint32_t used_ = 0;                                              // elements
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> free_;  // first elements, by size
};

/// Gives places in a persistent buffer, which the running pass updates, to those of the ranges that have
/// none. If the buffer is too small then, or less than half of it is in use, all ranges of `all()` get new
/// places behind the first `head` elements, and must be uploaded again. Returns whether that was so.
template <class T, class All>
bool place_ranges(Execution& run, BufferHandle<T> buffer, RangePlaces& places,
                  std::span<BufferRange* const> ranges, All all, std::uint32_t head = 0) {
    for (BufferRange* range : ranges) {
        if (range->first == BufferRange::nowhere) places.give(*range);
    }
    if (!places.is_crowded(run.count(buffer))) return false;
    places.clear(head);
    for (BufferRange* range : all()) places.give(*range);
    // With room for additions.
    run.reserve(buffer, places.end() + places.end() / 8 + 256);
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
