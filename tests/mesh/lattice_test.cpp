// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "mesh/adjacency.hpp"
#include "mesh/edge_rows.hpp"
#include "mesh/lattice.hpp"
#include "mesh/lattice_checks.hpp"
#include "mesh/made.hpp"
#include "mesh/quality.hpp"
#include "mesh/validate.hpp"

using namespace resect;

namespace {

constexpr Box unit_bounds = {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}};

double unit_ball(Vec3 p) { return length(p) - 1; }

std::string refused(Lattice lattice) { return refusal_of(make_body(unit_ball, unit_bounds, lattice)); }

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("a ball's volume comes closer to the true one with each refinement") {
    double error = 0.1;
    for (int refine = 0; refine <= 3; ++refine) {
        CAPTURE(refine);
        const Body body = made(make_body(unit_ball, unit_bounds, {.spacing = 0.4, .refine = refine}));
        const double volume = measure_body(body).volume;
        const double now = std::abs(volume / (4 * std::numbers::pi / 3) - 1);
        CHECK(now < error);
        error = now / 2;
    }
    CHECK(error < 1e-3);
}

TEST_CASE("a lattice body is consistent at every refinement") {
    for (int refine = 0; refine <= 3; ++refine) {
        CAPTURE(refine);
        const Body body = made(make_body(unit_ball, unit_bounds, {.spacing = 0.43, .refine = refine}));
        check_lattice_body(body);
        CHECK(body.notes.empty());
        TetMesh elements = body.elements;
        CHECK(refusal_of(mend_and_validate(elements)).empty());
        CHECK(elements.tets == body.elements.tets);
    }
}

TEST_CASE("elements that lie inside are whole and the material there is the element") {
    const Body body = made(make_body(unit_ball, unit_bounds, {.spacing = 0.25, .refine = 0}));
    const auto fractions = compute_fractions(body);
    std::size_t inside = 0;
    for (std::size_t element = 0; element < fractions.size(); ++element) {
        const Tet& tet = body.elements.tets[element];
        const auto is_in = [&](Index node) { return unit_ball(body.elements.nodes[row(node)]) < 0; };
        if (!std::all_of(tet.begin(), tet.end(), is_in)) { continue; }
        ++inside;
        CHECK(fractions[element] == doctest::Approx(1).epsilon(1e-12));
        CHECK(std::find(body.material.tets.begin(), body.material.tets.end(), tet) !=
              body.material.tets.end());
    }
    CHECK(inside > 1000);
}

TEST_CASE("the number of elements asked for is met within one in a hundred") {
    for (const Index elements : {100, 500, 1000, 3000, 20000}) {
        CAPTURE(elements);
        const Body body = made(make_body(unit_ball, unit_bounds, {.elements = elements}));
        CHECK(std::abs(static_cast<Index>(body.elements.tets.size()) - elements) * 100 <= elements);
    }
}

TEST_CASE("the fast count is the number of elements built") {
    for (int refine = 0; refine <= 2; ++refine) {
        const LatticePlan plan = {0.21, {0.3, 0.6, 0.9}, refine};
        Index count = 0;
        Body body;
        CHECK(!count_lattice_elements(unit_ball, unit_bounds, plan, count));
        CHECK(!build_lattice_body(unit_ball, unit_bounds, plan, body));
        CHECK(count == static_cast<Index>(body.elements.tets.size()));
    }
}

TEST_CASE("an exact number of elements is found by search with tolerance 0") {
    FoundLattice found;
    REQUIRE(!find_lattice_body(unit_ball, unit_bounds, {1001, 0, 400}, 0, found));
    CHECK(found.body.elements.tets.size() == 1001);
    CHECK(found.body.lattice_spacing == found.plan.spacing);
}

