// SPDX-License-Identifier: Apache-2.0
#include "mesh/liver.hpp"

#include <algorithm>
#include <iterator>

#include "base/vec.hpp"
#include "mesh/implicit.hpp"
#include "mesh/lattice.hpp"

namespace resect {
namespace {

/// Two lobes, melted into one.
double lobes(const Vec3& p) {
    const double right = ellipsoid(p, {-0.050, -0.003, 0}, {0.074, 0.064, 0.080});
    const double left =
        ellipsoid(rotate_y(rotate_z(p - Vec3{0.052, 0.016, 0.026}, 8), 9), {}, {0.090, 0.043, 0.036});
    return smooth_min(right, left, 0.045);
}

/// What stomach, gallbladder and round ligament press in from below. They meet at the hilum, so they are
/// joined before they are taken away: taken one by one, they leave pegs of tissue between them.
double hilum(const Vec3& p) {
    const double stomach = ellipsoid(p, {0.060, -0.046, -0.090}, {0.100, 0.082, 0.102});
    const double gallbladder = capsule(p, {-0.024, 0.070, -0.072}, {-0.006, 0.005, -0.036}, 0.015);
    const double round_ligament = capsule(p, {0.020, 0.080, -0.036}, {0.016, 0.010, -0.022}, 0.0055);
    return smooth_min(smooth_min(stomach, gallbladder, 0.025), round_ligament, 0.025);
}

/// A lattice that gives exactly so many elements, found by find_lattice_body's search with tolerance 0.
struct Preset {
    Index elements = 0;
    LatticePlan plan = {};
};

constexpr Index paper_elements = 6097; // the liver of the paper
constexpr Preset presets[] = {
    {paper_elements, {0.0161702, {0.739, 0.854, 0.192}, 0}},
    {paper_elements, {0.0163679, {0.248, 0.696, 0.402}, 1}},
    {paper_elements, {0.0164360, {0.388, 0.577, 0.338}, 2}},
};

const Preset* find_preset(const Lattice& lattice) {
    const auto fits = [&](const Preset& preset) {
        return preset.elements == lattice.elements && preset.plan.refine == lattice.refine;
    };
    const auto* found = std::find_if(std::begin(presets), std::end(presets), fits);
    return found == std::end(presets) ? nullptr : found;
}

} // namespace

double liver_shape(const Vec3& point) {
    const Vec3 p = {point[0], -point[1], point[2]}; // the pieces are written with y anterior
    const double diaphragm = ellipsoid(p, {-0.015, -0.010, -0.080}, {0.175, 0.120, 0.150});
    const double kidney = ellipsoid(p, {-0.058, -0.082, -0.080}, {0.050, 0.054, 0.070});
    const double heart = ellipsoid(p, {0.045, 0.005, 0.096}, {0.055, 0.050, 0.040});
    const double vena_cava = capsule(p, {0.010, -0.066, -0.120}, {0.010, -0.066, 0.120}, 0.017);
    double d = smooth_max(lobes(p), diaphragm, 0.020);
    d = smooth_max(d, -kidney, 0.015);
    d = smooth_max(d, -heart, 0.025);
    d = smooth_max(d, -vena_cava, 0.009);
    return smooth_max(d, -hilum(p), 0.012);
}

Result<Body> make_liver(Lattice lattice) {
    const Preset* preset = find_preset(lattice);
    if (preset == nullptr || check_lattice(lattice)) { return make_body(liver_shape, liver_bounds, lattice); }
    Body body;
    if (Fault fault = build_lattice_body(liver_shape, liver_bounds, preset->plan, body)) { return *fault; }
    return body;
}

} // namespace resect
