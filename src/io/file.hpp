// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "resect/result.hpp"

namespace resect {

/// Throws Refused.
std::string read_file(const std::string& path);

/// Whole or not at all: the bytes go to a temporary name beside `path`, which is then renamed. What is there
/// and no regular file (a device, a pipe) is written directly.
Result<void> write_file(const std::string& path, std::string_view bytes);

/// The ending of a path in lower case, with its dot; empty where there is none.
std::string ending_of(const std::string& path);

/// Resolves a path found in a file: relative ones count from the folder of that file.
std::string beside(const std::string& file, const std::string& path);

} // namespace resect
