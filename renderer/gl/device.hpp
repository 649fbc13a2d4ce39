#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <candela/gl_error.hpp>
#include "renderer/gl/debug_log.hpp"
#include "renderer/gl/functions.hpp"
#include "renderer/gl/raster_state.hpp"

namespace candela::gl {

enum class ObjectKind : std::uint8_t { buffer, texture, framebuffer, vertex_array, sampler, query, program };
inline constexpr std::size_t object_kinds = 7;

/// Number of live GL objects by kind, and the bytes of their storage.
struct ObjectCounts {
    std::array<std::uint32_t, object_kinds> objects{};
    std::uint64_t buffer_bytes = 0;
    std::uint64_t texture_bytes = 0;

    [[nodiscard]] std::uint32_t operator[](ObjectKind kind) const {
        return objects[static_cast<std::size_t>(kind)];
    }
    bool operator==(const ObjectCounts&) const = default;
};

/// The driver's limits.
struct Limits {
    std::uint32_t texture_size = 0;            ///< texels along an edge of a 2D texture
    std::uint32_t texture_layers = 0;          ///< layers of an array texture
    std::uint32_t buffer_texels = 0;           ///< texels of a buffer that shaders fetch
    std::uint32_t storage_blocks = 0;          ///< of a program: the least of what its stages allow
    std::uint32_t drawing_storage_blocks = 0;  ///< of a vertex or geometry shader: the lesser
    std::uint32_t storage_bindings = 0;        ///< binding points of storage blocks
    std::uint32_t uniform_bindings = 0;        ///< binding points of uniform blocks
    std::uint32_t texture_units = 0;           ///< of a shader stage
    std::int32_t debug_groups = 0;  ///< depth of the stack of debug groups, the default group included
    float anisotropy = 1.0F;        ///< largest degree; 1: no anisotropic filtering
    bool software = false;          ///< the driver renders on the CPU
    /// Iterations of all loops of an invocation together after which the driver silently stops them. The
    /// largest value: it never does.
    std::uint64_t loop_iterations = std::numeric_limits<std::uint64_t>::max();
};

/// Whether a device turns on the debug output of its context: see DebugLog. If off, it neither reads nor
/// changes the debug state of the context.
enum class DebugOutput : std::uint8_t { off, on };

/// One GL context: its functions, limits and debug log, and counts of the objects made for it. Holds no
/// global state: several devices may exist side by side, for one context or for several. It must outlive its
/// objects, and its context must be current whenever the device or one of its objects is made, used or
/// destroyed.
class Device {
 public:
    /// The context must be current. `receiver` is that of the DebugLog. Throws GlError if no context is
    /// current, if it is older than OpenGL 4.5, or if a function is missing.
    Device(const GetProc& get_proc, DebugOutput debug_output, DebugReceiver receiver = {});
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() = default;

    [[nodiscard]] const Functions& gl() const { return functions_; }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    /// For tests: as if the driver had these limits, for all passes that are declared from now on.
    void pretend(const Limits& limits) { limits_ = limits; }
    [[nodiscard]] const std::string& vendor() const { return vendor_; }      ///< GL_VENDOR
    [[nodiscard]] const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER
    [[nodiscard]] const std::string& version() const { return version_; }    ///< GL_VERSION
    [[nodiscard]] bool has_extension(std::string_view name) const;

    /// The driver's messages since the last call, oldest first: see DebugLog::take. None without debug
    /// output.
    [[nodiscard]] std::vector<DebugMessage> take_messages();

    /// How the next draws rasterise.
    void set_raster_state(const RasterState& state) { raster_states_.set(functions_, state); }
    /// Sets the default state, also where others have changed it.
    void reset_raster_state() { raster_states_.reset(functions_); }

    /// Waits until the GPU has done everything so far.
    void finish() const { functions_.Finish(); }

    /// Objects made for this device that are alive now.
    [[nodiscard]] const ObjectCounts& live() const { return live_; }

 private:
    friend class Object;

    Functions functions_;
    std::string vendor_;
    std::string renderer_;
    std::string version_;
    std::vector<std::string> extensions_;  ///< sorted
    Limits limits_;
    ObjectCounts live_;
    RasterStates raster_states_;
    std::optional<DebugLog> log_;
};

}  // namespace candela::gl
