#include "renderer/passes/scene/traced_content.hpp"

#include <doctest/doctest.h>

#include <optional>
#include <vector>

#include <candela/ecs/world.hpp>
#include <candela/graph/compile.hpp>
#include <candela/graph/recording_backend.hpp>

TEST_SUITE("traced content") {

using namespace candela;

namespace {

/// A graph with one pass, which keeps what it has traced in a buffer.
class TracingPass {
 public:
    TracingPass() {
        FrameGraph graph;
        motion_ = graph.import_value<SceneMotion>("motion");
        key_ = graph.import_value<int>("key");
        size_ = graph.import_value<std::uint64_t>("size");
        graph.add("trace", [&](Pass& pass) {
            pass.side_effect();
            pass.read(motion_);
            pass.read(key_);
            pass.read(size_);
            const auto buffer =
                pass.update(graph.buffer<float>("content", 1, Lifetime::persistent), Usage::copy);
            const TracedContent<int> kept(graph, pass, "kept");
            pass.run([=, this](Execution& run) {
                run.reserve(buffer, run.value(size_));
                const std::vector<ObjectId> objects{run.object(buffer)};
                if (run.value(key_) < 0) {
                    kept.forget(run);
                } else if (tasks_) {
                    done_ = kept.tasks_done(run, *tasks_, run.value(key_), objects, objects);
                } else {
                    outdated_ = kept.outdated(run, run.value(motion_), run.value(key_), objects);
                }
            });
        });
        runtime_.switch_to(compile(std::move(graph)).take());
    }

    /// Which tasks up to those of this number the pass has done.
    TasksDone done(std::uint64_t number, int key, std::uint64_t size) {
        static_cast<void>(outdated(0, key, size, number));
        return done_;
    }

    /// What the pass has to trace again. `step`: steps of motion so far, of which the last moved one thing.
    std::optional<std::vector<Box>> outdated(std::uint64_t step, int key, std::uint64_t size,
                                             std::optional<std::uint64_t> tasks = std::nullopt) {
        tasks_ = tasks;
        SceneMotion motion;
        motion.step = step;
        motion.everything = false;
        motion.boxes = {box};
        runtime_.set(motion_, motion);
        runtime_.set(key_, key);
        runtime_.set(size_, size);
        runtime_.run(world_);
        return outdated_;
    }

    static constexpr Box box{glm::vec3(1.0F), glm::vec3(2.0F)};

 private:
    RecordingBackend backend_;
    GraphRuntime runtime_{backend_};
    World world_;
    ValueHandle<SceneMotion> motion_;
    ValueHandle<int> key_;
    ValueHandle<std::uint64_t> size_;
    std::optional<std::uint64_t> tasks_;  // number; none: all that is outdated is traced
    std::optional<std::vector<Box>> outdated_;
    TasksDone done_ = TasksDone::none;
};

}  // namespace

TEST_CASE_FIXTURE(TracingPass, "of numbered tasks, it is known which are done as long as none is left out") {
    CHECK(done(4, 1, 8) == TasksDone::none);
    CHECK(done(4, 1, 8) == TasksDone::all);
    CHECK(done(5, 1, 8) == TasksDone::all_before);
    CHECK(done(5, 1, 8) == TasksDone::all);
    CHECK(done(7, 1, 8) == TasksDone::none);
    CHECK(done(7, 2, 8) == TasksDone::none);     // another key
    CHECK(done(8, 2, 1000) == TasksDone::none);  // another object
    CHECK(done(9, 2, 1000) == TasksDone::all_before);
}

TEST_CASE_FIXTURE(TracingPass, "all of it is traced first, then where something has moved") {
    CHECK(outdated(0, 1, 8) == std::nullopt);
    CHECK(outdated(0, 1, 8) == std::vector<Box>{});
    CHECK(outdated(1, 1, 8) == std::vector<Box>{box});
    CHECK(outdated(1, 1, 8) == std::vector<Box>{});
    CHECK(outdated(3, 1, 8) == std::nullopt);  // the boxes of step 2 are not known
}

TEST_CASE_FIXTURE(TracingPass, "another key, another object or other content make all of it outdated") {
    CHECK(outdated(0, 1, 8) == std::nullopt);
    CHECK(outdated(0, 2, 8) == std::nullopt);
    CHECK(outdated(0, 2, 8) == std::vector<Box>{});
    CHECK(outdated(0, 2, 80) == std::nullopt);
    CHECK(outdated(0, 2, 8) == std::vector<Box>{});
    (void)outdated(0, -1, 8);
    CHECK(outdated(0, 2, 8) == std::nullopt);
}

}  // TEST_SUITE("traced content")
