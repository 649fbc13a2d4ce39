#include <unordered_set>

#include "engine/graph/details/plan.hpp"

namespace candela::detail {
namespace {

/// Per transient: the first one with equal storage.
std::vector<std::uint32_t> find_equals(const std::vector<Resource>& resources) {
    const auto hash = [&](std::uint32_t index) { return resources[index].storage->hash(); };
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return *resources[a].storage == *resources[b].storage;
    };
    std::unordered_set<std::uint32_t, decltype(hash), decltype(same)> firsts(0, hash, same);
    std::vector<std::uint32_t> equals(resources.size(), none);
    std::uint32_t last = none;
    for (std::uint32_t index = 0; index < equals.size(); ++index) {
        if (resources[index].lifetime != Lifetime::transient) continue;
        const bool repeats = last != none && resources[index].storage == resources[last].storage;
        equals[index] = repeats ? equals[last] : *firsts.insert(index).first;
        last = index;
    }
    return equals;
}

/// Allocates objects to resources and takes them back. There is a free list per storage of transients.
class Objects {
 public:
    Objects(const Declaration& declared, Plan& plan)
        : declared_(declared),
          plan_(plan),
          equal_(find_equals(declared.resources)),
          free_(declared.resources.size(), none) {
        next_.reserve(declared.resources.size());
        plan_.owner.reserve(declared.resources.size());
    }

    void give(std::uint32_t index) {
        const Resource& resource = declared_.resources[index];
        if (plan_.object[index] != none) return;
        if (resource.lifetime == Lifetime::transient) {
            std::uint32_t& free = free_[equal_[index]];
            plan_.object[index] = free != none ? take(free) : create(index);
        } else {
            plan_.object[index] = create(index);
        }
    }

    void take_back(std::uint32_t index) {
        const std::uint32_t object = plan_.object[index];
        if (declared_.resources[index].lifetime != Lifetime::transient || next_[object] != in_use) return;
        std::uint32_t& free = free_[equal_[index]];
        next_[object] = free;
        free = object;
    }

 private:
    static constexpr std::uint32_t in_use = none - 1;

    std::uint32_t take(std::uint32_t& free) {
        const std::uint32_t object = free;
        free = next_[object];
        next_[object] = in_use;
        return object;
    }

    std::uint32_t create(std::uint32_t resource) {
        next_.push_back(in_use);
        plan_.owner.push_back(resource);
        return static_cast<std::uint32_t>(next_.size()) - 1;
    }

    const Declaration& declared_;
    Plan& plan_;
    std::vector<std::uint32_t> equal_;
    std::vector<std::uint32_t> free_;  // per first one with a storage: the first free object, or none
    std::vector<std::uint32_t> next_;  // per object: the next free one, none, or in_use
};

}  // namespace

void plan_objects(const Declaration& declared, Plan& plan) {
    plan.lifetime.assign(declared.resources.size(), {});
    for (std::uint32_t position = 0; position < plan.order.size(); ++position) {
        const auto use = [&](std::uint32_t resource) {
            Span& span = plan.lifetime[resource];
            if (span.first == none) span.first = position;
            span.last = position;
        };
        const std::uint32_t held_by = declared.passes[plan.order[position]].held_by;
        if (held_by != none) use(held_by);
        for (const Access& access : declared.accesses_of(plan.order[position])) use(access.resource);
    }
    plan.object.assign(declared.resources.size(), none);
    Objects objects(declared, plan);
    for (std::uint32_t position = 0; position < plan.order.size(); ++position) {
        const std::uint32_t held_by = declared.passes[plan.order[position]].held_by;
        if (held_by != none) objects.give(held_by);
        const auto accesses = declared.accesses_of(plan.order[position]);
        for (const Access& access : accesses) {
            objects.give(access.resource);
        }
        for (const Access& access : accesses) {
            if (plan.lifetime[access.resource].last == position) objects.take_back(access.resource);
        }
    }
}

}  // namespace candela::detail
