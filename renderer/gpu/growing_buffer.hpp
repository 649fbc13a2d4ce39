#pragma once

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

}  // namespace candela
