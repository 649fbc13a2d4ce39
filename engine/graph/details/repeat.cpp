#include <algorithm>

#include "engine/graph/details/state.hpp"

namespace candela::detail {
namespace {

/// Starts with all passes that may run again on their own, and excludes those that an excluded pass prevents
/// from running, until nothing changes.
class Repetition {
 public:
    explicit Repetition(const State& state)
        : state_(state),
          again_(state.step_count()),
          settled_(state.slots.size()),
          overwritten_(state.versions.size()) {
        for (std::uint32_t index = 0; index < again_.size(); ++index) {
            const Step& step = state.steps[index];
            const bool once = step.side_effect || step.writes_import || step.keeps_state;
            again_[index] = step.has_run && !once;
            if (!again_[index]) settle(step);
        }
    }

    std::vector<std::uint8_t> find() {
        while (leave_out()) {
        }
        return std::move(again_);
    }

 private:
    /// Protects the outputs of an excluded pass: they must not be overwritten.
    void settle(const Step& step) {
        for (const Output& output : step.outputs) {
            settled_[output.slot] = 1;
            overwritten_[output.version - 1] = 1;
        }
    }

    [[nodiscard]] bool leave_out() {
        bool left_out = false;
        for (std::uint32_t index = 0; index < again_.size(); ++index) {
            const Step& step = state_.steps[index];
            if (again_[index] && !(has_inputs(step) && may_write(step))) {
                again_[index] = 0;
                settle(step);
                left_out = true;
            }
        }
        return left_out;
    }

    [[nodiscard]] bool has_inputs(const Step& step) const {
        return std::ranges::all_of(step.inputs, [this](const Input& input) {
            const Version& version = state_.versions[input.version];
            const bool made_again = version.producer < again_.size() && again_[version.producer];
            return !overwritten_[input.version] && (made_again || version.present);
        });
    }

    [[nodiscard]] bool may_write(const Step& step) const {
        return std::ranges::none_of(step.outputs,
                                    [this](const Output& output) { return settled_[output.slot]; });
    }

    const State& state_;
    std::vector<std::uint8_t> again_;        // per step: may run again
    std::vector<std::uint8_t> settled_;      // per slot: holds an output of an excluded pass
    std::vector<std::uint8_t> overwritten_;  // per version id: an excluded pass has written the next version
};

}  // namespace

std::vector<std::uint8_t> repeatable_steps(const State& state) {
    return Repetition(state).find();
}

}  // namespace candela::detail
