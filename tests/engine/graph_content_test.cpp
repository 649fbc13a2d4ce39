// Random graphs whose passes compute: each hashes what it reads into what it writes. What comes out must be
// what a plain evaluation of the versions gives, however passes are ordered, objects shared and passes
// skipped.

#include <doctest/doctest.h>

#include <map>

#include "tests/engine/graph_random.hpp"
#include "tests/engine/recording_backend.hpp"

namespace {

using namespace candela;
using random_graph::Graph;
using random_graph::Number;
using Content = std::uint64_t;

Content mix(Content hash, Content value) {
    hash = (hash ^ value) * 0x9e37'79b9'7f4a'7c15U;
    return hash ^ (hash >> 29U);
}

/// A pass's result, from the contents that `content_of(access)` gives for what it reads or changes. With
/// histories, what was there before is read as well.
template <class ContentOf>
Content evaluate(const Graph& graph, std::size_t pass, int number, ContentOf content_of) {
    Content hash = mix(1, pass);
    if (graph.passes[pass].reads_world) {
        hash = mix(hash, static_cast<Content>(number));
    }
    for (const random_graph::Access& access : graph.passes[pass].accesses) {
        if (!access.write || access.version > 1) {
            hash = mix(hash, content_of(access));
        }
    }
    return hash;
}

/// What a pass writes: few different values, so that they often stay equal where their inputs do not.
Content result(const random_graph::Resource& resource, std::size_t index, Content hash) {
    return resource.kind == ResourceKind::value ? mix(hash, index) % 3 : mix(hash, index);
}

/// What the host gives.
struct Host {
    int number = 0;
    std::vector<Content> imports;  // by resource
};

/// By pass and by version of each resource, as the declaration means it.
struct Meaning {
    std::vector<Content> passes;
    std::vector<std::vector<Content>> versions;
};

/// `before` gives the histories.
Meaning meaning(const Graph& graph, const std::vector<std::uint32_t>& order, const Host& host,
                const Meaning* before) {
    Meaning now;
    now.passes.resize(graph.passes.size());
    for (std::size_t index = 0; index < graph.resources.size(); ++index) {
        now.versions.emplace_back(graph.resources[index].versions + 1, 0);
        now.versions.back().front() = host.imports[index];
    }
    for (const std::uint32_t pass : order) {
        const Content hash = evaluate(graph, pass, host.number, [&](const random_graph::Access& access) {
            if (access.past) {
                return before ? before->versions[access.resource].back() : 0;
            }
            return now.versions[access.resource][access.version - (access.write ? 1 : 0)];
        });
        now.passes[pass] = hash;
        for (const random_graph::Access& access : graph.passes[pass].accesses) {
            if (!access.write) {
                continue;
            }
            now.versions[access.resource][access.version] =
                result(graph.resources[access.resource], access.resource, hash);
        }
    }
    return now;
}

/// A runtime with a back end of its own, which runs the graph's passes as computations.
class Machine {
 public:
    Machine(const Graph& graph, CompileOptions options) : graph_(graph), runtime_(backend_) {
        auto compiled = compile(random_graph::declare(graph, handles_,
                                                      [this](std::size_t pass, const auto& handles) {
                                                          return [this, pass, handles](Execution& run) {
                                                              compute(run, pass, handles);
                                                          };
                                                      }),
                                options);
        runtime_.adopt(std::move(compiled).take());
        for (std::size_t index = 0; index < graph.resources.size(); ++index) {
            const bool gpu = graph.resources[index].kind != ResourceKind::value;
            if (gpu && graph.resources[index].lifetime == Lifetime::imported) {
                imported_[index] = backend_.create_texture("import", {});
            }
        }
    }

