#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <candela/graph/backend.hpp>
#include "engine/graph/details/declaration.hpp"

namespace candela::detail {

/// Positions of a resource's first and last access in the execution order; `first` is none if no kept pass
/// (one that was not culled) uses it.
struct Span {
    std::uint32_t first = none;
    std::uint32_t last = none;
};

/// What compiling adds to a declaration. All versions of all resources are numbered in one sequence: the id
/// of a version is the first id of its resource plus the version number. An object is one storage location: a
/// texture, a buffer or a value.
struct Plan {
    std::vector<std::uint32_t> order;          // kept passes, in execution order
    std::vector<std::uint32_t> first_version;  // per resource: its first version id; then the total number
    std::vector<std::uint32_t> writer;         // per version id: the pass that writes it, or none
    std::vector<Span> lifetime;                // per resource
    std::vector<std::uint32_t> object;         // per resource: its object, or none if it is unused
    std::vector<std::uint32_t> owner;          // per object: a resource that has its kind and description
    std::vector<Barrier> barrier;              // per position: what to issue before the pass

    [[nodiscard]] std::uint32_t version(std::uint32_t resource, std::uint32_t number) const {
        return first_version[resource] + number;
    }
    /// The id of the version on which an access depends: that which it reads or overwrites.
    [[nodiscard]] std::uint32_t needed_version(const Access& access) const {
        return version(access.resource, access.version - (access.write ? 1 : 0));
    }
    /// The resource of a version id.
    [[nodiscard]] std::uint32_t resource(std::uint32_t version_id) const {
        const auto next = std::ranges::upper_bound(first_version, version_id);
        return static_cast<std::uint32_t>(next - first_version.begin()) - 1;
    }
};

/// Whether any of these passes writes incoherently. Without such a pass there are no barriers.
[[nodiscard]] bool any_incoherent(const Declaration& declared, const std::vector<std::uint32_t>& passes);

// The last steps of compiling, once `plan` has its order and versions.

/// Fills in lifetimes and objects. Transients of the same kind and description share an object if their
/// lifetimes do not overlap; every other resource has its own.
void plan_objects(const Declaration& declared, Plan& plan);

/// Fills in the barriers, for a frame that is repeated in full.
///
/// Between an incoherent write and each later access of the same object there must be a barrier with the bit
/// of the later access (OpenGL 4.5, section 7.13.2); likewise between a read and each later incoherent write.
/// A barrier serves all such pairs that it lies between. Barriers are as few as they can be: each comes
/// before the first pass that no earlier one serves, with the bits of all later accesses that it serves.
void plan_barriers(const Declaration& declared, Plan& plan);

}  // namespace candela::detail
