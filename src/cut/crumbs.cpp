// SPDX-License-Identifier: Apache-2.0
#include "cut/stages.hpp"

namespace resect {
namespace {

/// Share of the mean element below which a part torn off is a crumb: crossing sheets shave such off where
/// they snap to different vertices, and pinch them off where a wedge runs out. The largest seen had 0.24; a
/// thin true part of 0.54 kept 0.28.
constexpr double crumb_share = 0.26;

/// Collects the tets that links join to `seed`, and stops once they hold `enough` volume.
bool is_crumb(Cutter& cutter, Index seed, double enough) {
    Scratch& scratch = cutter.scratch;
    scratch.walked.clear(cutter.material.tets.size());
    scratch.walked.set(seed);
    scratch.cluster.assign(1, seed);
    double volume = 0;
    for (std::size_t next = 0; next < scratch.cluster.size(); ++next) {
        const MaterialTet& tet = cutter.material.tet(scratch.cluster[next]);
        volume += tet.volume;
        if (volume >= enough) { return false; }
        for (const Index link : tet.link) {
            if (link >= 0 && scratch.walked.set(tet_of(link))) { scratch.cluster.push_back(tet_of(link)); }
        }
    }
    return true;
}

bool is_torn(const Cutter& cutter, const TetFace& at) {
    return cutter.material.tet(at.tet).link[at.face] < 0;
}

/// Links the crumb that was collected last through its largest face that was torn now and leads out of it.
void glue_crumb(Cutter& cutter, CutReport& report) {
    const Scratch& scratch = cutter.scratch;
    MaterialMesh& material = cutter.material;
    double largest = -1;
    std::size_t best = 0;
    for (std::size_t i = 0; i < scratch.torn.size(); ++i) {
        const TetFace& own = scratch.torn[i];
        if (!is_torn(cutter, own) || !scratch.walked.has(own.tet)) { continue; }
        if (scratch.walked.has(scratch.torn[i ^ 1U].tet)) { continue; }
        const double twice_area = length(face_normal(material, own.tet, own.face));
        if (twice_area <= largest) { continue; }
        largest = twice_area;
        best = i;
    }
    if (largest < 0) { return; }
    const TetFace own = scratch.torn[best];
    const TetFace other = scratch.torn[best ^ 1U];
    const auto join = [&](const TetFace& face, const TetFace& to) {
        MaterialTet& tet = material.edit_tet(face.tet);
        tet.link[face.face] = make_link(to.tet, to.face);
        tet.label[face.face] = 0;
    };
    join(own, other);
    join(other, own);
    report.area -= largest / 2;
}

} // namespace

void glue_crumbs(Cutter& cutter, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    for (const TetFace& at : scratch.torn) {
        if (is_torn(cutter, at) && is_crumb(cutter, at.tet, crumb_share * cutter.mean_volume)) {
            glue_crumb(cutter, report);
        }
    }
    std::erase_if(scratch.torn, [&](const TetFace& at) { return !is_torn(cutter, at); });
}

} // namespace resect
