#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <candela/graph/recording_backend.hpp>
#include "engine/graph/details/plan.hpp"
#include "tests/engine/graph_random.hpp"

/// Random graphs whose passes compute: each pass hashes what it reads into what it writes.
namespace candela::random_graph {

using Content = std::uint64_t;

inline Content mix(Content hash, Content value) {
    hash = (hash ^ value) * 0x9e37'79b9'7f4a'7c15U;
    return hash ^ (hash >> 29U);
}

/// The result of a pass, from the contents that `content_of(access)` returns for everything it reads or
/// modifies, and from `number_of(type)` of the components that it reads.
template <class NumberOf, class ContentOf>
Content evaluate(const Graph& graph, std::size_t pass, NumberOf number_of, ContentOf content_of) {
    Content hash = mix(1, pass);
    for (const ComponentAccess& access : graph.passes[pass].components) {
        if (!access.write) hash = mix(hash, static_cast<Content>(number_of(access.type)));
    }
    for (const Access& access : graph.passes[pass].accesses) {
        if (!access.write || access.version > 1) hash = mix(hash, content_of(access));
    }
    return hash;
}

/// What a pass writes. Values have few different results, so that they often stay equal while inputs change.
inline Content result(const Resource& resource, std::size_t index, Content hash) {
    return resource.kind == ResourceKind::value ? mix(hash, index) % 3 : mix(hash, index);
}

/// The component that a pass writes; one of few, for the same reason.
inline int component_result(std::size_t type, Content hash) {
    return static_cast<int>(mix(hash, ~type) % 3);
}

/// What the host provides, before each frame.
struct Host {
    std::array<int, number_types> numbers{};
    std::vector<Content> imports;  // by resource
};
inline Host make_host(const Graph& graph) {
    return {.imports = std::vector<Content>(graph.resources.size(), 1)};
}

/// The expected contents, by pass and by version of each resource, as declared.
struct Meaning {
    std::vector<Content> passes;
    std::vector<std::vector<Content>> versions;
    std::array<int, number_types> numbers{};  // at the end
};

/// The contents that the kept passes of a graph give, evaluated in the order of their declaration, whatever
/// the order in which they run.
inline Meaning meaning(const Graph& graph, const CompiledGraph& compiled, const Host& host) {
    std::vector<std::uint32_t> order = compiled.plan().order;
    std::ranges::sort(order);
    std::array<int, number_types> numbers = host.numbers;
    Meaning now;
    now.passes.resize(graph.passes.size());
    for (std::size_t index = 0; index < graph.resources.size(); ++index) {
        now.versions.emplace_back(graph.resources[index].versions + 1, 0);
        now.versions.back().front() = host.imports[index];
    }
    for (const std::uint32_t pass : order) {
        const auto number_of = [&](std::size_t type) { return numbers.at(type); };
        const Content hash = evaluate(graph, pass, number_of, [&](const Access& access) {
            return now.versions[access.resource][access.version - (access.write ? 1 : 0)];
        });
        now.passes[pass] = hash;
        for (const ComponentAccess& access : graph.passes[pass].components) {
            if (access.write) numbers.at(access.type) = component_result(access.type, hash);
        }
        for (const Access& access : graph.passes[pass].accesses) {
            if (!access.write) continue;
            now.versions[access.resource][access.version] =
                result(graph.resources[access.resource], access.resource, hash);
        }
    }
    now.numbers = numbers;
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

    /// Goes on with another graph, whose resources are the same. It must outlive the machine. With `shuffle`,
    /// its passes run in another order.
    void switch_to(const Graph& graph, std::optional<std::uint32_t> shuffle = {}) {
        graph_ = &graph;
        handles_ = {};
        auto compiled =
            compile(declare(graph, handles_,
                            [this](std::size_t pass, const auto& handles) {
                                return [this, pass, handles](Execution& run) { compute(run, pass, handles); };
                            }),
                    shuffle);
        runtime_.switch_to(std::move(compiled).take());
        bound_ = false;
        seen_.clear();
    }

    /// Provides the host's inputs: values, and those of its objects that changed or that the graph has
    /// written.
    void provide(const Host& host) {
        world_.set(entity_, Number<0>{host.numbers[0]});
        world_.set(entity_, Number<1>{host.numbers[1]});
        for (std::size_t index = 0; index < graph_->resources.size(); ++index) {
            const Resource& resource = graph_->resources[index];
            if (resource.lifetime != Lifetime::imported) continue;
            if (resource.kind == ResourceKind::value) {
                runtime_.set(ValueHandle<int>{handles_[index]}, static_cast<int>(host.imports[index]));
                continue;
            }
            RecordingBackend::Object& object = backend_.objects.at(imported_[index]);
            if (object.content == host.imports[index] && bound_) continue;
            object.content = host.imports[index];
            if (resource.kind == ResourceKind::texture) {
                runtime_.bind(TextureHandle{handles_[index]}, imported_[index], {});
            } else {
                runtime_.bind(BufferHandle<float>{handles_[index]}, imported_[index], 1);
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
        for (std::size_t type = 0; type < number_types; ++type) {
            RC_ASSERT(number(world_, type) == expected.numbers.at(type));
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
        const Content hash = evaluate(
            *graph_, pass, [&](std::size_t type) { return number(run.world(), type); },
            [&](const Access& access) { return read(run, access.resource, handles[access.resource]); });
        for (const ComponentAccess& access : graph_->passes[pass].components) {
            if (!access.write) continue;
            with_type(access.type,
                      [&]<class C>(C) { run.world().set(entity_, C{component_result(access.type, hash)}); });
        }
        for (const Access& access : graph_->passes[pass].accesses) {
            if (access.write) {
                const Content content = result(graph_->resources[access.resource], access.resource, hash);
                write(run, access.resource, handles[access.resource],
                      content + (pass == sabotaged_ ? 10 : 0));
            }
        }
        if (graph_->passes[pass].side_effect) seen_[pass] = hash;
    }

    [[nodiscard]] int number(const WorldReader& world, std::size_t type) const {
        return with_type(type, [&]<class C>(C) { return world.get<C>(entity_).value; });
    }

    ObjectId object(Execution& run, std::size_t resource, ResourceHandle handle) const {
        return graph_->resources[resource].kind == ResourceKind::texture
                   ? run.object(TextureHandle{handle})
                   : run.object(BufferHandle<float>{handle});
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
    for (int& number : host.numbers) {
        if (one_in(3)) number = static_cast<int>(choose(3));
    }
    for (Content& import : host.imports) {
        if (one_in(3)) import = 1 + choose(4);
    }
}

}  // namespace candela::random_graph
