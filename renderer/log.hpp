#pragma once

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

    void warn(const std::string& line) {
        if (receiver_ && known_.insert(line).second) {
            receiver_(line);
        }
    }

 private:
    Receiver receiver_;
    std::unordered_set<std::string> known_;
};

}  // namespace candela
