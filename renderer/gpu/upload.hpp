#pragma once

#include <algorithm>
#include <span>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// Uploads `data` as the whole content of a persistent buffer that the running pass writes with Usage::copy.
/// The buffer gets at least one element, so that it can always be bound.
template <class T>
void upload(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, std::span<const T> data) {
    run.reserve(buffer, std::max<std::size_t>(data.size(), 1));
    if (data.empty()) {
        return;
    }
    gpu.gl().NamedBufferSubData(run.object(buffer), 0, static_cast<GLsizeiptr>(data.size_bytes()),
                                data.data());
}

/// The same for a single element.
template <class T>
void upload_one(const Gpu& gpu, Execution& run, BufferHandle<T> buffer, const T& element) {
    upload<T>(gpu, run, buffer, {&element, 1});
}

}  // namespace candela
