#include "engine/graph/details/order.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <string>

#include <fmt/format.h>

namespace candela::detail {
namespace {

/// The writer of a version runs before its readers, and both run before the writer of the next version.
std::vector<Edge> edges_of(const Declaration& declared, const Plan& plan) {
    std::vector<Edge> edges;
    edges.reserve(2 * declared.accesses.size());
    const auto add = [&](std::uint32_t before, std::uint32_t after, std::uint32_t resource) {
        if (before != none && before != after) {
            edges.push_back({before, after, resource});
        }
    };
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        for (const Access& access : declared.accesses_of(pass)) {
            const std::uint32_t version = plan.version(access.resource, access.version);
            if (access.write) {
                add(plan.writer[version - 1], pass, access.resource);
            } else {
                add(plan.writer[version], pass, access.resource);
                const bool overwritten = access.version < declared.resources[access.resource].versions;
                if (overwritten && plan.writer[version + 1] != pass) {
                    add(pass, plan.writer[version + 1], access.resource);
                }
            }
        }
    }
    return edges;
}

/// Edges grouped by the pass that comes first.
struct Successors {
    std::vector<std::uint32_t> first;  // per pass, plus one entry for the end: an index into `pass`
    std::vector<std::uint32_t> pass;

    Successors(std::uint32_t passes, const std::vector<Edge>& edges) : first(passes + 1), pass(edges.size()) {
        for (const Edge& edge : edges) {
            ++first[edge.before];
        }
        std::partial_sum(first.begin(), first.end(), first.begin());
        for (const Edge& edge : edges) {
            pass[--first[edge.before]] = edge.after;
        }
    }
};

/// The passes that are ready to run. `pop` takes the earliest declared, or with a seed a random one.
class Ready {
 public:
    explicit Ready(std::optional<std::uint64_t> seed)
        : shuffled_(seed.has_value()), random_(seed.value_or(0)) {}

    [[nodiscard]] bool empty() const { return passes_.empty(); }

    void push(std::uint32_t pass) {
        passes_.push_back(pass);
        if (!shuffled_) {
            std::push_heap(passes_.begin(), passes_.end(), std::greater<>{});
        }
    }

    std::uint32_t pop() {
        if (shuffled_) {
            std::swap(passes_[random_() % passes_.size()], passes_.back());
        } else {
            std::pop_heap(passes_.begin(), passes_.end(), std::greater<>{});
        }
        const std::uint32_t pass = passes_.back();
        passes_.pop_back();
        return pass;
    }

 private:
    std::vector<std::uint32_t> passes_;  // a heap, unless shuffled
    bool shuffled_;
    std::mt19937_64 random_;
};

std::string cycle_text(const Declaration& declared, const std::vector<Edge>& cycle) {
    std::string path(declared.passes[cycle.front().before].name);
    std::string links;
    for (const Edge& edge : cycle) {
        const std::string_view before = declared.passes[edge.before].name;
        const std::string_view after = declared.passes[edge.after].name;
        path += fmt::format(" -> {}", after);
        links += links.empty() ? "" : ", ";
        links += edge.resource == none ? fmt::format("'{}' says after '{}'", after, before)
                                       : fmt::format("'{}' hands '{}' to '{}'", before,
                                                     declared.resources[edge.resource].name, after);
    }
    return fmt::format("passes wait for each other: {} ({})", path, links);
}

/// Every pass that was not ordered (waits != 0) has a predecessor that was not ordered either, so following
/// predecessors from any of them ends in a cycle.
void report_cycles(const Declaration& declared, const std::vector<Edge>& edges,
                   const std::vector<std::uint32_t>& waits, std::vector<Fault>& faults) {
    std::vector<std::uint32_t> back(waits.size(), none);
    for (std::uint32_t index = 0; index < edges.size(); ++index) {
        if (waits[edges[index].before] != 0) {
            back[edges[index].after] = index;
        }
    }
    std::vector<std::uint32_t> walk(waits.size(), none);  // the start of the walk that visited the pass
    for (std::uint32_t start = 0; start < waits.size(); ++start) {
        if (waits[start] == 0) {
            continue;
        }
        std::uint32_t pass = start;
        while (walk[pass] == none) {
            walk[pass] = start;
            pass = edges[back[pass]].before;
        }
        if (walk[pass] != start) {
            continue;
        }
        std::vector<Edge> cycle;
        const std::uint32_t end = pass;
        do {
            cycle.push_back(edges[back[pass]]);
            pass = cycle.back().before;
        } while (pass != end);
        std::reverse(cycle.begin(), cycle.end());
        const auto by_declaration = [](const Edge& a, const Edge& b) { return a.before < b.before; };
        std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end(), by_declaration), cycle.end());
        faults.push_back({FaultCode::cycle, cycle_text(declared, cycle)});
    }
}

}  // namespace

std::vector<std::uint32_t> order_passes(const Declaration& declared, const Plan& plan,
                                        const std::vector<Edge>& afters,
                                        std::optional<std::uint64_t> shuffle_seed,
                                        std::vector<Fault>& faults) {
    std::vector<std::uint32_t> order;
    const bool backward =
        std::any_of(afters.begin(), afters.end(), [](const Edge& edge) { return edge.before >= edge.after; });
    if (!backward && !shuffle_seed) {  // handles lead only from earlier to later declared passes
        order.resize(declared.pass_count());
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }

    std::vector<Edge> edges = edges_of(declared, plan);
    edges.insert(edges.end(), afters.begin(), afters.end());
    const Successors successors(declared.pass_count(), edges);
    std::vector<std::uint32_t> waits(declared.pass_count());
    for (const Edge& edge : edges) {
        ++waits[edge.after];
    }

    Ready ready(shuffle_seed);
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        if (waits[pass] == 0) {
            ready.push(pass);
        }
    }
    order.reserve(declared.pass_count());
    while (!ready.empty()) {
        const std::uint32_t pass = ready.pop();
        order.push_back(pass);
        for (std::uint32_t at = successors.first[pass]; at < successors.first[pass + 1]; ++at) {
            if (--waits[successors.pass[at]] == 0) {
                ready.push(successors.pass[at]);
            }
        }
    }
    if (order.size() < declared.pass_count()) {
        report_cycles(declared, edges, waits, faults);
    }
    return order;
}

}  // namespace candela::detail
