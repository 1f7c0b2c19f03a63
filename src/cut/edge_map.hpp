// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace resect {

/// Values by undirected edge: open addressing with linear probing; nothing depends on the order of its slots.
/// Changes since open() can be taken back.
template <class Value>
class EdgeMap {
public:
    std::size_t size() const { return size_; }

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

    /// Calls visit(a, b, value), a < b, in no order that means something.
    template <class Visit>
    void each(Visit visit) const {
        for (const Slot& slot : slots_) {
            if (slot.key == empty) { continue; }
            visit(static_cast<Index>(slot.key >> 32U), static_cast<Index>(slot.key & 0xffffffffU),
                  slot.value);
        }
    }

    /// Invalidates pointers.
    void set(Index a, Index b, const Value& value) {
        const std::uint64_t key = key_of(a, b);
        note(key);
        put(key, value);
    }

    void erase(Index a, Index b) {
        const std::uint64_t key = key_of(a, b);
        note(key);
        remove(key);
    }

    void clear() {
        close();
        if (size_ == 0) { return; }
        for (Slot& slot : slots_) {
            slot.key = empty;
        }
        size_ = 0;
    }

    void open() {
        notes_.clear();
        is_open_ = true;
    }
    void close() {
        notes_.clear();
        is_open_ = false;
    }
    void take_back() {
        for (; !notes_.empty(); notes_.pop_back()) {
            const Note& last = notes_.back();
            if (last.was_there) {
                put(last.slot.key, last.slot.value);
            } else {
                remove(last.slot.key);
            }
        }
        close();
    }

    template <class Archive>
    void archive(Archive& archive) {
        archive.rows(slots_);
        archive.value(size_);
    }

private:
    static constexpr std::uint64_t empty = 0; // edge (0, 0), which cannot be
    struct Slot {
        std::uint64_t key = empty;
        Value value = {};
    };
    /// What was there before a change.
    struct Note {
        Slot slot = {};
        bool was_there = false;
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

    void note(std::uint64_t key) {
        if (!is_open_) { return; }
        const Slot* slot = size_ == 0 ? nullptr : &slots_[slot_of(key)];
        const bool was_there = slot != nullptr && slot->key != empty;
        notes_.push_back({{key, was_there ? slot->value : Value{}}, was_there});
    }

    void put(std::uint64_t key, const Value& value) {
        if (2 * (size_ + 1) > slots_.size()) { grow(); }
        Slot& slot = slots_[slot_of(key)];
        if (slot.key == empty) { ++size_; }
        slot = {key, value};
    }

    void remove(std::uint64_t key) {
        if (size_ == 0) { return; }
        std::size_t hole = slot_of(key);
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

    void grow() {
        std::vector<Slot> old =
            std::exchange(slots_, std::vector<Slot>(slots_.empty() ? 64 : 2 * slots_.size()));
        for (const Slot& slot : old) {
            if (slot.key != empty) { slots_[slot_of(slot.key)] = slot; }
        }
    }

    std::vector<Slot> slots_ = {};
    std::size_t size_ = 0;
    std::vector<Note> notes_ = {};
    bool is_open_ = false;
};

} // namespace resect
