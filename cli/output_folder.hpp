// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "resect/resect.hpp"

namespace cli {

/// Makes a folder where there is none.
resect::Result<void> make_folder(const std::string& folder);

/// The files of `resect run --out`: ParaView series of S and of the surface, and the last surface on its own.
class OutputFolder {
public:
    static resect::Result<OutputFolder> make(const std::string& folder);

    resect::Result<void> add_frame(double time, resect::Simulation& simulation);
    resect::Result<void> finish(resect::Simulation& simulation);
    std::string path(const std::string& file) const;

private:
    explicit OutputFolder(std::string folder) : folder_(std::move(folder)) {}

    std::string folder_ = {};
    std::vector<resect::SeriesEntry> simulations_ = {}, surfaces_ = {};
};

} // namespace cli
