#include "engine/graph/details/order.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <random>
#include <vector>

namespace candela::detail {
namespace {

/// The writer of a version runs before its readers, and both run before the writer of the next version.
std::vector<Edge> edges_of(const Declaration& declared, const Plan& plan) {
    std::vector<Edge> edges;
    edges.reserve(2 * declared.accesses.size());
    const auto add = [&](std::uint32_t before, std::uint32_t after) {
        if (before != none && before != after) {
            edges.push_back({before, after});
        }
    };
    for (std::uint32_t pass = 0; pass < declared.pass_count(); ++pass) {
        for (const Access& access : declared.accesses_of(pass)) {
            const std::uint32_t version = plan.version(access.resource, access.version);
            if (access.write) {
                add(plan.writer[version - 1], pass);
            } else {
                add(plan.writer[version], pass);
                const bool overwritten = access.version < declared.resources[access.resource].versions;
                if (overwritten && plan.writer[version + 1] != pass) {
                    add(pass, plan.writer[version + 1]);
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

}  // namespace

std::vector<std::uint32_t> order_passes(const Declaration& declared, const Plan& plan,
                                        std::optional<std::uint64_t> shuffle_seed) {
    std::vector<std::uint32_t> order(declared.pass_count());
    std::iota(order.begin(), order.end(), 0U);
    if (!shuffle_seed) {
        return order;
    }

    const std::vector<Edge> edges = edges_of(declared, plan);
    const Successors successors(declared.pass_count(), edges);
    std::vector<std::uint32_t> waits(declared.pass_count());
    for (const Edge& edge : edges) {
        ++waits[edge.after];
    }
    std::vector<std::uint32_t> ready;
    std::ranges::copy_if(order, std::back_inserter(ready),
                         [&](std::uint32_t pass) { return waits[pass] == 0; });
    order.clear();
    std::mt19937_64 random(*shuffle_seed);
    while (!ready.empty()) {
        std::swap(ready[random() % ready.size()], ready.back());
        const std::uint32_t pass = ready.back();
        ready.pop_back();
        order.push_back(pass);
        for (std::uint32_t at = successors.first[pass]; at < successors.first[pass + 1]; ++at) {
            if (--waits[successors.pass[at]] == 0) {
                ready.push_back(successors.pass[at]);
            }
        }
    }
    return order;
}

}  // namespace candela::detail
