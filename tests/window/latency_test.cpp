// How long a picture takes to follow the pointer. A measurement, not a test: it only runs if asked for.

#include "tests/window/app.hpp"
#include "tests/window/light_drag.hpp"

#include <algorithm>
#include <cstdio>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

namespace candela::sandbox {
namespace {

/// A process that uses all of a core while this object lives.
class BusyProcess {
 public:
    BusyProcess() : process_(fork()) {
        while (process_ == 0) {
        }
        REQUIRE(process_ > 0);
    }
    BusyProcess(const BusyProcess&) = delete;
    BusyProcess& operator=(const BusyProcess&) = delete;
    ~BusyProcess() {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }

 private:
    pid_t process_;
};

/// `share` of the values, which are not sorted, are at most this.
double quantile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace

TEST_CASE("latency of a drag, alone and with busy processes beside" * doctest::skip()) {
    constexpr int drags = 8;
    App app({.width = 1280, .height = 720});
    fmt::print("busy processes | median s | 95th | first\n");
    for (const std::size_t count : {0U, 1U, 2U}) {
        const std::vector<BusyProcess> busy(count);
        std::vector<double> all;
        std::vector<double> first;
        for (int i = 0; i < drags; ++i) {
            app.wait_for("refinement", [](const nlohmann::json& record) { return record["refined"] > 1; });
            const std::vector<double> latencies = drag_light(app, 60);
            REQUIRE(!latencies.empty());
            first.push_back(latencies.front());
            all.insert(all.end(), latencies.begin(), latencies.end());
        }
        fmt::print("{:14} | {:8.3f} | {:4.3f} | {:5.3f}\n", count, quantile(all, 0.5), quantile(all, 0.95),
                   quantile(first, 0.5));
        std::fflush(stdout);
    }
    CHECK(app.errors().empty());
}

}  // namespace candela::sandbox
