// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace resect {

/// Why something was refused: one line that says what is wrong, where, and how to mend it.
struct Error {
    std::string message = {};
};

/// A T, or the Error that took its place.
template <class T>
class Result {
public:
    // NOLINTNEXTLINE(google-explicit-constructor): so that functions can return either.
    Result(T value) : value_(std::move(value)) {}
    // NOLINTNEXTLINE(google-explicit-constructor)
    Result(Error error) : error_(std::move(error)) {}

    explicit operator bool() const { return value_.has_value(); }
    T& operator*() { return *value_; }
    const T& operator*() const { return *value_; }
    T* operator->() { return &*value_; }
    const T* operator->() const { return &*value_; }
    /// Only where there is no value.
    const Error& error() const { return error_; }

private:
    std::optional<T> value_ = {};
    Error error_ = {};
};

/// Done, or the Error that says why not.
template <>
class Result<void> {
public:
    Result() = default;
    // NOLINTNEXTLINE(google-explicit-constructor)
    Result(Error error) : error_(std::move(error)), failed_(true) {}

    explicit operator bool() const { return !failed_; }
    const Error& error() const { return error_; }

private:
    Error error_ = {};
    bool failed_ = false;
};

/// For programs: the value, or the line on stderr and exit status 2.
template <class T>
T must(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().message.c_str());
        std::exit(2);
    }
    if constexpr (!std::is_void_v<T>) { return std::move(*result); }
}

} // namespace resect
