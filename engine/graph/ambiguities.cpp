#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <candela/graph/compile.hpp>
#include "engine/graph/details/schedule.hpp"

namespace candela {
namespace {

using namespace detail;

/// Which passes come after `first` for a reason that somebody has declared. The order in which passes write
/// the same components, or have side effects, is only that of their declaration.
std::vector<bool> passes_after(std::uint32_t first, const std::vector<Dependency>& dependencies,
                               std::size_t passes) {
    std::vector<bool> after(passes);
    after[first] = true;
    for (const Dependency& dependency : dependencies) {  // ordered by the later pass
        const bool declared = dependency.kind != DependencyKind::component_overwrite &&
                              dependency.kind != DependencyKind::side_effect;
        if (declared && after[dependency.from]) after[dependency.to] = true;
    }
    return after;
}

bool writes(const Declaration& declared, std::uint32_t pass, std::size_t component) {
    return std::ranges::any_of(declared.components_of(pass), [&](const ComponentAccess& access) {
        return access.write && access.type == component;
    });
}

}  // namespace

std::vector<Ambiguity> find_ambiguities(const CompiledGraph& graph) {
    const Declaration& declared = graph.declared();
    std::vector<std::uint32_t> kept = graph.plan().order;
    std::ranges::sort(kept);
    const std::vector<Dependency> dependencies = find_dependencies(declared, graph.plan(), kept);
    std::vector<Ambiguity> found;
    for (const std::uint32_t first : kept) {
        const std::vector<bool> after = passes_after(first, dependencies, declared.pass_count());
        for (const ComponentAccess& access : declared.components_of(first)) {
            if (!access.write) continue;
            for (std::uint32_t second = first + 1; second < declared.pass_count(); ++second) {
                if (after[second] || !writes(declared, second, access.type)) continue;
                found.push_back({std::string(access.name), std::string(declared.passes[first].name),
                                 std::string(declared.passes[second].name)});
            }
        }
    }
    return found;
}

}  // namespace candela
