// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <doctest/doctest.h>
#include <numeric>

#include "body.hpp"

using namespace resect;

namespace {

/// The bytes of one lane of a block.
std::vector<float> lane_of(const Elements& elements, Index copy) {
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    std::vector<float> whole(sizeof(ElementBlock) / sizeof(float));
    std::memcpy(whole.data(), &block, sizeof(ElementBlock));
    std::vector<float> lane;
    for (std::size_t i = row(copy % lanes); i < whole.size(); i += row(lanes)) {
        lane.push_back(whole[i]);
    }
    return lane;
}

} // namespace

TEST_CASE("shape derivatives of a block are those of linear functions and volumes sum to its volume") {
    const TestBody body = make_test_body(kuhn_block({0.2, 0.3, 0.4}, {2, 3, 4}), Material{});
    double volume = 0;
    double error = 0;
    for (std::size_t e = 0; e < body.rest.size(); ++e) {
        volume += body.rest[e].volume;
        const Tet& tet = body.mesh.tets[e];
        for (std::size_t k = 0; k < 12; ++k) { // grad N_i along the edge from corner 0 to corner j
            const std::size_t i = k / 3;
            const std::size_t j = k % 3 + 1;
            const Vec3 edge = body.mesh.nodes[row(tet[j])] - body.mesh.nodes[row(tet[0])];
            const double expected = (i == j ? 1 : 0) - (i == 0 ? 1 : 0);
            error = std::max(error, std::abs(dot(body.rest[e].gradient[i], edge) - expected));
        }
    }
    CHECK(error < 1e-12);
    CHECK(volume == doctest::Approx(0.024).epsilon(1e-12));
}

TEST_CASE("the rest bound of a regular tet is its closed form") {
    // Four altitudes of edge * sqrt(2/3): 1 / sqrt(sum 1 / h^2) = h / 2.
    const double edge = 0.01;
    TetMesh mesh;
    const double half = edge / std::sqrt(8.0);
    mesh.nodes = {{half, half, half}, {half, -half, -half}, {-half, half, -half}, {-half, -half, half}};
    mesh.tets = {{0, 1, 3, 2}};
    if (signed_volume(mesh, mesh.tets[0]) < 0) { std::swap(mesh.tets[0][2], mesh.tets[0][3]); }
    const Material material;
    const double lambda =
        material.young * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
    const double mu = material.young / (2 * (1 + material.poisson));
    const double speed = std::sqrt((lambda + 2 * mu) / material.density);
    CHECK(rest_step_bound(build_rest(mesh)[0], material) ==
          doctest::Approx(edge * std::sqrt(2.0 / 3) / 2 / speed).epsilon(1e-12));
}

TEST_CASE("a copy of a copy is bit for bit its parent") {
    TestBody body = make_test_body(kuhn_block({0.1, 0.1, 0.1}, {2, 2, 2}), Material{}, 1e-4);
    for (const Index parent : {0, 17, 47}) {
        append_copy_of(body.elements, parent);
        CHECK(lane_of(body.elements, body.elements.count - 1) == lane_of(body.elements, parent));
    }
    CHECK(body.elements.blocks.size() == 4);
}

TEST_CASE("a weight scales the volume and nothing else") {
    TestBody body = make_test_body(kuhn_block({0.1, 0.1, 0.1}, {1, 1, 1}), Material{});
    const std::vector<float> before = lane_of(body.elements, 3);
    set_weight(body.elements, 3, 0.25, body.rest[3].volume);
    std::vector<float> after = lane_of(body.elements, 3);
    Index changed = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        changed += before[i] != after[i] ? 1 : 0;
    }
    CHECK(changed == 1);
    CHECK(body.elements.blocks[0].volume[3] == float(0.25 * body.rest[3].volume));
}
