// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace resect {

/// Appends values to bytes, as they lie in memory.
class ByteWriter {
public:
    static constexpr bool reads = false;

    template <class T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <class T>
    void rows(const std::vector<T>& rows) {
        static_assert(std::is_trivially_copyable_v<T>);
        value(static_cast<std::uint64_t>(rows.size()));
        bytes_.append(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(T));
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_ = {};
};

/// Takes them off again. What is missing is read as zero, and failed() tells.
class ByteReader {
public:
    static constexpr bool reads = true;

    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    void value(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (bytes_.size() < sizeof(T)) { return fail(); }
        std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof(T));
        bytes_.remove_prefix(sizeof(T));
    }
    template <class T>
    void rows(std::vector<T>& rows) {
        std::uint64_t count = 0;
        value(count);
        if (count > bytes_.size() / sizeof(T)) { return fail(); }
        rows.resize(count);
        std::memcpy(static_cast<void*>(rows.data()), bytes_.data(), count * sizeof(T));
        bytes_.remove_prefix(count * sizeof(T));
    }
    bool is_spent() const { return failed_; }
    /// Something was missing, or is left over.
    bool failed() const { return failed_ || !bytes_.empty(); }

private:
    void fail() {
        failed_ = true;
        bytes_ = {};
    }

    std::string_view bytes_;
    bool failed_ = false;
};

/// A vector of things that have an archive() of their own.
template <class Archive, class T, class Each>
void archive_each(Archive& archive, std::vector<T>& items, Each each) {
    std::uint64_t count = items.size();
    archive.value(count);
    if constexpr (Archive::reads) {
        items.clear();
        for (std::uint64_t i = 0; i < count && !archive.is_spent(); ++i) {
            each(items.emplace_back());
        }
    } else {
        for (T& item : items) {
            each(item);
        }
    }
}

} // namespace resect
