// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "resect/body.hpp"

namespace resect {

/// What was refused, in its own words; empty if it was not.
template <class T>
std::string refusal_of(const Result<T>& result) {
    return result ? std::string{} : result.error().message;
}

/// What was to be made; a refusal ends the tests with its line.
template <class T>
T made(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "what a test needs was refused: %s\n", result.error().message.c_str());
        std::abort();
    }
    return std::move(*result);
}

} // namespace resect
