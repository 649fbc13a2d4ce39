#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/debug_log.hpp"
#include "renderer/gl/error.hpp"
#include "renderer/gl/functions.hpp"

namespace candela::gl {

enum class ObjectKind : std::uint8_t { buffer, texture, framebuffer, vertex_array, sampler, query, program };
inline constexpr std::size_t object_kinds = 7;

/// GL objects alive, by kind, and the bytes of their storage.
struct ObjectCounts {
    std::array<std::uint32_t, object_kinds> objects{};
    std::uint64_t buffer_bytes = 0;
    std::uint64_t texture_bytes = 0;

    [[nodiscard]] std::uint32_t operator[](ObjectKind kind) const {
        return objects[static_cast<std::size_t>(kind)];
    }
    bool operator==(const ObjectCounts&) const = default;
};

/// What the driver allows.
struct Limits {
    std::uint32_t texture_size = 0;              ///< texels along an edge
    std::uint32_t texture_layers = 0;            ///< layers of an array texture
    std::uint32_t colour_attachments = 0;        ///< of one framebuffer
    std::uint64_t storage_block_bytes = 0;       ///< of one shader storage block
    std::uint32_t uniform_block_bytes = 0;       ///< of one uniform block
    std::uint32_t storage_alignment = 1;         ///< bytes, of an offset bound as shader storage
    std::uint32_t uniform_alignment = 1;         ///< bytes, of an offset bound as a uniform buffer
    std::array<std::uint32_t, 3> work_groups{};  ///< of one dispatch, in x, y and z
    float anisotropy = 1.0F;                     ///< 1: none
};

/// One GL context as Candela sees it: its functions, limits and debug log, and the account of the objects
/// made in it. Holds no global state: several devices live side by side, on one context or on several.
/// Outlives its objects; its context must be current whenever it or one of its objects is made, used or
/// destroyed.
class Device {
 public:
    /// With the context current. Throws GlError if a function is missing or the context is older than
    /// OpenGL 4.5.
    explicit Device(const GetProc& get_proc);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() = default;

    [[nodiscard]] const Functions& gl() const { return functions_; }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    [[nodiscard]] const std::string& renderer() const { return renderer_; }  ///< as GL_RENDERER
    [[nodiscard]] const std::string& version() const { return version_; }    ///< as GL_VERSION
    [[nodiscard]] bool is_software() const;                                  ///< whether no GPU draws
    [[nodiscard]] bool has_extension(std::string_view name) const;

    /// What the driver said since the last call, oldest first: see DebugLog::take.
    [[nodiscard]] std::vector<DebugMessage> take_messages() { return log_.take(); }

    /// Objects alive now that were made for this device.
    [[nodiscard]] const ObjectCounts& live() const { return live_; }

 private:
    friend class Object;

    Functions functions_;
    std::string renderer_;
    std::string version_;
    std::vector<std::string> extensions_;  ///< sorted
    Limits limits_;
    ObjectCounts live_;
    DebugLog log_;
};

}  // namespace candela::gl
