#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/kept_top.hpp"

namespace candela {

/// Where a box is, relative to the view volume.
enum class InView : std::uint8_t {
    outside,  ///< certainly: all its corners lie outside one of the six planes
    partly,   ///< perhaps
    inside    ///< certainly
};

[[nodiscard]] InView in_view(const Box& box, const glm::mat4& clip_from_box);

/// The objects of a hierarchy of which a view may see something, kept from frame to frame. What lies in a box
/// that is as completely outside or inside the view as before is not looked at again.
class SeenObjects {
 public:
    /// `top`: the same in each call. `count`: all objects have smaller numbers. Returns the
    /// numbers of those that have come into view or left it since the last call, ascending; objects that are
    /// no longer in the top are not seen.
    std::vector<std::uint32_t> update(const KeptTop& top, std::size_t count,
                                      const glm::mat4& clip_from_world);

    [[nodiscard]] bool sees(std::uint32_t object) const { return seen_[object]; }

 private:
    void follow(const KeptTop& top);
    void forget(const KeptTop& top, std::uint32_t node);
    /// `above`: of the node that contains this one. `same_view`: all that is known is still so.
    void visit(const Bvh& top, std::uint32_t node, InView above, bool same_view);
    void set_seen(std::uint32_t object, bool is_seen);

    /// By node of the top; nullopt: unknown. What contains an unknown node is unknown, too.
    std::vector<std::optional<InView>> states_;
    std::vector<bool> seen_;              // by object
    std::vector<bool> reported_;          // by object: whether it is seen, by what was returned
    std::vector<std::uint32_t> touched_;  // objects that have come into view or left it, or both
    // Of the last call.
    std::uint64_t revision_ = 0;  // of the top
    glm::mat4 clip_from_world_{0.0F};
};

}  // namespace candela
