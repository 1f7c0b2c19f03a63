// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/body.hpp"
#include "resect/commands.hpp"
#include "resect/files.hpp"
#include "resect/reports.hpp"
#include "resect/result.hpp"
#include "resect/setup.hpp"
#include "resect/simulation.hpp"
#include "resect/version.hpp"
