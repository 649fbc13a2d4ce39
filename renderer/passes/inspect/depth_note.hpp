#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <glm/vec4.hpp>

#include <candela/graph/execute.hpp>

namespace candela {

/// Elements [2][2], [3][2], [2][3] and [3][3] of a projection: they turn its depths into metres along the
/// axis.
using DepthTerms = glm::vec4;

/// Those of the depth near / metres.
inline DepthTerms perspective_terms(float near_plane) {
    return {0.0F, near_plane, -1.0F, 0.0F};
}

/// Those of the depth 1 - metres / reach.
inline DepthTerms linear_terms(float reach) {
    return {1.0F / reach, 1.0F, 0.0F, 1.0F};
}

/// Note on a texture with depths (FrameGraph::note): how an inspection turns them into metres.
struct DepthNote {
    std::function<void(Pass&)> read;  ///< declares the reads of a pass that calls `terms`
    /// Of this layer of the texture; none: the layer is not in use.
    std::function<std::optional<DepthTerms>(const Execution&, std::uint32_t layer)> terms;
};

/// A note with the terms `terms_of(const T&, layer)`.
template <class T, class TermsOf>
DepthNote depth_note(ValueHandle<T> value, TermsOf terms_of) {
    return {[=](Pass& pass) { pass.read(value); },
            [=](const Execution& run, std::uint32_t layer) { return terms_of(run.value(value), layer); }};
}

}  // namespace candela
