#include "tests/window/light_drag.hpp"

#include <chrono>
#include <cmath>
#include <thread>

namespace candela::sandbox {
namespace {

std::vector<double> latencies_of(const App& app) {
    std::vector<double> latencies;
    for (const nlohmann::json& record : app.history()) {
        if (!record["latency"].is_null()) latencies.push_back(record["latency"]);
    }
    return latencies;
}

}  // namespace

std::vector<double> drag_light(App& app, int steps) {
    // A camera at (0, 1, 3.9) with this field of view looks along -Z, and the light is at (0, 1.6, 0).
    const Area scene = app.scene();
    const double per_metre = scene.height / (2.0 * 3.9 * std::tan(0.685914 / 2.0));
    const double x = scene.width / 2.0;
    const double y = scene.height / 2.0 - 0.6 * per_metre;
    const auto before = static_cast<std::ptrdiff_t>(latencies_of(app).size());
    app.press_button(x, y);
    for (int step = 1; step <= steps; ++step) {
        app.move(x + 4.0 * (step % 40), y + step % 40);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    app.release_button();
    app.wait_for("the last picture",
                 [](const nlohmann::json& record) { return record["picture"] == record["submitted"]; });
    app.press_key(XK_z, {XK_Control_L});
    app.wait_for("the light back", [](const nlohmann::json& record) {
        return record["undo"] == 0 && record["picture"] == record["submitted"];
    });
    const std::vector<double> all = latencies_of(app);
    return {all.begin() + before, all.end() - 1};
}

}  // namespace candela::sandbox
