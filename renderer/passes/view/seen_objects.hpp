#pragma once

#include <cstddef>
#include <cstdint>
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
    /// `other_objects`: the objects have other numbers than in the last call. `count`: how many there are.
    /// Returns the numbers of those that have come into view or left it since then, ascending; objects that
    /// were not there were not seen.
    std::vector<std::uint32_t> update(const KeptTop& top, std::size_t count, const glm::mat4& clip_from_world,
                                      bool other_objects);

    [[nodiscard]] bool sees(std::uint32_t object) const { return seen_[object]; }

 private:
    void visit(const TopBvh& top, std::uint32_t node, InView above, const glm::mat4& clip_from_world);

    std::vector<InView> states_;          // by node of the top
    std::vector<std::uint32_t> leaves_;   // by object: how many of its leaves are seen
    std::vector<bool> seen_;              // by object
    std::vector<std::uint32_t> touched_;  // objects with leaves that have come or gone
    std::uint64_t topology_ = 0;          // KeptTop::topology in the last call
};

}  // namespace candela
