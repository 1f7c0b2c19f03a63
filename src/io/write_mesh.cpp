// SPDX-License-Identifier: Apache-2.0
#include "resect/files.hpp"

#include "io/copies_vtu.hpp"
#include "io/file.hpp"

namespace resect {

Result<void> write_mesh(const std::string& path, const Simulation& simulation) {
    if (ending_of(path) != ".vtu") {
        return Error{path + ": the simulation's mesh is written as .vtu; end the name so"};
    }
    const std::vector<double> von_mises = simulation.von_mises();
    return write_file(path, copies_vtu(simulation.nodes(), simulation.copies(), von_mises));
}

} // namespace resect
