#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>
#include <candela/graph/recording_backend.hpp>

namespace candela {

inline constexpr TextureDesc colour{{64, 32}, Format::rgba16f};

/// Names of the passes that ran, joined by spaces.
inline std::string ran(const FrameRecord& record) {
    std::string names;
    for (const PassRecord& pass : record.passes) {
        if (pass.ran) names += (names.empty() ? "" : " ") + std::string(pass.name);
    }
    return names;
}

/// A graph to declare passes in, and a runtime that runs it.
struct GraphFixture {
    RecordingBackend backend;
    GraphRuntime runtime{backend};
    World world;
    FrameGraph graph;

    void switch_to() { runtime.switch_to(compile(std::move(graph)).take()); }
    std::string run() { return ran(runtime.run(world)); }

    TextureHandle draw(std::string_view name, std::vector<TextureHandle> sources, TextureHandle target) {
        return graph.add(name, [&](Pass& pass) {
            for (const TextureHandle source : sources) {
                pass.read(source, Usage::sampled);
            }
            return pass.write(target, Usage::colour_target);
        });
    }
    TextureHandle texture(std::string_view name, Lifetime lifetime = Lifetime::transient) {
        return graph.texture(name, colour, lifetime);
    }
};

}  // namespace candela
