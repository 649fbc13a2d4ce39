#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include <candela/graph/execute.hpp>
#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// A persistent buffer that grows when a pass uploads more or calls Execution::reserve. It has at least one
/// element, so that it can always be bound.
template <class T>
[[nodiscard]] BufferHandle<T> growing_buffer(FrameGraph& graph, std::string_view name) {
    return graph.buffer<T>(name, 1, Lifetime::persistent);
}

/// Ensures that a growing buffer can hold `count` elements, with room for more, so that it rarely grows.
/// Returns whether its content was lost.
template <class T>
bool reserve_more(Execution& run, BufferHandle<T> buffer, std::uint64_t count) {
    if (count <= run.count(buffer)) return false;
    run.reserve(buffer, count + count / 2);
    return true;
}

/// Uploads `data` as the content of a growing buffer that the running pass writes with Usage::copy.
template <class T>
void upload(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, std::span<const T> data) {
    run.reserve(buffer, data.size());
    if (!data.empty()) {
        gpu.gl().NamedBufferSubData(run.object(buffer), 0, static_cast<GLsizeiptr>(data.size_bytes()),
                                    data.data());
    }
}

/// The same for a single element.
template <class T>
void upload_one(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, const T& element) {
    upload<T>(gpu, run, buffer, {&element, 1});
}

/// Copies the first `count` elements of a buffer that the running pass writes with Usage::storage to another,
/// which it writes with Usage::copy; fewer if there are not so many. To be called before the pass reserves
/// `from`.
template <class T>
void copy_content(const Gpu& gpu, Execution& run, BufferHandle<T> from, BufferHandle<T> to,
                  std::uint64_t count) {
    count = std::min(count, run.count(from));
    run.reserve(to, count);
    // The graph plans the barriers for shaders only, as the pass declares one usage.
    gpu.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gpu.gl().CopyNamedBufferSubData(run.object(from), run.object(to), 0, 0,
                                    static_cast<GLsizeiptr>(count * sizeof(T)));
}

}  // namespace candela
