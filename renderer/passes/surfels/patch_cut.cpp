#include "renderer/passes/surfels/patch_cut.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

namespace candela {
namespace {

/// The cut on its way, and where it differs from the one that it follows.
class Follower {
 public:
    Follower(PatchTree& tree, std::span<const std::uint32_t> roots, const CutWay& way, double gain)
        : tree_(tree), way_(way) {
        for (const std::uint32_t root : roots) compare_root(root);
        std::ranges::sort(closes_, {}, [](const Close& close) { return std::pair(close.weight, close.id); });
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [id, place] : way.to.places) {
            if (place.opened) least = std::min(least, place.weight);
        }
        least_weight_ = gain * least;
    }

    void advance(const CutLimits& limits) {
        auto close = closes_.begin();
        while (new_cells_ < limits.new_cells) {
            const bool opens = is_worth_it();
            const bool closes = close != closes_.end() && (opens || limits.gain <= 1.0);
            if (opens && (cells_ < limits.cells || !closes)) {
                open_next();
            } else if (closes) {
                apply(*close++);
            } else {
                break;
            }
        }
        closes_.erase(closes_.begin(), close);
    }

    [[nodiscard]] FollowedCut result() && {
        ChangesLeft left{.all = static_cast<std::uint32_t>(opens_.size() + closes_.size())};
        for (; is_worth_it(); opens_.pop()) ++left.gains;
        return {std::move(cut_), left};
    }

 private:
    /// A patch that the other cut has as a cell, or a root that has no cells there.
    struct Close {
        double weight = 0.0;
        std::uint64_t id = 0;
        std::uint32_t patch = 0;
        std::size_t cells = 0;  // in it
        bool is_root = false;   // that has no cells there
    };

    [[nodiscard]] std::uint64_t id_of(std::uint32_t patch) const { return tree_[patch].id; }

    /// Patches of other shapes may have the same id, and be whole.
    bool is_opened(const PatchCut& cut, std::uint32_t patch) {
        return cut.opens(id_of(patch)) && tree_.cut(patch);
    }

    void compare_root(std::uint32_t root) {
        const std::uint64_t id = id_of(root);
        const auto before = way_.from.scales.find(id), after = way_.to.scales.find(id);
        const bool was_there = before != way_.from.scales.end(), will_be = after != way_.to.scales.end();
        if (was_there) cut_.scales.emplace(id, will_be ? after->second : before->second);
        if (was_there && will_be) {
            compare(root);
        } else if (was_there) {
            add_close(root, {.weight = way_.from.places.at(id).weight, .is_root = true});
        } else if (will_be) {
            opens_.emplace(std::numeric_limits<double>::infinity(), id, root);
        }
    }

    void compare(std::uint32_t patch) {
        const bool was_opened = is_opened(way_.from, patch), will_be = is_opened(way_.to, patch);
        if (was_opened && will_be) {
            cut_.places[id_of(patch)].opened = true;
            const std::uint32_t first = tree_[patch].first;
            compare(first);
            compare(first + 1);
        } else if (was_opened) {
            add_close(patch, {.weight = way_.to.places.at(id_of(patch)).weight});
        } else {
            ++cells_;
            if (will_be) queue(patch);
        }
    }

    void add_close(std::uint32_t patch, Close close) {
        close.id = id_of(patch);
        close.patch = patch;
        close.cells = keep(patch);
        cells_ += close.cells;
        closes_.push_back(close);
    }

    /// Returns how many cells are in a patch of the cut that is followed from.
    std::size_t keep(std::uint32_t patch) {
        if (!is_opened(way_.from, patch)) return 1;
        cut_.places[id_of(patch)].opened = true;
        const std::uint32_t first = tree_[patch].first;
        return keep(first) + keep(first + 1);
    }

    void queue(std::uint32_t patch) {
        const std::uint64_t id = id_of(patch);
        opens_.emplace(way_.to.places.at(id).weight, id, patch);
    }

    [[nodiscard]] bool is_worth_it() const {
        return !opens_.empty() && std::get<0>(opens_.top()) >= least_weight_;
    }

    void add_new(std::uint32_t patch) {
        new_.insert(patch);
        if (is_opened(way_.to, patch)) queue(patch);
    }

    void open_next() {
        const std::uint64_t id = std::get<1>(opens_.top());
        const std::uint32_t patch = std::get<2>(opens_.top());
        opens_.pop();
        ++cells_;
        const auto scale = way_.to.scales.find(id);
        if (scale != way_.to.scales.end() && cut_.scales.insert(*scale).second) {
            ++new_cells_;
            add_new(patch);
            return;
        }
        cut_.places[id].opened = true;
        new_cells_ += new_.contains(patch) ? 1 : 2;
        const std::uint32_t first = tree_[patch].first;
        add_new(first);
        add_new(first + 1);
    }

    void apply(const Close& close) {
        close_all(close.patch);
        cells_ -= close.cells;
        if (close.is_root) {
            cut_.scales.erase(close.id);
            return;
        }
        ++cells_;
        ++new_cells_;
    }

    void close_all(std::uint32_t patch) {
        if (cut_.places.erase(id_of(patch)) == 0) return;
        const std::uint32_t first = tree_[patch].first;
        close_all(first);
        close_all(first + 1);
    }

    PatchTree& tree_;
    CutWay way_;
    PatchCut cut_;
    double least_weight_ = 0.0;  // of what is worth to be opened
    std::size_t cells_ = 0;      // of the cut
    std::size_t new_cells_ = 0;  // that have become cells, about
    std::unordered_set<std::uint32_t> new_;
    // Weight, id and index of cells, and of roots without any.
    std::priority_queue<std::tuple<double, std::uint64_t, std::uint32_t>> opens_;
    std::vector<Close> closes_;
};

}  // namespace

FollowedCut follow(PatchTree& tree, std::span<const std::uint32_t> roots, const CutWay& way,
                   const CutLimits& limits) {
    const auto is_common = [&](std::uint32_t root) { return way.from.scales.contains(tree[root].id); };
    if (std::ranges::none_of(roots, is_common)) return {.cut = way.to};
    Follower follower(tree, roots, way, limits.gain);
    follower.advance(limits);
    return std::move(follower).result();
}

}  // namespace candela
