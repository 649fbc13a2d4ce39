#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace candela {

/// An array of values whose copies share what they have in common. It consists of blocks of values, and these
/// of groups of blocks; each is copied when it is changed while another array has it, too. So copying,
/// comparing with a copy and finding what differs from it take time in proportion to the number of groups and
/// to what differs, not to the size. An array and its copies belong to one thread.
template <class T>
class SharedArray {
 public:
    static constexpr std::size_t block_size = 64;
    static constexpr std::size_t group_size = 64 * block_size;  // in values

    SharedArray() = default;
    SharedArray(std::initializer_list<T> values) {
        for (const T& value : values) push_back(value);
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const T& operator[](std::size_t i) const {
        return (*(*groups_[i / group_size])[i % group_size / block_size])[i % block_size];
    }

    void set(std::size_t i, T value) {
        Block& block = own(own(groups_[i / group_size])[i % group_size / block_size]);
        block[i % block_size] = std::move(value);
    }

    /// New elements are values made by default.
    void resize(std::size_t size) {
        for (std::size_t i = size; i < size_; ++i) set(i, T{});  // what they own is not kept
        groups_.resize((size + group_size - 1) / group_size);
        for (std::size_t i = size_; i < size; ++i) set(i, T{});
        size_ = size;
    }

    void push_back(T value) {
        if (size_ % group_size == 0) groups_.emplace_back();
        set(size_++, std::move(value));
    }

    [[nodiscard]] bool operator==(const SharedArray& other) const {
        if (size_ != other.size_) return false;
        bool equal = true;
        visit_differences(*this, other, [&](std::size_t) { equal = false; });
        return equal;
    }

    /// Calls `visit(i)` for each i at which `now` has another element than `before` or `before` has none, in
    /// ascending order.
    template <class Visit>
    friend void visit_changes(const SharedArray& before, const SharedArray& now, Visit visit) {
        visit_differences(before, now, visit);
        for (std::size_t i = before.size_; i < now.size_; ++i) visit(i);
    }

    /// Calls `visit(i)` for each i at which both arrays have elements and these differ, in ascending order.
    template <class Visit>
    friend void visit_differences(const SharedArray& a, const SharedArray& b, Visit visit) {
        const std::size_t common = std::min(a.size_, b.size_);
        for (std::size_t first = 0; first < common; first += group_size) {
            const auto& group_a = a.groups_[first / group_size];
            const auto& group_b = b.groups_[first / group_size];
            if (group_a == group_b) continue;
            const std::size_t end = std::min(first + group_size, common);
            for (std::size_t block = first; block < end; block += block_size) {
                const std::size_t i = (block - first) / block_size;
                if ((*group_a)[i] == (*group_b)[i]) continue;
                visit_block(*(*group_a)[i], *(*group_b)[i], block, std::min(block_size, end - block), visit);
            }
        }
    }

 private:
    using Block = std::array<T, block_size>;
    using Group = std::array<std::shared_ptr<Block>, group_size / block_size>;

    template <class Visit>
    static void visit_block(const Block& a, const Block& b, std::size_t first, std::size_t count,
                            Visit& visit) {
        for (std::size_t i = 0; i < count; ++i) {
            if (!(a[i] == b[i])) visit(first + i);
        }
    }

    /// Makes a part that belongs to this array alone.
    template <class Part>
    [[nodiscard]] static Part& own(std::shared_ptr<Part>& part) {
        if (!part) {
            part = std::make_shared<Part>();
        } else if (part.use_count() > 1) {
            part = std::make_shared<Part>(*part);
        }
        return *part;
    }

    std::vector<std::shared_ptr<Group>> groups_;
    std::size_t size_ = 0;
};

}  // namespace candela
