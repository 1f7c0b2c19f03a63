// SPDX-License-Identifier: Apache-2.0
#include "strokes.hpp"

namespace resect {
namespace {

TEST_CASE("a plane through a block leaves two pieces of the right volumes") {
    struct Plane {
        Vec3 normal, point, heading;
        double below; // volume on the side that the normal points away from
    };
    const Plane planes[] = {{{1, 0, 0}, {0.5, 0.5, 0.5}, {0, 1, 0}, 0.5},
                            {{1, 0, 0}, {0.53, 0.5, 0.5}, {0, 1, 0}, 0.53},
                            {{1, 1, 0}, {0.5, 0.5, 0.5}, {0, 0, 1}, 0.5},
                            {{1, 1, 1}, {0.5, 0.5, 0.5}, {1, -1, 0}, 0.5},
                            {{0.3, 0.9, 0.2}, {0.5, 0.5, 0.5}, {1, 0, 0}, 0.5}};
    for (const double jitter : {0.0, 0.2}) {
        for (const Plane& plane : planes) {
            const CutterPtr cutter = cutter_of(make_cube(6, jitter, 1));
            const CutReport report =
                stroke(*cutter, plane_poses(plane.normal, plane.point, plane.heading), 60);
            CHECK(find_broken_invariant(*cutter) == "");
            const std::vector<Piece> pieces = pieces_of(*cutter);
            CAPTURE(jitter);
            CAPTURE(plane.normal[1]);
            CAPTURE(plane.point[0]);
            REQUIRE(pieces.size() == 2);
            const double larger = std::max(plane.below, 1 - plane.below);
            const double area = report.area;
            CHECK(std::abs(pieces[0].volume - larger) < 0.05 / 6 * area);
            CHECK(pieces[0].volume + pieces[1].volume == doctest::Approx(1).epsilon(1e-12));
            CHECK(area > 0.8);
            CHECK(mass_of(*cutter) == doctest::Approx(1).epsilon(1e-12));
        }
    }
}

TEST_CASE("a plane through mesh nodes splits faces and adds no copies") {
    const CutterPtr cutter = cutter_of(make_cube(6, 0, 1));
    const CutReport report = stroke(*cutter, plane_poses({1, 0, 0}, {0.5, 0.5, 0.5}, {0, 1, 0}), 60);
    CHECK(report.copies_added == 0);
    CHECK(report.nodes_added == 49);
    CHECK(report.area == doctest::Approx(1).epsilon(1e-12));
    CHECK(pieces_of(*cutter).size() == 2);
}

} // namespace
} // namespace resect
