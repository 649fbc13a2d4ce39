#include "engine/graph/details/objects.hpp"

#include "engine/graph/details/index_table.hpp"

namespace candela::detail {
namespace {

/// For each description, the index of the first one that is equal.
template <class Desc>
std::vector<std::uint32_t> classes_of(const std::vector<Desc>& descs) {
    std::vector<std::uint32_t> classes(descs.size());
    IndexTable table(descs.size());
    for (std::uint32_t index = 0; index < descs.size(); ++index) {
        const auto same = [&](std::uint32_t other) { return descs[other] == descs[index]; };
        const std::uint32_t found = table.find_or_insert(hash_of(descs[index]), index, same);
        classes[index] = found == none ? index : found;
    }
    return classes;
}

/// Allocates objects to resources and takes them back. There is a free list per description.
class Objects {
 public:
    Objects(const Declaration& declared, Plan& plan)
        : declared_(declared),
          plan_(plan),
          texture_class_(classes_of(declared.textures)),
          buffer_class_(classes_of(declared.buffers)),
          free_texture_(declared.textures.size(), none),
          free_buffer_(declared.buffers.size(), none) {
        next_.reserve(declared.resources.size());
        plan_.owner.reserve(declared.resources.size());
    }

    void give(std::uint32_t index) {
        const Resource& resource = declared_.resources[index];
        if (resource.history_of != none) return give(resource.history_of);
        if (plan_.object[index] != none) return;
        if (resource.part_of != none) {
            give(resource.part_of);  // first, as it must be created first
        }
        if (resource.lifetime == Lifetime::transient) {
            std::uint32_t& free = free_list(resource);
            plan_.object[index] = free != none ? take(free) : create(index);
        } else {
            plan_.object[index] = create(index);
            if (resource.history != none) plan_.object[resource.history] = create(resource.history);
        }
    }

    void take_back(std::uint32_t index) {
        const Resource& resource = declared_.resources[index];
        const std::uint32_t object = plan_.object[index];
        if (resource.lifetime != Lifetime::transient || next_[object] != in_use) return;
        std::uint32_t& free = free_list(resource);
        next_[object] = free;
        free = object;
    }

 private:
    static constexpr std::uint32_t in_use = none - 1;

    std::uint32_t& free_list(const Resource& resource) {
        return resource.kind == ResourceKind::texture ? free_texture_[texture_class_[resource.desc]]
                                                      : free_buffer_[buffer_class_[resource.desc]];
    }

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
    std::vector<std::uint32_t> texture_class_;
    std::vector<std::uint32_t> buffer_class_;
    std::vector<std::uint32_t> free_texture_;  // per class: the first free object, or none
    std::vector<std::uint32_t> free_buffer_;
    std::vector<std::uint32_t> next_;  // per object: the next free one, none, or in_use
};

}  // namespace

void plan_lifetimes(const Declaration& declared, Plan& plan) {
    plan.lifetime.assign(declared.resources.size(), {});
    for (std::uint32_t position = 0; position < plan.order.size(); ++position) {
        for (const Access& access : declared.accesses_of(plan.order[position])) {
            Span& span = plan.lifetime[access.resource];
            if (span.first == none) span.first = position;
            span.last = position;
        }
    }
}

void plan_objects(const Declaration& declared, Plan& plan) {
    plan.object.assign(declared.resources.size(), none);
    Objects objects(declared, plan);
    for (std::uint32_t position = 0; position < plan.order.size(); ++position) {
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
