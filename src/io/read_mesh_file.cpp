// SPDX-License-Identifier: Apache-2.0
#include "io/read_mesh_file.hpp"

#include "io/file.hpp"
#include "io/read_msh.hpp"
#include "io/read_vtk.hpp"
#include "io/read_vtu.hpp"
#include "io/refuse.hpp"

namespace resect {

Result<Body> read_mesh_file(const std::string& path) {
    const std::string ending = ending_of(path);
    const auto reader = ending == ".msh"   ? read_msh
                        : ending == ".vtk" ? read_vtk
                        : ending == ".vtu" ? read_vtu
                                           : nullptr;
    if (reader == nullptr) {
        return Error{path + ": tet meshes are read from .msh, .vtk and .vtu; convert it (meshio convert)"};
    }
    return read_or_refuse([&] { return reader(read_file(path), path); });
}

} // namespace resect
