#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/graph/execute.hpp>
#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/scene/scene_motion.hpp"

namespace candela {

/// Of tasks that have numbers: none of them, all before those of a number, or these, too.
enum class TasksDone : std::uint8_t { none, all_before, all };

/// What rays through the scene have found, in persistent buffers or textures that a pass updates. Where
/// nothing has moved it stays, as long as the key is the same, which says what else it was made from, and as
/// long as the objects that hold it are: Execution::reserve may have replaced them.
template <class Key>
class TracedContent {
 public:
    TracedContent(FrameGraph& graph, Pass& pass, std::string_view name)
        : record_(pass.update(graph.value<Record>(name))) {}

    /// World-space boxes around everything that has changed since the content was traced; nullopt if all of
    /// it must be traced. The pass then has to bring it up to date.
    [[nodiscard]] std::optional<std::vector<Box>> outdated(Execution& run, const SceneMotion& motion, Key key,
                                                           std::vector<ObjectId> objects) const {
        const std::vector<ObjectId> held = objects;
        return outdated(run, motion, std::move(key), held, std::move(objects));
    }

    /// The same for a pass that has moved the content from the objects `held` to others.
    [[nodiscard]] std::optional<std::vector<Box>> outdated(Execution& run, const SceneMotion& motion, Key key,
                                                           const std::vector<ObjectId>& held,
                                                           std::vector<ObjectId> objects) const {
        Record now{std::move(key), std::move(objects), motion.step};
        const Record* const last = run.previous(record_);
        std::optional<std::vector<Box>> changed;
        if (last != nullptr && last->key == now.key && last->objects == held) {
            changed = changed_boxes(motion, last->step);
        }
        run.set(record_, std::move(now));
        return changed;
    }

    /// Which tasks have been done, for a pass that traces by the tasks of a number (SurfelTasks). Its keys
    /// have to be others than those of passes that call `outdated`. The pass then has to do the rest.
    [[nodiscard]] TasksDone tasks_done(Execution& run, std::uint64_t number, Key key,
                                       const std::vector<ObjectId>& held,
                                       std::vector<ObjectId> objects) const {
        Record now{std::move(key), std::move(objects), number};
        const Record* const last = run.previous(record_);
        TasksDone done = TasksDone::none;
        if (last != nullptr && last->key == now.key && last->objects == held) {
            if (last->step == number) done = TasksDone::all;
            if (last->step + 1 == number) done = TasksDone::all_before;
        }
        run.set(record_, std::move(now));
        return done;
    }

    /// The pass overwrites the content with something else.
    void forget(Execution& run) const { run.set(record_, {}); }

 private:
    struct Record {
        Key key{};
        std::vector<ObjectId> objects;
        std::uint64_t step = 0;  // of the scene's motion, or number of the tasks
        bool operator==(const Record&) const = default;
    };
    ValueHandle<Record> record_;
};

}  // namespace candela
