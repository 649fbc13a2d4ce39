#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "engine/graph/details/plan.hpp"

namespace candela::detail {
namespace {

using Time = std::uint64_t;  // counts passes over all frames, from 1; 0 means never

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

/// Follows the accesses of every object through repeated frames.
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
    }

 private:
    template <class Need>
    void visit(const Access& access, std::uint32_t position, Need need) {
        const Resource& resource = declared_.resources[access.resource];
        if (resource.storage->kind == ResourceKind::value) return;
        const std::uint32_t object = plan_.object[access.resource];
        const Time since = std::max(wrote_[object], access.is_incoherent() ? read_[object] : 0);
        if (since != 0) need(position, now_, barrier_for(resource.storage->kind, access.usage), since);
    }

    void note(const Access& access) {
        if (declared_.resources[access.resource].storage->kind == ResourceKind::value) return;
        const std::uint32_t object = plan_.object[access.resource];
        if (access.is_incoherent()) wrote_[object] = now_;
        if (!access.write) read_[object] = now_;
    }

    const Declaration& declared_;
    const Plan& plan_;
    std::vector<Time> wrote_;  // per object: last incoherent write
    std::vector<Time> read_;   // per object: last read
    Time now_ = 0;
};

/// Plans the barriers of one frame after the other. Each serves all accesses up to the next one.
class Planner {
 public:
    /// The barriers of a frame.
    struct Frame {
        std::vector<Barrier> before;          // per position
        std::uint32_t last = none;            // position of the last one
        Barrier of_previous = Barrier::none;  // bits that the last one of the previous frame needs for this
    };

    /// `timeline`: has followed frames until all hazards are known.
    Planner(Timeline timeline, std::size_t positions)
        : timeline_(std::move(timeline)), positions_(positions) {}

    Frame plan_next() {
        Frame frame{.before = std::vector<Barrier>(positions_, Barrier::none)};
        timeline_.run_frame([&](std::uint32_t position, Time now, Barrier bit, Time since) {
            Time& issued =
                issued_.at(static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(bit))));
            if (issued > since) return;
            if (last_ <= since) {
                last_ = now;
                frame.last = position;
            }
            issued = last_;
            Barrier& serving = frame.last == none ? frame.of_previous : frame.before[frame.last];
            serving = serving | bit;
        });
        return frame;
    }

 private:
    Timeline timeline_;
    std::size_t positions_;
    Time last_ = 0;                  // when the last barrier was issued
    std::array<Time, 10> issued_{};  // per bit: likewise
};

}  // namespace

bool any_incoherent(const Declaration& declared, const std::vector<std::uint32_t>& passes) {
    return std::ranges::any_of(passes, [&](std::uint32_t pass) {
        return std::ranges::any_of(declared.accesses_of(pass), &Access::is_incoherent);
    });
}

void plan_barriers(const Declaration& declared, Plan& plan) {
    plan.barrier.assign(plan.order.size(), Barrier::none);
    if (!any_incoherent(declared, plan.order)) return;

    // After a frame every hazard is known, also those between a frame and the next.
    Timeline timeline(declared, plan);
    timeline.run_frame([](std::uint32_t, Time, Barrier, Time) {});

    // A frame as if no barrier came before it is valid as every frame. One that follows another needs fewer,
    // where the last barrier of the frame before serves it, too. It is valid as every frame if its own last
    // barrier comes as late. If not, the next frame's comes still earlier: a few frames find the end of that.
    Planner planner(std::move(timeline), plan.order.size());
    const Planner::Frame first = planner.plan_next();
    Planner::Frame previous = first;
    for (int frame = 0; frame < 8; ++frame) {
        Planner::Frame next = planner.plan_next();
        if (next.last == none) next.last = previous.last;  // one barrier serves the whole frame
        if (next.last >= previous.last) {
            next.before[next.last] = next.before[next.last] | next.of_previous;
            plan.barrier = std::move(next.before);
            return;
        }
        previous = std::move(next);
    }
    plan.barrier = first.before;
}

}  // namespace candela::detail
