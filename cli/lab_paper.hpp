// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report.hpp"

// The paper's own results (its section IV), each as a section of the lab's report. `scenes` is the folder of
// our scenes.
namespace cli {

resect::Result<lab::Section> reproduce_cuboid(const std::string& scenes, bool quick);
lab::Section reproduce_cutting_cost(bool quick);
resect::Result<lab::Section> reproduce_liver(const std::string& scenes, bool quick);
/// Equations, steps and figures of the paper, and what in this program stands for each.
lab::Section list_paper_to_code();

} // namespace cli
