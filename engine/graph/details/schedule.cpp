#include "engine/graph/details/schedule.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <random>
#include <utility>

namespace candela::detail {
namespace {

/// Finds the dependencies of passes, which are visited in the order of declaration.
class Dependencies {
 public:
    Dependencies(const Declaration& declared, const Plan& plan)
        : declared_(declared),
          plan_(plan),
          visited_(declared.pass_count()),
          last_reader_(plan.writer.size(), none) {
        for (std::uint32_t index = 0; index < declared.components.size(); ++index) {
            if (!find_type(declared.components[index].type)) types_.push_back({.access = index});
        }
        found_.reserve(declared.accesses.size());
        readers_.reserve(declared.accesses.size());
    }

    void visit(std::uint32_t pass) {
        for (const Access& access : declared_.accesses_of(pass)) {
            visit(pass, access);
        }
        // Reads first: a pass that does both reads what the one before has written.
        for (const bool write : {false, true}) {
            for (const ComponentAccess& access : declared_.components_of(pass)) {
                if (access.write == write) visit(pass, *find_type(access.type), write);
            }
        }
        const PassNode& node = declared_.passes[pass];
        if (node.writes_entities) {
            for (Type& type : types_) {
                visit(pass, type, true);
            }
        }
        if (node.side_effect) add(std::exchange(last_side_effect_, pass), pass, DependencyKind::side_effect);
        visit_after(pass);
        visited_[pass] = 1;
    }

    std::vector<Dependency> take() { return std::move(found_); }

 private:
    /// The passes that access a type of component.
    struct Type {
        std::uint32_t access;                  // one of them, in Declaration::components
        std::uint32_t writer = none;           // the last one so far
        std::vector<std::uint32_t> readers{};  // since then
    };
    /// A pass that reads a version, in a list for each version.
    struct Reader {
        std::uint32_t pass;
        std::uint32_t next;  // in readers_
    };

    void add(std::uint32_t from, std::uint32_t to, DependencyKind kind, std::uint32_t subject = none) {
        if (from != none && from != to) found_.push_back({from, to, kind, subject});
    }

    void visit(std::uint32_t pass, const Access& access) {
        const std::uint32_t needed = plan_.needed_version(access);
        add(plan_.writer[needed], pass, DependencyKind::result, access.resource);
        std::uint32_t& last = last_reader_[needed];
        if (!access.write) {
            readers_.push_back({pass, std::exchange(last, size_of(readers_))});
            return;
        }
        for (std::uint32_t at = last; at != none; at = readers_[at].next) {
            add(readers_[at].pass, pass, DependencyKind::overwrite, access.resource);
        }
    }

    void visit(std::uint32_t pass, Type& type, bool write) {
        if (!write) {
            add(type.writer, pass, DependencyKind::component_result, type.access);
            type.readers.push_back(pass);
            return;
        }
        add(type.writer, pass, DependencyKind::component_overwrite, type.access);
        for (const std::uint32_t reader : type.readers) {
            add(reader, pass, DependencyKind::component_overwrite, type.access);
        }
        type.readers.clear();
        type.writer = pass;
    }

    void visit_after(std::uint32_t pass) {
        for (; next_after_ < declared_.after.size(); ++next_after_) {
            const After& after = declared_.after[next_after_];
            if (after.pass > pass) return;
            if (after.pass == pass && visited_[after.before]) {
                add(after.before, pass, DependencyKind::after);
            }
        }
    }

    [[nodiscard]] Type* find_type(std::size_t type) {
        const auto found = std::ranges::find_if(
            types_, [&](const Type& other) { return declared_.components[other.access].type == type; });
        return found == types_.end() ? nullptr : &*found;
    }

    const Declaration& declared_;
    const Plan& plan_;
    std::vector<std::uint8_t> visited_;       // per pass
    std::vector<std::uint32_t> last_reader_;  // per version id: in readers_, or none
    std::vector<Reader> readers_;
    std::vector<Type> types_;
    std::uint32_t last_side_effect_ = none;
    std::size_t next_after_ = 0;  // in Declaration::after
    std::vector<Dependency> found_;
};

/// Follows incoherent writes through the order in which passes are scheduled.
class Hazards {
 public:
    explicit Hazards(const Declaration& declared)
        : declared_(declared), wrote_(declared.resources.size()), read_(declared.resources.size()) {}

