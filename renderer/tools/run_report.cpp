#include <candela/tools/run_report.hpp>

#include <nlohmann/json.hpp>

#include <candela/version.hpp>

namespace candela::tools {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const glm::dvec3& rgb) {
    return {rgb.r, rgb.g, rgb.b};
}

Json to_json(const FrameReport& frame) {
    Json passes = Json::array();
    for (const PassReport& pass : frame.passes) {
        passes.push_back(
            {{"name", pass.name}, {"ran", pass.ran}, {"cpu_ms", pass.cpu_ms}, {"gpu_ms", pass.gpu_ms}});
    }
    return {{"index", frame.index},
            {"cpu_ms", frame.cpu_ms},
            {"gpu_ms", frame.gpu_ms},
            {"waiting_surfels", frame.waiting_surfels},
            {"passes", passes}};
}

Json to_json(const VplReport& vpls) {
    Json flux;
    for (const EnergyLine& line : energy_lines(vpls.flux)) flux[line.name] = to_json(line.value);
    flux["roulette_error"] = to_json(vpls.flux.roulette_error);
    return {{"requested", vpls.requested},
            {"alive", vpls.alive},
            {"paths", vpls.paths},
            {"waiting", vpls.waiting},
            {"interleave", vpls.interleave},
            {"filled_pixels", vpls.filled_pixels},
            {"estimated_error", vpls.estimated_error ? Json(*vpls.estimated_error) : Json(nullptr)},
            {"flux", flux}};
}

Json to_json(const LightReport& lights) {
    return {{"count", lights.count},
            {"with_map", lights.with_map},
            {"without_map", lights.without_map},
            {"global", lights.global},
            {"tile_max", lights.tile_max},
            {"tile_mean", lights.tile_mean},
            // Lists have no maximum length, so they cannot overflow.
            {"overflowed_tiles", 0}};
}

Json to_json(const Environment& environment) {
    if (environment.radiance == glm::vec3(0.0F)) return nullptr;
    return {{"radiance", {environment.radiance.r, environment.radiance.g, environment.radiance.b}},
            {"picture", environment.picture ? Json({environment.picture->width, environment.picture->height})
                                            : Json(nullptr)},
            {"rotation", environment.rotation}};
}

Json to_json(const MemoryUse& memory) {
    return {{"texture_bytes", memory.texture_bytes},
            {"buffer_bytes", memory.buffer_bytes},
            {"shared_by_aliasing_bytes", memory.shared_by_aliasing_bytes}};
}

}  // namespace

std::string to_json(const RunReport& report) {
    Json frames = Json::array();
    for (const FrameReport& frame : report.frames) frames.push_back(to_json(frame));
    const Json json = {{"version", CANDELA_VERSION},
                       {"gl_renderer", report.state.gl_renderer},
                       {"context", report.context},
                       {"scene", report.scene},
                       {"animation", report.animation ? Json(*report.animation) : Json(nullptr)},
                       {"environment", to_json(report.environment)},
                       {"triangles", report.state.triangles},
                       {"size", {report.size.x, report.size.y}},
                       {"config", Json::parse(write_configuration(report.configuration))},
                       {"frames", frames},
                       {"refined", report.state.refined},
                       {"rendered_size", {report.state.rendered_size.x, report.state.rendered_size.y}},
                       {"vpls", report.state.vpls ? to_json(*report.state.vpls) : Json(nullptr)},
                       {"lights", to_json(report.state.lights)},
                       {"memory", to_json(report.state.memory)}};
    // A path may contain bytes that are not valid UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<EnergyLine> energy_lines(const EnergyAccount& flux) {
    return {{"emitted", flux.emitted},
            {"absorbed", flux.absorbed},
            {"escaped", flux.escaped},
            {"truncated", flux.truncated},
            {"roulette", flux.roulette}};
}

}  // namespace candela::tools
