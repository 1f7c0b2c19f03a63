// SPDX-License-Identifier: Apache-2.0
#include "live_scene.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace server {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

Box bounds_of(const std::vector<Vec3>& points) {
    Box box = {points.front(), points.front()};
    for (const Vec3& p : points) {
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[k] = std::min(box.lo[k], p[k]);
            box.hi[k] = std::max(box.hi[k], p[k]);
        }
    }
    return box;
}

/// Elements of a lattice stick out of the body; its material does not.
Box bounds_of(const Body& body) {
    if (body.material.tets.empty()) { return bounds_of(body.elements.nodes); }
    std::vector<Vec3> used;
    for (const auto& tet : body.material.tets) {
        for (const Index vertex : tet) {
            used.push_back(body.material.nodes[static_cast<std::size_t>(vertex)]);
        }
    }
    return bounds_of(used);
}

Result<void> write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (file) { return {}; }
    return Error{fmt::format("{}: cannot be written ({})", path, std::strerror(errno))};
}

/// A new one for each upload, since records name the bodies of earlier ones.
Result<std::string> make_upload_folder(const std::string& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    for (int i = 1; !failed; ++i) {
        std::string made = fmt::format("{}/upload_{}", folder, i);
        if (std::filesystem::create_directory(made, failed)) { return made; }
    }
    return Error{fmt::format("{}: no folder can be made there ({})", folder, failed.message())};
}

Result<SceneEntry> read_entry(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const Json scene = Json::parse(text, nullptr, false);
    if (!scene.is_object() || !scene.contains("tissue")) { return Error{"no scene"}; }
    const auto words = [&](const char* key) {
        const auto found = scene.find(key);
        return found != scene.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    SceneEntry entry = {path.stem().string(), words("name"), words("description"), path.string()};
    if (entry.title.empty()) { entry.title = entry.name; }
    return entry;
}

} // namespace

Result<LiveScene> LiveScene::start(const SceneEntry& entry, int threads) {
    Result<Scene> scene = load_scene(entry.path);
    if (!scene) { return scene.error(); }
    scene->setup.threads = threads;
    SceneFacts facts = {.name = entry.name,
                        .title = entry.title,
                        .elements = static_cast<Index>(scene->setup.body.elements.tets.size()),
                        .materials = scene->setup.materials,
                        .gravity = scene->setup.gravity,
                        .bounds = bounds_of(scene->setup.body),
                        .notes = scene->setup.body.notes};
    Result<Simulation> simulation = Simulation::create(std::move(scene->setup));
    if (!simulation) { return Error{fmt::format("{}: {}", entry.path, simulation.error().message)}; }
    LiveScene live(entry, std::move(*simulation));
    live.facts_ = std::move(facts);
    if (scene->settle) {
        const StepReport settled = live.simulation_.settle(scene->settling.residual, scene->settling.at_most);
        if (settled.status == Status::diverged) {
            return Error{fmt::format("{}: {}", entry.path, settled.reason)};
        }
    }
    return live;
}

Result<void> LiveScene::apply(const Command& command) {
    Result<void> applied = simulation_.apply(command);
    if (!applied) { return applied; }
    if (const auto* move = std::get_if<MoveBlade>(&command)) { blades_.insert(move->blade); }
    if (const auto* lift = std::get_if<LiftBlade>(&command)) { blades_.erase(lift->blade); }
    if (const auto* grasp = std::get_if<Grasp>(&command)) { grasps_.insert(grasp->grasp); }
    if (const auto* release = std::get_if<Release>(&command)) { grasps_.erase(release->grasp); }
    return applied;
}

void LiveScene::let_go() {
    // After an undo some are not there any more, which the simulation says, and no harm is done.
    for (const Index blade : blades_) {
        simulation_.apply(LiftBlade{.blade = blade});
    }
    for (const Index grasp : grasps_) {
        simulation_.apply(Release{.grasp = grasp});
    }
    blades_.clear();
    grasps_.clear();
}

Result<void> LiveScene::save(const std::string& path) {
    if (path.ends_with(".json")) { return write_record(path, entry_.path, {}, simulation_); }
    if (path.ends_with(".vtu")) { return write_mesh(path, simulation_); }
    return write_surface(path, simulation_.surface());
}

std::vector<SceneEntry> list_scenes(const std::string& folder) {
    std::vector<SceneEntry> entries;
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
        if (file.path().extension() != ".json") { continue; }
        if (Result<SceneEntry> entry = read_entry(file.path())) { entries.push_back(std::move(*entry)); }
    }
    std::sort(entries.begin(), entries.end(),
              [](const SceneEntry& a, const SceneEntry& b) { return a.name < b.name; });
    return entries;
}

Result<SceneEntry> write_scene_of(const Upload& upload, const std::string& folder) {
    const Result<std::string> mine = make_upload_folder(folder);
    if (!mine) { return mine.error(); }
    const std::string mesh = fmt::format("{}/{}", *mine, upload.name);
    if (Result<void> written = write_bytes(mesh, upload.bytes); !written) { return written.error(); }
    const Result<Body> body = load_body(mesh);
    if (!body) {
        std::error_code ignored;
        std::filesystem::remove_all(*mine, ignored);
        return body.error();
    }
    Box held = bounds_of(body->elements.nodes);
    const double height = held.hi[2] - held.lo[2];
    held.hi[2] = held.lo[2] + 0.1 * height;
    // A load number rho g L / E of 0.1, but no softer than liver.
    constexpr double softest = 5000, weight = 1000 * 9.81;
    const double young = std::max(softest, weight * height / 0.1);
    const Json scene = {{"name", upload.name},
                        {"tissue",
                         {{"mesh", {{"file", upload.name}}},
                          {"materials", Json::array({{{"young", young}}})},
                          {"damping", 2},
                          {"fixed", Json::array({{{"box", {{"lo", held.lo}, {"hi", held.hi}}}}})}}}};
    const std::string path = mesh + ".json";
    if (Result<void> written = write_bytes(path, scene.dump(2)); !written) { return written.error(); }
    return SceneEntry{upload.name, upload.name, {}, path};
}

} // namespace server
