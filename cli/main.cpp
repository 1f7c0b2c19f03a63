// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "resect/version.hpp"

int main() { std::printf("resect %s\n", resect::version); }
