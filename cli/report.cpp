// SPDX-License-Identifier: Apache-2.0
#include "report.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

double tet_volume(const TetMesh& mesh, const std::array<Index, 4>& tet) {
    const auto at = [&](std::size_t corner) { return mesh.nodes[static_cast<std::size_t>(tet[corner])]; };
    const Vec3 o = at(0);
    Vec3 e[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = at(k + 1);
        e[k] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]};
    }
    return ((e[0][1] * e[1][2] - e[0][2] * e[1][1]) * e[2][0] +
            (e[0][2] * e[1][0] - e[0][0] * e[1][2]) * e[2][1] +
            (e[0][0] * e[1][1] - e[0][1] * e[1][0]) * e[2][2]) /
           6;
}

const char* name(Status status) {
    switch (status) {
    case Status::ok:
        return "ok";
    case Status::not_settled:
        return "not_settled";
    case Status::diverged:
        return "diverged";
    case Status::refused:
        return "refused";
    }
    return "";
}

Json spread(const Samples& samples) {
    return {
        {"p50", samples.percentile(0.5)}, {"p99", samples.percentile(0.99)}, {"max", samples.percentile(1)}};
}

Json list_pieces(std::span<const Piece> pieces) {
    Json list = Json::array();
    for (const Piece& piece : pieces) {
        list.push_back({{"id", piece.id},
                        {"volume_m3", piece.volume},
                        {"mass_kg", piece.mass},
                        {"centre", piece.centre},
                        {"held", piece.held}});
    }
    return list;
}

void report_body(Json& json, const InitialFigures& initial, SceneRun& run) {
    Simulation& simulation = run.simulation();
    const RunFigures& figures = run.figures();
    const Nodes nodes = simulation.nodes();
    double mass = 0, volume = 0;
    for (const float m : nodes.mass) {
        mass += static_cast<double>(m);
    }
    const std::span<const Piece> pieces = simulation.pieces();
    for (const Piece& piece : pieces) {
        volume += piece.volume;
    }
    std::vector<int> copies(static_cast<std::size_t>(initial.elements), 0);
    for (const Index element : simulation.copies().element) {
        ++copies[static_cast<std::size_t>(element)];
    }

    json["elements"] = initial.elements;
    json["nodes"] = initial.nodes;
    json["element_copies"] = simulation.copies().node.size();
    json["simulation_nodes"] = nodes.mass.size();
    json["elements_cut"] = figures.cut.elements_cut;
    json["pieces"] = pieces.size();
    json["piece_list"] = list_pieces(pieces);
    json["refused"] = figures.cut.refused;
    if (figures.cut.refused > 0) { json["refused_reason"] = figures.cut.reason; }
    json["fixed_nodes"] = std::count(nodes.fixed.begin(), nodes.fixed.end(), 1);
    json["mass_kg"] = mass;
    json["mass_initial_kg"] = initial.mass;
    json["volume_m3"] = volume;
    json["volume_initial_m3"] = initial.volume;
    json["opening_m"] = find_opening(simulation.surface());
}

void report_steps(Json& json, SceneRun& run) {
    Simulation& simulation = run.simulation();
    const RunFigures& figures = run.figures();
    const TimeStep step = simulation.time_step();
    const Strain strain = simulation.strain();
    json["time_step_s"] = step.used;
    json["time_step_bound_s"] = step.bound;
    json["time_step_live_s"] = step.live_bound;
    json["stretch_min"] = strain.stretch_min;
    json["stretch_max"] = strain.stretch_max;
    json["elements_beyond_range"] = strain.elements_beyond_range;
    json["elements_inverted"] = strain.elements_inverted;
    json["elements_weakened"] = strain.elements_weakened;
    json["steps"] = figures.steps;
    json["simulated_s"] = figures.simulated;
    json["wall_s"] = figures.wall;
    json["real_time_factor"] = real_time_factor(figures);
    json["element_updates_per_s"] = figures.wall > 0 ? figures.element_updates / figures.wall : 0;
    json["frames"] = figures.frame_ms.count();
    json["frame_ms"] = spread(figures.frame_ms);
    json["step_us"] = spread(figures.step_us);
    json["cut_us"] = spread(figures.cut_us);
    json["cut_us"]["per_new_copy"] =
        figures.cut.copies_added > 0 ? figures.cut_us.sum() / figures.cut.copies_added : 0.0;
    const Energies energies = simulation.energies();
    json["energies_J"] = {{"kinetic", energies.kinetic},
                          {"elastic", energies.elastic},
                          {"gravity", energies.gravity},
                          {"damped", energies.damped}};
    json["warnings"] = simulation.warnings();
    json["status"] = name(figures.status);
    if (!figures.reason.empty()) { json["reason"] = figures.reason; }
    json["state_hash"] = fmt::format("{:016x}", simulation.hash());
}

} // namespace

InitialFigures measure_initial(const Body& body, const std::vector<Material>& materials) {
    InitialFigures figures;
    figures.elements = static_cast<Index>(body.elements.tets.size());
    figures.nodes = static_cast<Index>(body.elements.nodes.size());
    const bool filled = body.material.tets.empty();
    const TetMesh& material = filled ? body.elements : body.material;
    for (std::size_t tet = 0; tet < material.tets.size(); ++tet) {
        const std::size_t element = filled ? tet : static_cast<std::size_t>(body.element_of[tet]);
        const std::size_t region = body.region.empty() ? 0 : static_cast<std::size_t>(body.region[element]);
        const double volume = tet_volume(material, material.tets[tet]);
        figures.volume += volume;
        figures.mass += materials[region].density * volume;
    }
    return figures;
}

std::string report_json(const std::string& scene, int threads, const InitialFigures& initial, SceneRun& run) {
    Json json;
    json["resect_version"] = version;
    json["scene"] = scene;
    json["threads"] = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
    json["isa"] = instruction_set();
    report_body(json, initial, run);
    report_steps(json, run);
    return json.dump(2) + "\n";
}

Result<void> write_text(const std::string& path, const std::string& text) {
    if (path == "-") {
        std::fwrite(text.data(), 1, text.size(), stdout);
        return {};
    }
    std::FILE* file = std::fopen(path.c_str(), "wb");
    const bool written = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (file != nullptr && std::fclose(file) == 0 && written) { return {}; }
    return Error{fmt::format("{}: cannot be written; check that its folder exists and has room", path)};
}

} // namespace cli
