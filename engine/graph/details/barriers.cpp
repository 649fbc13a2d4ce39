#include <algorithm>
#include <array>
#include <bit>

#include "engine/graph/details/plan.hpp"

namespace candela::detail {
namespace {

using Time = std::uint64_t;  // counts passes over all frames, from 1; 0 means never

constexpr std::size_t bit_count = 10;

std::size_t index_of(Barrier bit) {
    return static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(bit)));
}

/// The barrier bit that orders an access after incoherent writes.
Barrier barrier_for(ResourceKind kind, Usage usage) {
    const bool texture = kind == ResourceKind::texture;
    switch (usage) {
        case Usage::sampled:
            return Barrier::texture_fetch;
        case Usage::storage:
            return texture ? Barrier::image_access : Barrier::storage;
        case Usage::uniform:
            return Barrier::uniform;
        case Usage::vertex:
            return Barrier::vertex_attrib;
        case Usage::index:
            return Barrier::element;
        case Usage::indirect:
            return Barrier::command;
        case Usage::copy:
            return texture ? Barrier::texture_update : Barrier::buffer_update;
        case Usage::colour_target:
        case Usage::depth_target:
        case Usage::layer_target:
            return Barrier::framebuffer;
    }
    return Barrier::none;
}

bool incoherent(const Access& access) {
    return access.write && access.usage == Usage::storage;
}

bool any_incoherent(const Declaration& declared, const Plan& plan) {
    return std::ranges::any_of(plan.order, [&](std::uint32_t pass) {
        return std::ranges::any_of(declared.accesses_of(pass), incoherent);
    });
}

/// Follows the accesses of every object through repeated frames. A resource and its history swap their two
/// objects in each frame.
class Timeline {
 public:
    Timeline(const Declaration& declared, const Plan& plan)
        : declared_(declared), plan_(plan), wrote_(plan.owner.size()), read_(plan.owner.size()) {}

    /// Calls `need(position, time, bit, since)` for each access that needs a barrier issued after `since`.
    template <class Need>
    void run_frame(Need need) {
        for (std::uint32_t position = 0; position < plan_.order.size(); ++position) {
            ++now_;
            const auto accesses = declared_.accesses_of(plan_.order[position]);
            for (const Access& access : accesses) {
                visit(access, position, need);
            }
            for (const Access& access : accesses) {
                note(access);
            }
        }
        ++frame_;
    }

 private:
    template <class Need>
    void visit(const Access& access, std::uint32_t position, Need need) {
        const Resource& resource = declared_.resources[access.resource];
        if (resource.storage->kind == ResourceKind::value) return;
        const std::uint32_t object = object_of(access);
        const Time since = std::max(wrote_[object], incoherent(access) ? read_[object] : 0);
        if (since != 0)
            need(position, now_, index_of(barrier_for(resource.storage->kind, access.usage)), since);
    }

    void note(const Access& access) {
        if (declared_.resources[access.resource].storage->kind == ResourceKind::value) return;
        if (incoherent(access)) wrote_[object_of(access)] = now_;
        if (!access.write) read_[object_of(access)] = now_;
    }

    [[nodiscard]] std::uint32_t object_of(const Access& access) const {
        const Resource& resource = declared_.resources[access.resource];
        if (resource.history_of != none) return plan_.object[resource.history_of] + (frame_ + 1) % 2;
        if (resource.history != none) return plan_.object[access.resource] + frame_ % 2;
        return plan_.object[access.resource];
    }

    const Declaration& declared_;
    const Plan& plan_;
    std::vector<Time> wrote_;  // per object: last incoherent write
    std::vector<Time> read_;   // per object: last read
    Time now_ = 0;
    std::uint32_t frame_ = 0;
};

}  // namespace

void plan_barriers(const Declaration& declared, Plan& plan) {
    std::vector<Barrier>& barriers = plan.barrier;
    barriers.assign(plan.order.size(), Barrier::none);
    if (!any_incoherent(declared, plan)) return;

    // The object of a history is overwritten two frames after it was written, so after two frames every
    // hazard is known.
    Timeline timeline(declared, plan);
    const auto ignore = [](std::uint32_t, Time, std::size_t, Time) {};
    timeline.run_frame(ignore);
    timeline.run_frame(ignore);

    // Plan one frame as if no barrier came before it, and issue each barrier as late as possible. The result
    // is valid for every frame.
    struct Bit {
        Time issued = 0;
        std::uint32_t first = none;   // first position that issues it
        std::uint32_t second = none;  // second position that issues it
        std::uint32_t due = none;     // first position that needs it after the previous frame's barriers
    };
    std::array<Bit, bit_count> bits;
    timeline.run_frame([&](std::uint32_t position, Time now, std::size_t index, Time since) {
        Bit& bit = bits[index];
        if (bit.issued > since) return;
        bit.issued = now;
        if (bit.first == none) {
            bit.first = position;
        } else if (bit.second == none) {
            bit.second = position;
        }
        barriers[position] = barriers[position] | static_cast<Barrier>(1U << index);
    });

    // Only the first barrier of a bit can be redundant: the last one of the previous frame may serve instead.
    timeline.run_frame([&](std::uint32_t position, Time, std::size_t index, Time since) {
        Bit& bit = bits[index];
        if (bit.issued <= since) bit.due = std::min(bit.due, position);
    });
    for (std::size_t index = 0; index < bit_count; ++index) {
        const Bit& bit = bits[index];
        if (bit.second == none || bit.due < bit.second) continue;
        barriers[bit.first] =
            static_cast<Barrier>(static_cast<std::uint32_t>(barriers[bit.first]) & ~(1U << index));
    }
}

}  // namespace candela::detail
