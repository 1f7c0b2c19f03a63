// SPDX-License-Identifier: Apache-2.0
#include "io/read_mesh_file.hpp"
#include "io/refuse.hpp"
#include "mesh/validate.hpp"

namespace resect {

Result<Body> load_body(const std::string& path) {
    return read_or_refuse([&] {
        Body body = value_or_refuse(read_mesh_file(path));
        const std::vector<std::string> notes = value_or_refuse(mend_and_validate(body.elements), path + ": ");
        body.notes.insert(body.notes.end(), notes.begin(), notes.end());
        return body;
    });
}

} // namespace resect
