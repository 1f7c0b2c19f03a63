// SPDX-License-Identifier: Apache-2.0
// The gallery of docs/cutting.md: seven cuts in a block and in a liver, under tension so that the lips open.
// gallery FOLDER [BODY_CUT ...] writes FOLDER/BODY_CUT.vtp; scripts/gallery draws them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "resect/resect.hpp"

using namespace resect;

namespace {

/// Where a body is cut: lengths along the skin and out of it, m.
struct Site {
    Vec3 origin = {}, along = {}, across = {}, out = {};
    double deepened = 1; // factor on depths, for coarser elements

    Vec3 at(double s, double t, double height) const {
        height *= deepened;
        Vec3 p = origin;
        for (size_t k = 0; k < 3; ++k) {
            p[k] += s * along[k] + t * across[k] + height * out[k];
        }
        return p;
    }
};

/// A blade's way over a site, from 0 to 1.
using Path = std::function<Edge(const Site&, double)>;

struct Cut {
    const char* name = "";
    std::vector<Path> strokes = {};
    bool takes_out = false; // what has come free
    double seconds = 1;     // a stroke
};

/// An upright blade whose tip dips in, follows (s, t) at a depth, and comes out again.
template <class Way>
Path upright(double depth, Way way) {
    return [=](const Site& site, double u) {
        const auto [s, t] = way(u);
        const double dip = std::min(1.0, std::min(u, 1 - u) / 0.12);
        const double tip = 0.006 - (depth + 0.006) * std::sin(0.5 * std::numbers::pi * dip);
        return Edge{site.at(s, t, 0.06), site.at(s, t, tip)};
    };
}

struct Point {
    double s = 0, t = 0;
};

Path straight(double depth, Point a, Point b) {
    return upright(depth, [=](double u) { return Point{a.s + u * (b.s - a.s), a.t + u * (b.t - a.t)}; });
}

/// A long blade that lies along the skin, goes down askew to a depth, turns, and comes up on the other side.
Path wedge(double half_width, double depth) {
    return [=](const Site& site, double u) {
        const double way = 2.5 * (2 * u - 1); // 1 at the skin
        const double round = 0.2;
        const double height = depth * (std::hypot(way, round) - std::hypot(1, round));
        const double s = half_width * site.deepened * way;
        return Edge{site.at(s, -0.12, height), site.at(s, 0.12, height)};
    };
}

Point wave(double u) { return {0.012 * std::sin(2 * std::numbers::pi * u), -0.032 + 0.064 * u}; }

Point spiral(double u) {
    const double angle = 3.5 * std::numbers::pi * u;
    const double radius = 0.007 + 0.025 * u;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

const std::vector<Cut>& cuts() {
    static const std::vector<Cut> all = {
        {"straight", {straight(0.020, {0, -0.027}, {0, 0.027})}},
        {"curved", {upright(0.018, wave)}},
        {"crossing",
         {straight(0.018, {-0.024, -0.024}, {0.024, 0.024}),
          straight(0.018, {0.024, -0.024}, {-0.024, 0.024})}},
        {"spiral", {upright(0.014, spiral)}},
        {"shallow", {straight(0.008, {0, -0.028}, {0, 0.028})}},
        {"t",
         {straight(0.018, {-0.028, 0.010}, {0.010, -0.028}),
          straight(0.018, {0.024, 0.024}, {-0.010, -0.010})}},
        {"wedge", {wedge(0.010, 0.016)}, true, 0.05},
    };
    return all;
} // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): what a static holds is no leak

// On the skin as it is under tension.
constexpr Site on_block = {{0.05, 0.05, 0.036}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr Site on_liver = {{0.015, -0.002, 0.033}, {0.74, 0, -0.67}, {0, 1, 0}, {0.67, 0, 0.74}, 2.2};

/// Draws the free nodes of a choice (by their place at rest) away from the middle of a site, by a strain
/// along its skin and one across it, over half a second.
void stretch(Simulation& sim, const Site& site, const std::function<bool(Vec3f)>& is_drawn, double along,
             double across) {
    Prescribe order;
    std::vector<Vec3> from, way;
    const Nodes now = sim.nodes();
    for (size_t i = 0; i < now.rest.size(); ++i) {
        const Vec3f x = now.rest[i], u = now.displacement[i];
        if (now.fixed[i] != 0 || !is_drawn(x)) { continue; }
        double s = 0, t = 0;
        for (size_t k = 0; k < 3; ++k) {
            s += along * site.along[k] * (double(x[k]) - site.origin[k]);
            t += across * site.across[k] * (double(x[k]) - site.origin[k]);
        }
        order.nodes.push_back(now.reference[i]);
        from.push_back({double(u[0]), double(u[1]), double(u[2])});
        way.push_back({s * site.along[0] + t * site.across[0], s * site.along[1] + t * site.across[1],
                       s * site.along[2] + t * site.across[2]});
    }
    const int parts = 50;
    for (int part = 1; part <= parts; ++part) {
        order.displacement = from;
        for (size_t i = 0; i < from.size(); ++i) {
            for (size_t k = 0; k < 3; ++k) {
                order.displacement[i][k] += way[i][k] * part / parts;
            }
        }
        must(sim.apply(order));
        sim.advance(0.01);
    }
}

/// A block, held at its sides and drawn both ways; or one way only, by two sides.
Simulation make_taut_block(bool both_ways) {
    Simulation sim = must(Simulation::create(
        {.body = must(make_block({0.1, 0.1, 0.04}, {20, 20, 8})), .gravity = {}, .damping = 20}));
    const auto is_end = [](float x) { return x < 0.0001F || x > 0.0999F; };
    const auto is_side = [&](Vec3f x) { return is_end(x[0]) || (both_ways && is_end(x[1])); };
    stretch(sim, on_block, is_side, 0.18, both_ways ? 0.18 : 0);
    return sim;
}

/// The liver of scenes/liver_incision.json, at rest under its weight; its flanks are drawn apart, or left
/// alone.
Simulation make_hanging_liver(bool both_ways) {
    Simulation sim = must(Simulation::create({.body = must(make_liver({.elements = 6097})),
                                              .fixed = {{.box = {.lo = {-1, -1, -1}, .hi = {-0.04, 1, 1}}}},
                                              .damping = 4}));
    sim.settle();
    if (both_ways) {
        const auto is_flank = [](Vec3f x) { return x[0] > -0.04F && std::abs(x[1]) > 0.04F; };
        stretch(sim, on_liver, is_flank, 0.15, 0.15);
    }
    return sim;
}

/// The surface; without what has come free if that is taken out.
void write(const std::string& path, Simulation& sim, bool takes_out) {
    const auto is_smaller = [](const Piece& a, const Piece& b) { return a.volume < b.volume; };
    const std::span<const Piece> pieces = sim.pieces();
    const Index body = std::max_element(pieces.begin(), pieces.end(), is_smaller)->id;
    const Surface all = sim.surface();
    std::vector<std::array<Index, 3>> triangle;
    std::vector<Index> face, piece;
    for (size_t i = 0; i < all.triangle.size(); ++i) {
        if (takes_out && all.piece[i] != body) { continue; }
        triangle.push_back(all.triangle[i]);
        face.push_back(all.face[i]);
        piece.push_back(all.piece[i]);
    }
    Surface kept = all;
    kept.triangle = triangle;
    kept.face = face;
    kept.piece = piece;
    must(write_surface(path, kept));
}

/// Sweeps the strokes of a cut while the tissue moves, and lets the lips come to rest. False: not all went
/// well.
bool make(const Cut& cut, const Site& site, Simulation& sim) {
    const int poses = 120;
    bool well = true;
    for (const Path& stroke : cut.strokes) {
        double area = 0;
        for (int i = 0; i <= poses; ++i) {
            must(sim.apply(MoveBlade{.to = stroke(site, double(i) / poses)}));
            const StepReport report = sim.advance(cut.seconds / poses);
            area += report.cut.area;
            well = well && report.status == Status::ok && report.cut.refused == 0;
        }
        must(sim.apply(LiftBlade{}));
        well = well && area > 0;
    }
    return sim.advance(1).status == Status::ok && well;
}

/// A body under tension, and what is cut there.
struct Bench {
    std::string name = "";
    Site site = {};
    std::function<Simulation(bool)> body = {};
};

} // namespace

int main(int count, char** words) {
    const std::string folder = count > 1 ? words[1] : ".";
    const std::vector<std::string> wanted(words + std::min(count, 2), words + count);
    const Bench benches[] = {{"block_", on_block, make_taut_block}, {"liver_", on_liver, make_hanging_liver}};
    bool all_well = true;
    for (const Bench& bench : benches) {
        for (const Cut& cut : cuts()) {
            const std::string name = bench.name + cut.name;
            if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
                continue;
            }
            Simulation sim = bench.body(!cut.takes_out);
            const bool well = make(cut, bench.site, sim);
            all_well = all_well && well;
            std::printf("%s: %zu pieces%s\n", name.c_str(), sim.pieces().size(),
                        well ? "" : ", not cut well");
            std::string path = folder;
            write(path.append("/").append(name).append(".vtp"), sim, cut.takes_out);
        }
    }
    return all_well ? 0 : 1;
}
