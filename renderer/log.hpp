#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace candela {

/// Passes warnings on to the host, each line once. Without a receiver, it does nothing.
class Log {
 public:
    using Receiver = std::function<void(std::string_view line)>;

    explicit Log(Receiver receiver) : receiver_(std::move(receiver)) {}

    /// Line breaks and other control characters in `line` become spaces.
    void warn(std::string line) {
        std::ranges::replace_if(
            line, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
        line.erase(line.find_last_not_of(' ') + 1);
        const auto [known, is_new] = known_.insert(std::move(line));
        if (receiver_ && is_new) {
            receiver_(*known);
        }
    }

 private:
    Receiver receiver_;
    std::unordered_set<std::string> known_;
};

}  // namespace candela
