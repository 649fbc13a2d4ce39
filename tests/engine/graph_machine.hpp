#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/engine/graph_random.hpp"
#include "tests/engine/recording_backend.hpp"

/// Random graphs whose passes compute: each pass hashes what it reads into what it writes.
namespace candela::random_graph {

using Content = std::uint64_t;

inline Content mix(Content hash, Content value) {
    hash = (hash ^ value) * 0x9e37'79b9'7f4a'7c15U;
    return hash ^ (hash >> 29U);
}

/// The result of a pass, from the contents that `content_of(access)` returns for everything it reads or
/// modifies, including histories.
template <class ContentOf>
Content evaluate(const Graph& graph, std::size_t pass, int number, ContentOf content_of) {
    Content hash = mix(1, pass);
    if (graph.passes[pass].reads_world) hash = mix(hash, static_cast<Content>(number));
    for (const Access& access : graph.passes[pass].accesses) {
        if (!access.write || access.version > 1) hash = mix(hash, content_of(access));
    }
    return hash;
}

/// What a pass writes. Values have few different results, so that they often stay equal while inputs change.
inline Content result(const Resource& resource, std::size_t index, Content hash) {
    return resource.kind == ResourceKind::value ? mix(hash, index) % 3 : mix(hash, index);
}

/// What the host provides.
struct Host {
    int number = 0;
    std::vector<Content> imports;  // by resource
};

/// The expected contents, by pass and by version of each resource, as declared.
struct Meaning {
    std::vector<Content> passes;
    std::vector<std::vector<Content>> versions;
};

/// `before` holds the contents of the histories; null in the first frame.
inline Meaning meaning(const Graph& graph, const std::vector<std::uint32_t>& order, const Host& host,
                       const Meaning* before) {
    Meaning now;
    now.passes.resize(graph.passes.size());
    for (std::size_t index = 0; index < graph.resources.size(); ++index) {
        now.versions.emplace_back(graph.resources[index].versions + 1, 0);
        now.versions.back().front() = host.imports[index];
    }
    for (const std::uint32_t pass : order) {
        const Content hash = evaluate(graph, pass, host.number, [&](const Access& access) {
            if (access.previous) return before ? before->versions[access.resource].back() : 0;
            return now.versions[access.resource][access.version - (access.write ? 1 : 0)];
        });
        now.passes[pass] = hash;
        for (const Access& access : graph.passes[pass].accesses) {
            if (!access.write) continue;
            now.versions[access.resource][access.version] =
                result(graph.resources[access.resource], access.resource, hash);
        }
    }
    return now;
}

/// A runtime with its own backend, which runs the graph's passes as computations.
class Machine {
 public:
    explicit Machine(const Graph& graph) : runtime_(backend_) {
        for (std::size_t index = 0; index < graph.resources.size(); ++index) {
            const Resource& resource = graph.resources[index];
            if (resource.kind != ResourceKind::value && resource.lifetime == Lifetime::imported) {
                imported_[index] = resource.kind == ResourceKind::texture
                                       ? backend_.create_texture("import", {})
                                       : backend_.create_buffer("import", {});
            }
        }
        switch_to(graph);
    }

    /// Goes on with another graph, whose resources are the same. It must outlive the machine.
    void switch_to(const Graph& graph) {
        graph_ = &graph;
        handles_ = {};
        auto compiled = compile(declare(graph, handles_, [this](std::size_t pass, const auto& handles) {
            return [this, pass, handles](Execution& run) { compute(run, pass, handles); };
        }));
        runtime_.switch_to(std::move(compiled).take());
        bound_ = false;
        seen_.clear();
    }

