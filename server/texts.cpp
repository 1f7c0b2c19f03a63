// SPDX-License-Identifier: Apache-2.0
#include "texts.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace server {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_pieces = 16;

/// Names of files and words that pages sent may be no UTF-8.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_of(const Piece& piece) {
    return {{"id", piece.id}, {"volume", piece.volume}, {"mass", piece.mass}, {"held", piece.held}};
}

Json largest_pieces(std::span<const Piece> pieces) {
    std::vector<Piece> sorted(pieces.begin(), pieces.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Piece& a, const Piece& b) { return a.volume > b.volume; });
    sorted.resize(std::min(sorted.size(), most_pieces));
    Json list = Json::array();
    for (const Piece& piece : sorted) {
        list.push_back(json_of(piece));
    }
    return list;
}

Json list_materials(std::span<const Material> materials) {
    Json list = Json::array();
    for (const Material& material : materials) {
        list.push_back(
            {{"young", material.young}, {"poisson", material.poisson}, {"density", material.density}});
    }
    return list;
}

const char* state_of(const Figures& figures) {
    if (figures.diverged) { return "diverged"; }
    return figures.paused ? "paused" : "running";
}

} // namespace

std::string hello_text(bool driving, std::span<const SceneEntry> scenes) {
    Json list = Json::array();
    for (const SceneEntry& scene : scenes) {
        list.push_back({{"name", scene.name}, {"title", scene.title}, {"description", scene.description}});
    }
    return text_of(
        {{"hello", {{"protocol", 1}, {"version", version}, {"driving", driving}, {"scenes", list}}}});
}

std::string driving_text(bool driving, std::size_t clients) {
    return text_of({{"driving", {{"driving", driving}, {"clients", clients}}}});
}

std::string loading_text(const std::string& title) { return text_of({{"loading", {{"title", title}}}}); }

std::string scene_text(const SceneFacts& facts) {
    return text_of({{"scene",
                     {{"number", facts.number},
                      {"name", facts.name},
                      {"title", facts.title},
                      {"elements", facts.elements},
                      {"materials", list_materials(facts.materials)},
                      {"gravity", facts.gravity},
                      {"lo", facts.bounds.lo},
                      {"hi", facts.bounds.hi},
                      {"speed", facts.speed},
                      {"notes", facts.notes}}}});
}

std::string status_text(Simulation& simulation, const Figures& figures) {
    const Energies energies = simulation.energies();
    const TimeStep step = simulation.time_step();
    const Strain strain = simulation.strain();
    const std::span<const Piece> pieces = simulation.pieces();
    return text_of(
        {{"status",
          {{"time", simulation.time()},
           {"step", simulation.steps()},
           {"paused", figures.paused},
           {"state", state_of(figures)},
           {"reason", figures.reason},
           {"speed", figures.speed},
           {"pace", figures.pace},
           {"real_time_factor", figures.real_time_factor},
           {"step_rate", figures.step_rate},
           {"tick_ms", figures.tick_ms},
           {"cut_us", figures.cut_us},
           {"surface_us", figures.surface_us},
           {"nodes", simulation.nodes().rest.size()},
           {"elements", simulation.copies().node.size()},
           {"cut_elements", figures.cut_elements},
           {"pieces", largest_pieces(pieces)},
           {"piece_count", pieces.size()},
           {"energies",
            {{"kinetic", energies.kinetic},
             {"elastic", energies.elastic},
             {"gravity", energies.gravity},
             {"damped", energies.damped}}},
           {"time_step", {{"used", step.used}, {"bound", step.bound}, {"live_bound", step.live_bound}}},
           {"strain",
            {{"stretch_min", strain.stretch_min},
             {"stretch_max", strain.stretch_max},
             {"inverted", strain.elements_inverted}}},
           {"strokes", simulation.undoable_strokes()},
           {"materials", list_materials(simulation.materials())},
           {"gravity", simulation.gravity()},
           {"warnings", simulation.warnings()},
           {"clients", figures.clients}}}});
}

std::string refused_text(Index id, const std::string& message) {
    return text_of({{"refused", {{"id", id}, {"message", message}}}});
}

std::string notice_text(const std::string& message) { return text_of({{"notice", {{"message", message}}}}); }

std::string hash_text(Index id, const Simulation& simulation) {
    return text_of(
        {{"hash",
          {{"id", id}, {"hash", fmt::format("{:016x}", simulation.hash())}, {"step", simulation.steps()}}}});
}

std::string saved_text(Index id, const std::string& path, const std::string& file) {
    return text_of({{"saved", {{"id", id}, {"path", path}, {"file", file}}}});
}

} // namespace server