    [[nodiscard]] bool needs_barrier(std::uint32_t pass) const {
        return std::ranges::any_of(declared_.accesses_of(pass), [this](const Access& access) {
            const std::uint32_t since = access.is_incoherent()
                                            ? std::max(wrote_[access.resource], read_[access.resource])
                                            : wrote_[access.resource];
            return since > last_barrier_;
        });
    }

    void run(std::uint32_t pass) {
        if (needs_barrier(pass)) last_barrier_ = now_;
        ++now_;
        for (const Access& access : declared_.accesses_of(pass)) {
            if (access.is_incoherent()) wrote_[access.resource] = now_;
            if (!access.write) read_[access.resource] = now_;
        }
    }

 private:
    const Declaration& declared_;
    std::vector<std::uint32_t> wrote_;  // per resource: when it was last written incoherently, or 0
    std::vector<std::uint32_t> read_;   // per resource: when it was last read, or 0
    std::uint32_t now_ = 0;             // number of passes so far
    std::uint32_t last_barrier_ = 0;    // number of passes before it
};

/// Takes the passes that may run one after the other.
class Scheduler {
 public:
    Scheduler(const Declaration& declared, const std::vector<Dependency>& dependencies,
              const std::vector<std::uint32_t>& kept)
        : hazards_(declared), waits_for_(declared.pass_count()), first_(declared.pass_count() + 1) {
        for (const Dependency& dependency : dependencies) {
            ++waits_for_[dependency.to];
            ++first_[dependency.from + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        followers_.resize(dependencies.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (const Dependency& dependency : dependencies) {
            followers_[next[dependency.from]++] = dependency.to;
        }
        std::copy_if(kept.rbegin(), kept.rend(), std::back_inserter(ready_),
                     [this](std::uint32_t pass) { return waits_for_[pass] == 0; });
    }

    [[nodiscard]] bool is_done() const { return ready_.empty(); }

    /// A pass near the first declared one.
    std::uint32_t take_next() {
        const auto near_end = ready_.rbegin() + std::min(look_ahead, std::ssize(ready_));
        const auto found = std::find_if(ready_.rbegin(), near_end,
                                        [this](std::uint32_t pass) { return !hazards_.needs_barrier(pass); });
        return take(std::next(found == near_end ? ready_.rbegin() : found).base());
    }

    std::uint32_t take_any(std::mt19937& random) {
        return take(ready_.begin() + std::uniform_int_distribution(0L, std::ssize(ready_) - 1)(random));
    }

 private:
    /// How many of the passes that may run are looked at. The renderer's frames get their fewest barriers by
    /// this; the farther away passes are declared, the longer results wait for their readers in memory.
    static constexpr std::ptrdiff_t look_ahead = 16;

    std::uint32_t take(std::vector<std::uint32_t>::iterator chosen) {
        const std::uint32_t pass = *chosen;
        ready_.erase(chosen);
        hazards_.run(pass);
        for (std::uint32_t at = first_[pass]; at < first_[pass + 1]; ++at) {
            if (--waits_for_[followers_[at]] == 0) make_ready(followers_[at]);
        }
        return pass;
    }

    void make_ready(std::uint32_t pass) {
        ready_.insert(std::ranges::lower_bound(ready_, pass, std::greater<>()), pass);
    }

    Hazards hazards_;
    std::vector<std::uint32_t> waits_for_;  // per pass: dependencies on passes that have not been taken
    std::vector<std::uint32_t> first_;      // per pass: of its followers
    std::vector<std::uint32_t> followers_;
    std::vector<std::uint32_t> ready_;  // the last declared pass first
};

}  // namespace

std::vector<Dependency> find_dependencies(const Declaration& declared, const Plan& plan,
                                          const std::vector<std::uint32_t>& kept) {
    Dependencies dependencies(declared, plan);
    for (const std::uint32_t pass : kept) {
        dependencies.visit(pass);
    }
    return dependencies.take();
}

std::vector<std::uint32_t> schedule(const Declaration& declared, const Plan& plan,
                                    const std::vector<std::uint32_t>& kept,
                                    std::optional<std::uint32_t> shuffle) {
    // Without barriers, no order is better than that of declaration, which is legal.
    if (!shuffle && !any_incoherent(declared, kept)) return kept;
    std::vector<std::uint32_t> order;
    order.reserve(kept.size());
    Scheduler scheduler(declared, find_dependencies(declared, plan, kept), kept);
    std::optional<std::mt19937> random;
    if (shuffle) random.emplace(*shuffle);
    while (!scheduler.is_done()) {
        order.push_back(random ? scheduler.take_any(*random) : scheduler.take_next());
    }
    return order;
}

}  // namespace candela::detail
