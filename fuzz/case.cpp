// SPDX-License-Identifier: Apache-2.0
#include "case.hpp"

#include <cmath>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/index.hpp"
#include "base/vec.hpp"

namespace resect::fuzz {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const BodySpec& body) {
    if (body.is_liver) {
        return {{"liver", {{"spacing", body.spacing}, {"offset", body.offset}, {"refine", body.refine}}}};
    }
    return {{"block",
             {{"size", body.size},
              {"cells", body.cells},
              {"jitter", body.jitter},
              {"passes", body.passes},
              {"least_volume", body.least_volume},
              {"seed", body.seed}}}};
}

BodySpec body_from(const Json& json) {
    BodySpec body;
    body.is_liver = json.contains("liver");
    if (body.is_liver) {
        const Json& liver = json.at("liver");
        liver.at("spacing").get_to(body.spacing);
        liver.at("offset").get_to(body.offset);
        liver.at("refine").get_to(body.refine);
        return body;
    }
    const Json& block = json.at("block");
    body.size = block.value("size", body.size);
    block.at("cells").get_to(body.cells);
    body.jitter = block.value("jitter", body.jitter);
    body.passes = block.value("passes", body.passes);
    body.least_volume = block.value("least_volume", body.least_volume);
    body.seed = block.value("seed", body.seed);
    return body;
}

/// A pose as heel and tip in a row.
Json to_json(const Edge& pose) {
    return {pose.heel[0], pose.heel[1], pose.heel[2], pose.tip[0], pose.tip[1], pose.tip[2]};
}

Json to_json(const Stroke& stroke) {
    Json blades = Json::array();
    for (const std::vector<Edge>& poses : stroke.blades) {
        Json way = Json::array();
        for (const Edge& pose : poses) {
            way.push_back(to_json(pose));
        }
        blades.push_back(std::move(way));
    }
    return {{"increments", stroke.increments},
            {"seconds", stroke.seconds},
            {"is_still", stroke.is_still},
            {"blades", std::move(blades)}};
}

Stroke stroke_from(const Json& json) {
    Stroke stroke;
    stroke.increments = json.value("increments", stroke.increments);
    stroke.seconds = json.value("seconds", stroke.seconds);
    stroke.is_still = json.value("is_still", stroke.is_still);
    for (const Json& way : json.at("blades")) {
        std::vector<Edge> poses;
        for (const Json& pose : way) {
            const auto x = pose.get<std::array<double, 6>>();
            poses.push_back({{x[0], x[1], x[2]}, {x[3], x[4], x[5]}});
        }
        stroke.blades.push_back(std::move(poses));
    }
    return stroke;
}

Json to_json(const Case& written) {
    Json json = {{"what", written.what},
                 {"seed", written.seed},
                 {"is_simulated", written.is_simulated},
                 {"body", to_json(written.body)}};
    const auto& [waves, forces, expected] = std::tie(written.waves, written.forces, written.expected);
    json["waves"] = {{"size", waves.size}, {"pace", waves.pace}, {"phase", waves.phase}};
    json["forces"] = {{"young", forces.young},
                      {"damping", forces.damping},
                      {"gravity", forces.gravity},
                      {"kick", forces.kick}};
    json["expected"] = {{"pieces", expected.pieces},
                        {"is_unpinched", expected.is_unpinched},
                        {"is_on_sheet", expected.is_on_sheet}};
    json["strokes"] = Json::array();
    for (const Stroke& stroke : written.strokes) {
        json["strokes"].push_back(to_json(stroke));
    }
    return json;
}

Case case_from(const Json& json) {
    Case read;
    read.what = json.at("what");
    read.seed = json.value("seed", read.seed);
    read.is_simulated = json.at("is_simulated");
    read.body = body_from(json.at("body"));
    const Json waves = json.value("waves", Json::object());
    read.waves.size = waves.value("size", read.waves.size);
    read.waves.pace = waves.value("pace", read.waves.pace);
    read.waves.phase = waves.value("phase", read.waves.phase);
    const Json forces = json.value("forces", Json::object());
    read.forces.young = forces.value("young", read.forces.young);
    read.forces.damping = forces.value("damping", read.forces.damping);
    read.forces.gravity = forces.value("gravity", read.forces.gravity);
    read.forces.kick = forces.value("kick", read.forces.kick);
    const Json expected = json.value("expected", Json::object());
    read.expected.pieces = expected.value("pieces", read.expected.pieces);
    read.expected.is_unpinched = expected.value("is_unpinched", read.expected.is_unpinched);
    read.expected.is_on_sheet = expected.value("is_on_sheet", read.expected.is_on_sheet);
    for (const Json& stroke : json.at("strokes")) {
        read.strokes.push_back(stroke_from(stroke));
    }
    return read;
}

/// Not a file of strokes that can be run: what is wrong with it.
std::string find_problem(const Case& read) {
    for (const Stroke& stroke : read.strokes) {
        if (stroke.blades.empty() || stroke.increments < 1) {
            return "a stroke has no blade or no increment";
        }
        for (const std::vector<Edge>& poses : stroke.blades) {
            if (poses.size() < 2 || poses.size() != stroke.blades.front().size()) {
                return "a blade has under two poses, or not as many as the others of its stroke";
            }
        }
    }
    return {};
}

} // namespace

Vec3 wave(const Waves& waves, const Vec3& rest, double time) {
    const double phase = waves.pace * time;
    return rest + waves.size * Vec3{std::sin(3 * rest[1] + phase + waves.phase),
                                    std::sin(4 * rest[2] + phase),
                                    std::cos(3 * rest[0] - phase + waves.phase)};
}

Index count_increments(const Stroke& stroke) {
    return stroke.increments * static_cast<Index>(stroke.blades.front().size() - 1);
}

Edge pose_after(const Stroke& stroke, std::size_t blade, Index increments) {
    const std::vector<Edge>& poses = stroke.blades[blade];
    const Edge& from = poses[row(increments / stroke.increments)];
    const Index part = increments % stroke.increments;
    if (part == 0) { return from; }
    const Edge& to = poses[row(increments / stroke.increments) + 1];
    const double t = static_cast<double>(part) / stroke.increments;
    return {from.heel + t * (to.heel - from.heel), from.tip + t * (to.tip - from.tip)};
}

void write_case(const std::string& path, const Case& written) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream file(path);
    file << to_json(written).dump() << '\n';
    if (!file.flush()) { throw std::runtime_error(fmt::format("{}: cannot be written", path)); }
}

Result<Case> read_case(const std::string& path) {
    std::ifstream file(path);
    if (!file) { return Error{fmt::format("{}: cannot be read", path)}; }
    try {
        Case read = case_from(Json::parse(file));
        const std::string problem = find_problem(read);
        if (!problem.empty()) { return Error{fmt::format("{}: {}", path, problem)}; }
        return read;
    } catch (const std::exception& error) { return Error{fmt::format("{}: {}", path, error.what())}; }
}

} // namespace resect::fuzz