    /// Provides the host's inputs: values, and those of its objects that changed or that the graph has
    /// written.
    void provide(const Host& host) {
        world_.set(entity_, Number{host.number});
        for (std::size_t index = 0; index < graph_->resources.size(); ++index) {
            const Resource& resource = graph_->resources[index];
            if (resource.lifetime != Lifetime::imported) continue;
            if (resource.kind == ResourceKind::value) {
                runtime_.set(ValueHandle<int>{handles_.newest[index]}, static_cast<int>(host.imports[index]));
                continue;
            }
            RecordingBackend::Object& object = backend_.objects.at(imported_[index]);
            if (object.content == host.imports[index] && bound_) continue;
            object.content = host.imports[index];
            if (resource.kind == ResourceKind::texture) {
                runtime_.bind(TextureHandle{handles_.newest[index]}, imported_[index], {});
            } else {
                runtime_.bind(BufferHandle<float>{handles_.newest[index]}, imported_[index], 1);
            }
        }
        bound_ = true;
    }

    const FrameRecord& run() { return runtime_.run(world_); }
    /// Abandons the frame before the pass after this many.
    const FrameRecord& run_some(int passes) {
        return runtime_.run(world_, Timing::off, [&passes] { return passes-- > 0; });
    }

    /// Checks everything that is visible from outside.
    void check(const Meaning& expected) const {
        check_use();
        for (const auto& [pass, hash] : seen_) {
            RC_ASSERT(hash == expected.passes[pass]);
        }
        for (const auto& [resource, object] : imported_) {
            RC_ASSERT(backend_.objects.at(object).content == expected.versions[resource].back());
        }
    }

    /// Checks that the backend was used correctly.
    void check_use() const {
        RC_ASSERT(backend_.misuse.empty());
        RC_ASSERT(backend_.open_passes == 0);
    }

    GraphRuntime& runtime() { return runtime_; }
    [[nodiscard]] const World& world() const { return world_; }

    /// From now on the results of this pass depend on something undeclared.
    void sabotage(std::size_t pass) { sabotaged_ = pass; }

 private:
    void compute(Execution& run, std::size_t pass, const Handles& handles) {
        const Content hash = evaluate(*graph_, pass, run.world().get<Number>(entity_).value,
                                      [&](const Access& access) -> Content {
                                          if (access.previous) return previous(run, access, handles);
                                          return read(run, access.resource, handles.newest[access.resource]);
                                      });
        for (const Access& access : graph_->passes[pass].accesses) {
            if (access.write) {
                const Content content = result(graph_->resources[access.resource], access.resource, hash);
                write(run, access.resource, handles.newest[access.resource],
                      content + (pass == sabotaged_ ? 10 : 0));
            }
        }
        if (graph_->passes[pass].side_effect) seen_[pass] = hash;
    }

    ObjectId object(Execution& run, std::size_t resource, ResourceHandle handle) const {
        return graph_->resources[resource].kind == ResourceKind::texture
                   ? run.object(TextureHandle{handle})
                   : run.object(BufferHandle<float>{handle});
    }

    Content previous(Execution& run, const Access& access, const Handles& handles) const {
        const TextureHandle handle{handles.previous.at(access.resource)};
        return run.history_valid(handle) ? backend_.objects.at(run.object(handle)).content : 0;
    }

    Content read(Execution& run, std::size_t resource, ResourceHandle handle) const {
        if (graph_->resources[resource].kind == ResourceKind::value) {
            return static_cast<Content>(run.value(ValueHandle<int>{handle}));
        }
        return backend_.objects.at(object(run, resource, handle)).content;
    }

    void write(Execution& run, std::size_t resource, ResourceHandle handle, Content content) {
        if (graph_->resources[resource].kind == ResourceKind::value) {
            run.set(ValueHandle<int>{handle}, static_cast<int>(content));
        } else {
            backend_.objects.at(object(run, resource, handle)).content = content;
        }
    }

    const Graph* graph_ = nullptr;
    RecordingBackend backend_;
    GraphRuntime runtime_;
    Handles handles_;
    std::map<std::size_t, ObjectId> imported_;  // by resource
    std::map<std::size_t, Content> seen_;       // by pass with a side effect
    World world_;
    Entity entity_ = world_.create();
    std::size_t sabotaged_ = static_cast<std::size_t>(-1);
    bool bound_ = false;
};

inline void edit(Host& host) {
    if (one_in(3)) host.number = static_cast<int>(choose(3));
    for (Content& import : host.imports) {
        if (one_in(3)) import = 1 + choose(4);
    }
}

}  // namespace candela::random_graph