    /// Gives the host's things: values, and whatever of its objects has changed or was written by the graph.
    void provide(const Host& host) {
        world_.set(entity_, Number{host.number});
        for (std::size_t index = 0; index < graph_.resources.size(); ++index) {
            const random_graph::Resource& resource = graph_.resources[index];
            if (resource.lifetime != Lifetime::imported) {
                continue;
            }
            if (resource.kind == ResourceKind::value) {
                runtime_.set(ValueHandle<int>{handles_.newest[index]}, static_cast<int>(host.imports[index]));
                continue;
            }
            RecordingBackend::Object& object = backend_.objects.at(imported_[index]);
            if (object.content == host.imports[index] && bound_) {
                continue;
            }
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

    /// Everything that can be seen from outside.
    void check(const Meaning& expected) const {
        RC_ASSERT(backend_.misuse.empty());
        for (const auto& [pass, hash] : seen_) {
            RC_ASSERT(hash == expected.passes[pass]);
        }
        for (const auto& [resource, object] : imported_) {
            RC_ASSERT(backend_.objects.at(object).content == expected.versions[resource].back());
        }
    }

    GraphRuntime& runtime() { return runtime_; }

 private:
    void compute(Execution& run, std::size_t pass, const random_graph::Handles& handles) {
        const Content hash = evaluate(graph_, pass, run.world().get<Number>(entity_).value,
                                      [&](const random_graph::Access& access) -> Content {
                                          if (access.past) {
                                              return past(run, access, handles);
                                          }
                                          return read(run, access.resource, handles.newest[access.resource]);
                                      });
        for (const random_graph::Access& access : graph_.passes[pass].accesses) {
            if (access.write) {
                write(run, access.resource, handles.newest[access.resource], hash);
            }
        }
        if (graph_.passes[pass].side_effect) {
            seen_[pass] = hash;
        }
    }

    ObjectId object(Execution& run, std::size_t resource, ResourceHandle handle) const {
        return graph_.resources[resource].kind == ResourceKind::texture
                   ? run.object(TextureHandle{handle})
                   : run.object(BufferHandle<float>{handle});
    }

    Content past(Execution& run, const random_graph::Access& access,
                 const random_graph::Handles& handles) const {
        const ResourceHandle handle = handles.past.at(access.resource);
        const bool valid = graph_.resources[access.resource].kind == ResourceKind::texture
                               ? run.history_valid(TextureHandle{handle})
                               : run.history_valid(BufferHandle<float>{handle});
        return valid ? backend_.objects.at(object(run, access.resource, handle)).content : 0;
    }

    Content read(Execution& run, std::size_t resource, ResourceHandle handle) const {
        if (graph_.resources[resource].kind == ResourceKind::value) {
            return static_cast<Content>(run.value(ValueHandle<int>{handle}));
        }
        return backend_.objects.at(object(run, resource, handle)).content;
    }

    void write(Execution& run, std::size_t resource, ResourceHandle handle, Content hash) {
        const Content content = result(graph_.resources[resource], resource, hash);
        if (graph_.resources[resource].kind == ResourceKind::value) {
            run.set(ValueHandle<int>{handle}, static_cast<int>(content));
        } else {
            backend_.objects.at(object(run, resource, handle)).content = content;
        }
    }

    const Graph& graph_;
    RecordingBackend backend_;
    GraphRuntime runtime_;
    random_graph::Handles handles_;
    std::map<std::size_t, ObjectId> imported_;  // by resource
    std::map<std::size_t, Content> seen_;       // by pass with a side effect
    World world_;
    Entity entity_ = world_.create();
    bool bound_ = false;
};

void edit(Host& host) {
    if (random_graph::one_in(3)) {
        host.number = static_cast<int>(random_graph::choose(3));
    }
    for (Content& import : host.imports) {
        if (random_graph::one_in(3)) {
            import = 1 + random_graph::choose(4);
        }
    }
}

/// Whether the pass must run in every frame.
bool always(const Graph& graph, std::size_t pass) {
    bool always = graph.passes[pass].side_effect;
    for (const random_graph::Access& access : graph.passes[pass].accesses) {
        always |= access.write && graph.resources[access.resource].lifetime == Lifetime::imported;
    }
    return always;
}

TEST_CASE("graph: running what is dirty gives what the declaration means, in any legal order") {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .histories = false, .backward_afters = false});
        Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine straight(graph, {});
        Machine shuffled(graph, {.shuffle_seed = *rc::gen::arbitrary<std::uint64_t>()});
        for (int frame = 0; frame < 6; ++frame) {
            const Meaning expected = meaning(graph, straight.runtime().graph()->plan().order, host, nullptr);
            for (Machine* machine : {&straight, &shuffled}) {
                machine->provide(host);
                (void)machine->run();
                machine->check(expected);
            }
            edit(host);
        }
    }));
}

TEST_CASE("graph: frames that remember the last give what the declaration means, in any legal order") {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .backward_afters = false});
        Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine straight(graph, {});
        Machine shuffled(graph, {.shuffle_seed = *rc::gen::arbitrary<std::uint64_t>()});
        Meaning before;
        for (int frame = 0; frame < 6; ++frame) {
            const Meaning expected = meaning(graph, straight.runtime().graph()->plan().order, host,
                                             frame == 0 ? nullptr : &before);
            for (Machine* machine : {&straight, &shuffled}) {
                machine->provide(host);
                machine->runtime().invalidate();  // memories are not inputs: without them all would not run
                (void)machine->run();
                machine->check(expected);
            }
            before = expected;
            edit(host);
        }
    }));
}

TEST_CASE(
    "graph: when nothing has changed, only those run that always do, and those that they lack results of") {
    CHECK(rc::check([] {
        const Graph graph = random_graph::make({.passes = 20, .histories = false, .backward_afters = false});
        const Host host{0, std::vector<Content>(graph.resources.size(), 1)};
        Machine machine(graph, {});
        machine.provide(host);
        (void)machine.run();
        const FrameRecord& record = machine.run();
        const auto& order = machine.runtime().graph()->plan().order;
        const auto feeds_one_that_ran = [&](std::size_t writer) {
            for (std::size_t position = 0; position < order.size(); ++position) {
                for (const random_graph::Access& used : graph.passes[order[position]].accesses) {
                    for (const random_graph::Access& made : graph.passes[writer].accesses) {
                        const bool handed = made.write && made.resource == used.resource &&
                                            made.version == used.version - (used.write ? 1 : 0);
                        if (handed && record.passes[position].ran) {
                            return true;
                        }
                    }
                }
            }
            return false;
        };
        for (std::size_t position = 0; position < order.size(); ++position) {
            const bool ran = record.passes[position].ran;
            const bool must = always(graph, order[position]);
            RC_ASSERT((!must || ran));
            RC_ASSERT((must || !ran || feeds_one_that_ran(order[position])));
        }
    }));
}

}  // namespace
