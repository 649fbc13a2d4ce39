#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <rapidcheck.h>

#include <candela/graph/compile.hpp>
#include <candela/graph/execute.hpp>

/// Random graphs, kept as plain lists in addition to the declaration, so that checks do not rely on the
/// latter.
namespace candela::random_graph {

/// The components that passes of random graphs read and write. One entity has one of each type.
template <std::size_t Type>
struct Number {
    int value = 0;
    bool operator==(const Number&) const = default;
};
inline constexpr std::size_t number_types = 2;

/// Calls `act` with a Number of this type.
template <class Act>
decltype(auto) with_type(std::size_t type, Act act) {
    return type == 0 ? act(Number<0>{}) : act(Number<1>{});
}

struct Resource {
    ResourceKind kind = ResourceKind::texture;
    Lifetime lifetime = Lifetime::transient;
    bool deep = false;  // selects one of two descriptions
    std::uint32_t versions = 0;
};

struct Access {
    std::size_t resource = 0;
    std::uint32_t version = 0;  // that is read or written
    Usage usage = Usage::sampled;
    bool write = false;
};

struct ComponentAccess {
    std::size_t type = 0;
    bool write = false;
};

struct Pass {
    std::vector<Access> accesses{};
    bool side_effect = false;
    std::vector<ComponentAccess> components{};  // at most one of each type
};

struct Graph {
    std::vector<Resource> resources;
    std::vector<Pass> passes;
};

inline std::string pass_name(std::size_t pass) {
    return "p" + std::to_string(pass);
}
inline std::string resource_name(std::size_t resource) {
    return "r" + std::to_string(resource);
}

/// A number below `count`: rapidcheck's, unless a fuzzer provides the choices.
inline std::function<std::size_t(std::size_t)> choose = [](std::size_t count) {
    return *rc::gen::inRange<std::size_t>(0, count);
};
inline bool one_in(std::size_t count) {
    return choose(count) == 0;
}
inline Usage one_of(const std::vector<Usage>& usages) {
    return usages[choose(usages.size())];
}

inline Usage read_usage(ResourceKind kind) {
    using enum Usage;
    return kind == ResourceKind::texture ? one_of({sampled, storage, copy})
                                         : one_of({sampled, storage, uniform, vertex, index, indirect, copy});
}
inline Usage write_usage(ResourceKind kind) {
    using enum Usage;
    return kind == ResourceKind::texture ? one_of({storage, colour_target, layer_target, copy, storage})
                                         : one_of({storage, copy, storage});
}

struct Options {
    std::size_t passes = 16;
    bool systems = true;  // passes may write components
};

inline void add_access(Graph& graph, Pass& pass) {
    Access access;
    access.resource = choose(graph.resources.size() + 2);
    access.write = !one_in(3);
    if (access.resource >= graph.resources.size()) {
        access.resource = graph.resources.size();
        Resource made;
        made.kind = static_cast<ResourceKind>(choose(3));
        made.deep = made.kind != ResourceKind::value && one_in(2);
        made.lifetime = made.kind == ResourceKind::value ? Lifetime::persistent : Lifetime::transient;
        if (one_in(5)) made.lifetime = one_in(2) ? Lifetime::imported : Lifetime::persistent;
        graph.resources.push_back(made);
    }
    Resource& resource = graph.resources[access.resource];
    const bool gpu = resource.kind != ResourceKind::value;
    const bool imported = resource.lifetime == Lifetime::imported;
    if (imported && !gpu) access.write = false;
    for (const Access& other : pass.accesses) {  // no feedback, and one access per resource
        if (other.resource == access.resource) return;
    }
    if (access.write) {
        access.version = ++resource.versions;
        access.usage = gpu ? write_usage(resource.kind) : Usage{};
    } else {
        if (resource.versions == 0 && !imported) return;
        access.version = resource.versions;
        access.usage = gpu ? read_usage(resource.kind) : Usage{};
    }
    pass.accesses.push_back(access);
}

/// Handles only flow forward.
inline Graph make(const Options& options) {
    Graph graph;
    const std::size_t count = choose(options.passes);
    for (std::size_t index = 0; index < count; ++index) {
        Pass pass;
        const std::size_t accesses = choose(5);
        for (std::size_t access = 0; access < accesses; ++access) {
            add_access(graph, pass);
        }
        pass.side_effect = one_in(5);
        for (std::size_t type = 0; type < number_types; ++type) {
            if (one_in(6)) pass.components.push_back({type, options.systems && one_in(2)});
        }
        graph.passes.push_back(pass);
    }
    return graph;
}

/// Handles of the newest versions of a declared graph's resources.
using Handles = std::vector<ResourceHandle>;

inline TextureDesc texture_desc(bool deep) {
    return {{32, 32}, Format::rgba16f, TextureShape::flat, 1, deep ? 2U : 1U};
}
inline std::uint64_t buffer_count(bool deep) {
    return deep ? 64 : 32;
}

inline ResourceHandle declare(FrameGraph& frame, const Resource& resource, const std::string& name) {
    switch (resource.kind) {
        case ResourceKind::texture:
            return frame.texture(name, texture_desc(resource.deep), resource.lifetime);
        case ResourceKind::buffer:
            return frame.buffer<float>(name, buffer_count(resource.deep), resource.lifetime);
        case ResourceKind::value:
            break;
    }
    if (resource.lifetime == Lifetime::imported) return frame.import_value<int>(name);
    return frame.value<int>(name);
}

inline void declare(candela::Pass& pass, const Resource& resource, const Access& access, Handles& handles) {
    ResourceHandle& handle = handles[access.resource];
    const TextureHandle texture{handle};
    const BufferHandle<float> buffer{handle};
    const ValueHandle<int> value{handle};
    switch (resource.kind) {
        case ResourceKind::texture:
            if (!access.write) return pass.read(texture, access.usage);
            handle = pass.write(texture, access.usage);
            return;
        case ResourceKind::buffer:
            if (!access.write) return pass.read(buffer, access.usage);
            handle = pass.write(buffer, access.usage);
            return;
        case ResourceKind::value:
            if (!access.write) return pass.read(value);
            handle = pass.write(value);
    }
}

/// `make_run(pass, handles)` returns the function of pass number `pass`.
template <class MakeRun>
FrameGraph declare(const Graph& graph, Handles& handles, MakeRun make_run) {
    FrameGraph frame;
    for (std::size_t index = 0; index < graph.resources.size(); ++index) {
        const Resource& resource = graph.resources[index];
        handles.push_back(declare(frame, resource, resource_name(index)));
    }
    for (std::size_t index = 0; index < graph.passes.size(); ++index) {
        const Pass& pass = graph.passes[index];
        frame.add(pass_name(index), [&](candela::Pass& declared) {
            for (const Access& access : pass.accesses) {
                declare(declared, graph.resources[access.resource], access, handles);
            }
            if (pass.side_effect) declared.side_effect();
            for (const ComponentAccess& access : pass.components) {
                with_type(access.type, [&]<class C>(C) {
                    if (access.write) return declared.write<C>();
                    declared.read<C>();
                });
            }
            declared.run(make_run(index, handles));
        });
    }
    return frame;
}

inline CompileResult compile(const Graph& graph, std::optional<std::uint32_t> shuffle = {}) {
    Handles handles;
    return candela::compile(
        declare(graph, handles, [](std::size_t, const Handles&) { return [](Execution&) {}; }), shuffle);
}

}  // namespace candela::random_graph
