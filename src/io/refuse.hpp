// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "resect/result.hpp"

namespace resect {

/// Thrown by the readers of this folder, and caught before it leaves the folder: a reader meets trouble deep
/// inside a nest of small functions, and all it can do is give up with one line.
struct Refused {
    std::string message = {};
};

[[noreturn]] inline void refuse(std::string message) { throw Refused{std::move(message)}; }

/// The value; or its refusal goes on up, with `where` before it.
template <class T>
T value_or_refuse(Result<T> result, const std::string& where = {}) {
    if (!result) { refuse(where + result.error().message); }
    return std::move(*result);
}

/// What `read` returns, or the line with which it refused.
template <class Read>
auto read_or_refuse(Read read) -> Result<decltype(read())> {
    try {
        return read();
    } catch (const Refused& refused) { return Error{refused.message}; }
}

} // namespace resect
