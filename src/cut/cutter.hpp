// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "resect/commands.hpp"
#include "resect/reports.hpp"
#include "resect/setup.hpp"

#include "cut/simulation_mesh.hpp"

namespace resect {

struct Cutter; // R, M, S, the blades and the scratch of an increment

/// Material that is held: in a box (already thickened), or carried by marked element nodes.
struct HeldRegion {
    Box box = {};
    std::vector<std::uint8_t> node_marked = {}; // [element node]; empty: the box counts
};

struct CutterSetup {
    std::vector<double> element_mass = {}; // [element] kg, of a full element
    std::vector<HeldRegion> held = {};
    std::vector<Index> node_order = {}; // rows of elements.nodes as S numbers them; empty: as they are
    CutOptions options = {};
};

struct CutterDeleter {
    void operator()(Cutter* cutter) const;
};
using CutterPtr = std::unique_ptr<Cutter, CutterDeleter>;

/// M and S of a body. Refuses a material that does not tile its elements.
Result<CutterPtr> make_cutter(const Body& body, CutterSetup setup);
const SimulationMesh& simulation_mesh(const Cutter& cutter);

/// Places a blade; cuts nothing. Where a stroke ended within an element the blade goes on with it, if
/// `displacement` ([node], m) tells where that is now; else it begins its own.
void place_blade(Cutter& cutter, Index blade, const Edge& pose, std::span<const Vec3f> displacement = {});
void lift_blade(Cutter& cutter, Index blade);
bool has_blade(const Cutter& cutter, Index blade);

/// Sweeps a blade to `to` while the nodes move from `before` to `after` (displacements, [node]), cuts the
/// material that it crosses and derives S anew where that matters. `delta` is overwritten with what changed
/// in S; sums are added to `report` (all but pieces).
void sweep_blade(Cutter& cutter, Index blade, const Edge& to, std::span<const Vec3f> before,
                 std::span<const Vec3f> after, Delta& delta, CutReport& report);

/// Components of M with stable ids, measured: volume at rest, mass by `copy_weight`, centre as displaced,
/// held where nodes are `fixed` [node].
std::span<const Piece> update_pieces(Cutter& cutter, std::span<const Vec3f> displacement,
                                     std::span<const std::uint8_t> fixed);
Index count_pieces(const Cutter& cutter);
std::span<const Index> piece_of_copy(const Cutter& cutter);

/// The boundary of M: topology brought up to date if M changed, positions and normals evaluated.
Surface update_surface(Cutter& cutter, std::span<const Vec3f> displacement, std::uint64_t since_revision);
/// [triangle] Its copy; the topology is brought up to date.
std::vector<Index> copy_of_triangle(Cutter& cutter);

/// M as a body over R.
Body material_body(const Cutter& cutter);

/// The first broken invariant in words (docs/cutting.md, "Checks"), or nothing. O(mesh).
std::string find_broken_invariant(const Cutter& cutter);

std::uint64_t hash_topology(const Cutter& cutter); // of S and M

} // namespace resect
