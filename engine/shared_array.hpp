#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace candela {

/// An array of values whose copies share what they have in common. It consists of blocks, and a block is
/// copied when it is changed while another array has it, too. So copying, comparing with a copy and finding
/// what differs from it take time in proportion to the number of blocks and to what differs, not to the size.
/// An array and its copies belong to one thread.
template <class T>
class SharedArray {
 public:
    static constexpr std::size_t block_size = 64;

    SharedArray() = default;
    SharedArray(std::initializer_list<T> values) {
        for (const T& value : values) push_back(value);
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const T& operator[](std::size_t i) const {
        return (*blocks_[i / block_size])[i % block_size];
    }

    void set(std::size_t i, T value) { own(i / block_size)[i % block_size] = std::move(value); }

    /// New elements are values made by default.
    void resize(std::size_t size) {
        const std::size_t before = size_;
        size_ = size;
        blocks_.resize((size + block_size - 1) / block_size);
        for (std::size_t i = before; i < size; ++i) set(i, T{});
    }

    void push_back(T value) {
        if (size_ % block_size == 0) blocks_.emplace_back();
        set(size_++, std::move(value));
    }

    [[nodiscard]] bool operator==(const SharedArray& other) const {
        if (size_ != other.size_) return false;
        bool equal = true;
        visit_differences(*this, other, [&](std::size_t) { equal = false; });
        return equal;
    }

    /// Calls `visit(i)` for each i at which both arrays have elements and these differ, in ascending order.
    template <class Visit>
    friend void visit_differences(const SharedArray& a, const SharedArray& b, Visit visit) {
        const std::size_t common = std::min(a.size_, b.size_);
        for (std::size_t first = 0; first < common; first += block_size) {
            const auto& block_a = a.blocks_[first / block_size];
            const auto& block_b = b.blocks_[first / block_size];
            if (block_a == block_b) continue;
            const std::size_t count = std::min(block_size, common - first);
            for (std::size_t i = 0; i < count; ++i) {
                if (!((*block_a)[i] == (*block_b)[i])) visit(first + i);
            }
        }
    }

 private:
    using Block = std::array<T, block_size>;

    [[nodiscard]] Block& own(std::size_t index) {
        std::shared_ptr<Block>& block = blocks_[index];
        if (!block) {
            block = std::make_shared<Block>();
        } else if (block.use_count() > 1) {
            block = std::make_shared<Block>(*block);
        }
        return *block;
    }

    std::vector<std::shared_ptr<Block>> blocks_;
    std::size_t size_ = 0;
};

}  // namespace candela
