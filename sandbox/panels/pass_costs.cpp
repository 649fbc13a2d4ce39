#include "sandbox/panels/pass_costs.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace candela::sandbox {

namespace {

void add_run(PassCost& cost, double cpu_ms, double gpu_ms) {
    cost.cpu_ms = cpu_ms;
    cost.gpu_ms = gpu_ms;
    if (cost.history.size() == PassCosts::kept) cost.history.erase(cost.history.begin());
    cost.history.push_back(static_cast<float>(cost.last_ms()));
    const double sum = std::accumulate(cost.history.begin(), cost.history.end(), 0.0);
    cost.mean_ms = sum / static_cast<double>(cost.history.size());
}

}  // namespace

void PassCosts::add(const FrameReport& frame) {
    std::vector<PassCost> before = std::exchange(passes_, {});
    for (const PassReport& pass : frame.passes) {
        const auto known = std::ranges::find(before, pass.name, &PassCost::name);
        PassCost cost = known == before.end() ? PassCost{.name = pass.name} : std::move(*known);
        cost.ran = pass.ran;
        if (pass.ran) add_run(cost, pass.cpu_ms, pass.gpu_ms);
        passes_.push_back(std::move(cost));
    }
    frame_.name = "frame";
    frame_.ran = true;
    add_run(frame_, frame.cpu_ms, frame.gpu_ms);
}

}  // namespace candela::sandbox
