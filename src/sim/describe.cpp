// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "fem/elements.hpp"
#include "mesh/quality.hpp"

namespace resect {

MeshInfo describe(const Body& body, const Material& material) {
    MeshInfo info = measure_body(body);
    info.time_step_bound = std::numeric_limits<double>::infinity();
    for (const RestElement& rest : build_rest(body.elements)) {
        info.time_step_bound = std::min(info.time_step_bound, rest_step_bound(rest, material));
    }
    return info;
}

} // namespace resect
