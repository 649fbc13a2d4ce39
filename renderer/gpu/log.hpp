#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "engine/readable.hpp"

namespace candela {

/// Passes warnings on to the host, each line once. Without a receiver, it does nothing. Of warnings of the
/// same kind, which differ in what they are about, the first ten are passed on, and the others are counted.
class Log {
 public:
    using Receiver = std::function<void(std::string_view line)>;

    explicit Log(Receiver receiver) : receiver_(std::move(receiver)) {}

    /// Line breaks in `line` become spaces; other control characters are made visible.
    void warn(std::string line) {
        std::ranges::replace(line, '\n', ' ');
        line.erase(line.find_last_not_of(' ') + 1);
        pass_on(readable(line, longest_line));
    }

    /// A warning about one of many things: "entity 3: left out, because ..." is of the kind "left out,
    /// because ...".
    void warn(std::string_view what, std::string_view kind) {
        const std::string line = fmt::format("{}: {}", readable(what), readable(kind, longest_line));
        if (known_.contains(line)) return;
        Kind& same = kinds_[readable(kind, longest_line)];
        if (same.shown < most_of_a_kind) {
            ++same.shown;
            pass_on(line);
        } else {
            same.others.insert(std::hash<std::string>{}(line));
        }
    }

    /// Says how many warnings of each kind were not passed on, if there are more than it has said.
    void tell_counts() {
        for (auto& [kind, same] : kinds_) {
            if (same.others.size() > std::exchange(same.told, same.others.size())) {
                pass_on(fmt::format("{} more: {}", grouped(same.others.size()), kind));
            }
        }
    }

 private:
    struct Kind {
        std::size_t shown = 0;
        std::unordered_set<std::size_t> others{};  // hashes of the lines that were not passed on
        std::size_t told = 0;                      // how many of the others have been told
    };

    static constexpr std::size_t longest_line = 2000;
    static constexpr std::size_t most_of_a_kind = 10;

    void pass_on(std::string line) {
        const auto [known, is_new] = known_.insert(std::move(line));
        if (receiver_ && is_new) receiver_(*known);
    }

    Receiver receiver_;
    std::unordered_set<std::string> known_;
    std::map<std::string, Kind> kinds_;
};

}  // namespace candela
