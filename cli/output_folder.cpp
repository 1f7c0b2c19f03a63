// SPDX-License-Identifier: Apache-2.0
#include "output_folder.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace cli {

using namespace resect;

Result<void> make_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder)) {
        return Error{
            fmt::format("'{}': cannot be made a folder ({}); give another --out", folder, error.message())};
    }
    return {};
}

Result<OutputFolder> OutputFolder::make(const std::string& folder) {
    if (const Result<void> made = make_folder(folder); !made) { return made.error(); }
    return OutputFolder(folder);
}

std::string OutputFolder::path(const std::string& file) const {
    return (std::filesystem::path(folder_) / file).string();
}

// The series are written anew with each frame, so that a run that is stopped leaves what it had.
Result<void> OutputFolder::add_frame(double time, Simulation& simulation) {
    const std::string mesh = fmt::format("simulation_{:04}.vtu", simulations_.size());
    const std::string surface = fmt::format("surface_{:04}.vtp", surfaces_.size());
    simulations_.push_back({time, mesh});
    surfaces_.push_back({time, surface});
    Result<void> written = write_mesh(path(mesh), simulation);
    if (written) { written = write_surface(path(surface), simulation.surface()); }
    if (written) { written = write_series(path("simulation.pvd"), simulations_); }
    if (written) { written = write_series(path("surface.pvd"), surfaces_); }
    return written;
}

Result<void> OutputFolder::finish(Simulation& simulation) {
    const Surface surface = simulation.surface();
    Result<void> written = write_surface(path("surface.vtp"), surface);
    if (written) { written = write_surface(path("surface.obj"), surface); }
    if (written) { written = write_rest_surface(path("surface_rest.obj"), surface); }
    return written;
}

} // namespace cli