TEST_CASE("a crumb beside a body is dropped with a note, a second piece of a body is not") {
    const auto with_ball = [](double radius) {
        return [=](Vec3 p) { return std::min(length(p) - 0.5, length(p - Vec3{0.9, 0.1, 0.1}) - radius); };
    };
    const Body crumb = made(make_body(with_ball(0.05), unit_bounds, {.spacing = 0.2, .refine = 3}));
    REQUIRE(crumb.notes.size() == 1);
    CHECK(says(crumb.notes[0], "1 loose crumbs"));
    CHECK(measure_body(crumb).components == 1);
    check_lattice_body(crumb);
    const Body two = made(make_body(with_ball(0.2), unit_bounds, {.spacing = 0.2, .refine = 2}));
    CHECK(two.notes.empty());
    CHECK(measure_body(two).components == 2);
}

TEST_CASE("a body smaller than one element is kept, for it is all there is") {
    const auto small = [](Vec3 p) { return length(p) - 0.06; };
    const Body body = made(make_body(small, unit_bounds, {.spacing = 0.3, .refine = 2}));
    CHECK(body.notes.empty());
    CHECK(measure_body(body).components == 1);
}

TEST_CASE("how fine a body is to be is given once and in range") {
    CHECK(says(refused({.elements = -1}), "elements -1"));
    CHECK(says(refused({.elements = 2'000'000'000}), "elements 2000000000"));
    CHECK(says(refused({.spacing = -0.1}), "spacing -0.1"));
    CHECK(says(refused({.spacing = std::nan("")}), "spacing nan"));
    CHECK(says(refused({.spacing = std::numeric_limits<double>::infinity()}), "spacing inf"));
    CHECK(says(refused({}), "exactly one"));
    CHECK(says(refused({.elements = 100, .spacing = 0.1}), "exactly one"));
    CHECK(says(refused({.spacing = 0.5, .refine = -1}), "refine -1"));
    CHECK(says(refused({.spacing = 0.5, .refine = 4}), "refine 4"));
}

TEST_CASE("a lattice too fine to hold is refused before it is laid") {
    CHECK(says(refused({.spacing = 1e-3}), "larger spacing"));
    CHECK(says(refused({.spacing = 1e-300}), "larger spacing"));
}

TEST_CASE("a function or bounds that describe no body are refused") {
    struct Case {
        const char* says;
        Shape shape;
        Box bounds;
    };
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<Case> cases = {
        {"no function", nullptr, unit_bounds},
        {"bounds", unit_ball, {{1, 1, 1}, {1, 2, 2}}},
        {"bounds", unit_ball, {{0, 0, 0}, {1, 1, inf}}},
        {"empty", [](Vec3) { return 1.0; }, unit_bounds},
        {"out of its bounds", [](Vec3) { return -1.0; }, unit_bounds},
        {"out of its bounds", [](Vec3 p) { return p[2]; }, unit_bounds},
        {"not finite", [](Vec3 p) { return std::log(p[0]); }, unit_bounds},
    };
    for (const auto& [expected, shape, bounds] : cases) {
        CHECK(says(refusal_of(make_body(shape, bounds, {.spacing = 0.3, .refine = 1})), expected));
    }
}

TEST_CASE("a search for elements in an empty body ends with what it found") {
    const auto empty = [](Vec3) { return 1.0; };
    CHECK(says(refusal_of(make_body(empty, unit_bounds, {.elements = 100})), "nearest has 0"));
}

TEST_CASE("an edge map finds what was entered from either end, and nothing else") {
    EdgeRows map;
    for (Index a = 0; a < 3000; ++a) {
        map[edge_key(a, a + 7)] = a;
    }
    int wrong = 0;
    for (Index a = 0; a < 3000; ++a) {
        const Index* found = map.find(edge_key(a + 7, a));
        wrong += found != nullptr && *found == a ? 0 : 1;
        wrong += map.find(edge_key(a, a + 8)) == nullptr ? 0 : 1;
    }
    CHECK(wrong == 0);
    CHECK(map[edge_key(1, 2)] == -1);
}
