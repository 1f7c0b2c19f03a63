// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/reserve.hpp"
#include "cut/marks.hpp"

namespace resect {

/// An array whose changes since open() can be taken back: rows appended since are dropped, rows edited since
/// are put back. The price is a copy of each row that is edited, once.
template <class T>
class Rows {
public:
    Rows() = default;
    /// Copies the rows only: a copy is not open.
    Rows(const Rows& other) : values_(other.values_) {}
    Rows(Rows&&) noexcept = default;
    Rows& operator=(const Rows& other) {
        if (this == &other) { return *this; }
        values_ = other.values_;
        close();
        return *this;
    }
    Rows& operator=(Rows&&) noexcept = default;
    ~Rows() = default;

    const T& operator[](std::size_t at) const { return values_[at]; }
    const T& back() const { return values_.back(); }
    std::size_t size() const { return values_.size(); }
    bool empty() const { return values_.empty(); }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }
    const T* data() const { return values_.data(); }
    std::span<const T> view() const { return values_; }

    T& edit(std::size_t at) {
        if (at < kept_ && noted_.set(static_cast<Index>(at))) { notes_.emplace_back(at, values_[at]); }
        return values_[at];
    }
    void push_back(T value) { values_.push_back(std::move(value)); }
    /// Makes room for `times` the present rows.
    void reserve(std::size_t times) {
        reserve_ahead(values_, times);
        noted_.grow(times * values_.size());
    }
    /// New rows hold `value`.
    void grow(std::size_t rows, const T& value) {
        if (rows > values_.size()) { values_.resize(rows, value); }
    }

    void open() {
        kept_ = values_.size();
        notes_.clear();
        noted_.clear(kept_);
    }
    void close() {
        kept_ = 0;
        notes_.clear();
    }
    void take_back() {
        values_.resize(kept_);
        for (auto& [at, value] : notes_) {
            values_[at] = std::move(value);
        }
        close();
    }

    /// Calls visit(row) for every row that was edited or appended since open().
    template <class Visit>
    void each_changed(Visit visit) const {
        for (const auto& note : notes_) {
            visit(note.first);
        }
        for (std::size_t at = kept_; at < values_.size(); ++at) {
            visit(at);
        }
    }

    template <class Archive>
    void archive(Archive& archive) {
        archive.rows(values_);
    }

    bool operator==(const Rows& other) const { return values_ == other.values_; }

private:
    std::vector<T> values_ = {};
    std::size_t kept_ = 0; // rows at open(); 0: not open
    std::vector<std::pair<std::size_t, T>> notes_ = {};
    Marks noted_ = {};
};

} // namespace resect
