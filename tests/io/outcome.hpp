// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <doctest/doctest.h>
#include <string>
#include <utility>

#include "resect/result.hpp"

namespace resect {

/// The value, where the test needs one to go on.
template <class T>
T value_of(Result<T> result) {
    if (result) { return std::move(*result); }
    FAIL(result.error().message);
    return T{};
}

/// The one line of a refusal, where the test needs one to go on.
template <class T>
std::string refusal_of(const Result<T>& result) {
    std::string message;
    if (result) {
        FAIL("not refused");
    } else {
        message = result.error().message;
    }
    CHECK(message.find('\n') == std::string::npos);
    return message;
}

} // namespace resect
