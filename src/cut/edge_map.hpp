// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace resect {

/// Values by undirected edge: open addressing with linear probing; nothing depends on the order of its slots.
template <class Value>
class EdgeMap {
public:
    std::size_t size() const { return size_; }

    Value* find(Index a, Index b) {
        if (size_ == 0) { return nullptr; }
        Slot& slot = slots_[slot_of(key_of(a, b))];
        return slot.key == empty ? nullptr : &slot.value;
    }

    const Value* find(Index a, Index b) const {
        if (size_ == 0) { return nullptr; }
        const Slot& slot = slots_[slot_of(key_of(a, b))];
        return slot.key == empty ? nullptr : &slot.value;
    }

    /// Of an edge that has a value.
    const Value& at(Index a, Index b) const {
        const Slot& slot = slots_[slot_of(key_of(a, b))];
        RESECT_ASSERT(slot.key != empty);
        return slot.value;
    }

    /// Keeps the value that is there, if any; invalidates pointers.
    void insert(Index a, Index b, const Value& value) {
        if (2 * (size_ + 1) > slots_.size()) { grow(); }
        const std::uint64_t key = key_of(a, b);
        Slot& slot = slots_[slot_of(key)];
        if (slot.key != empty) { return; }
        slot = {key, value};
        ++size_;
    }

    void erase(Index a, Index b) {
        if (size_ == 0) { return; }
        std::size_t hole = slot_of(key_of(a, b));
        if (slots_[hole].key == empty) { return; }
        --size_;
        // Later entries of the run move up where the hole lies between their home and them.
        for (std::size_t at = after(hole); slots_[at].key != empty; at = after(at)) {
            const std::size_t home = home_of(slots_[at].key);
            const bool stays = hole < at ? (hole < home && home <= at) : (hole < home || home <= at);
            if (!stays) {
                slots_[hole] = slots_[at];
                hole = at;
            }
        }
        slots_[hole].key = empty;
    }

    void clear() {
        if (size_ == 0) { return; }
        for (Slot& slot : slots_) {
            slot.key = empty;
        }
        size_ = 0;
    }

private:
    static constexpr std::uint64_t empty = 0; // edge (0, 0), which cannot be
    struct Slot {
        std::uint64_t key = empty;
        Value value = {};
    };

    static std::uint64_t key_of(Index a, Index b) {
        if (a > b) { std::swap(a, b); }
        return (std::uint64_t{row(a)} << 32U) | std::uint64_t{row(b)};
    }

    std::size_t home_of(std::uint64_t key) const {
        key *= 0x9e3779b97f4a7c15U;
        return (key ^ (key >> 32U)) & (slots_.size() - 1);
    }

    std::size_t after(std::size_t at) const { return (at + 1) & (slots_.size() - 1); }

    /// Where the key is, or the free slot where it would go.
    std::size_t slot_of(std::uint64_t key) const {
        std::size_t at = home_of(key);
        while (slots_[at].key != key && slots_[at].key != empty) {
            at = after(at);
        }
        return at;
    }

    void grow() {
        std::vector<Slot> old =
            std::exchange(slots_, std::vector<Slot>(slots_.empty() ? 64 : 2 * slots_.size()));
        for (const Slot& slot : old) {
            if (slot.key != empty) { slots_[slot_of(slot.key)] = slot; }
        }
    }

    std::vector<Slot> slots_ = {};
    std::size_t size_ = 0;
};

} // namespace resect
