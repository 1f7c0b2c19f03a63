// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <thread>

#include "lab/reference.hpp"
#include "lab/rivals.hpp"
#include "lab/truth.hpp"
#include "lab_paper.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"

namespace cli {

namespace {

using namespace resect;
namespace fs = std::filesystem;

constexpr double most_off = 1e-3; // of a stored opening, relative: it has seven digits behind the point

std::string name_processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) { return line.substr(line.find(':') + 2); }
    }
    return "a processor without a name";
}

/// The folder that PNG strips of the stills go to, by `resect picture`; a line where that fails.
void draw_strips(const std::string& folder, const lab::Report& report) {
    for (const lab::Section& section : report.sections) {
        for (const auto& part : section.parts) {
            const auto* strip = std::get_if<lab::Strip>(&part);
            if (strip == nullptr) { continue; }
            PictureOptions picture;
            for (const lab::Still& still : strip->stills) {
                picture.surfaces.push_back(folder + "/" + strip->name + "/" + still.caption + ".vtp");
            }
            picture.out = folder + "/" + strip->name + ".png";
            const auto& [eye, target, field] = strip->camera;
            picture.rest = {"--camera",
                            fmt::format("{},{},{},{},{},{},{}", eye[0], eye[1], eye[2], target[0], target[1],
                                        target[2], field),
                            "--size", fmt::format("{}x480", 420 * strip->stills.size())};
            if (cli::picture(picture) != done) {
                fmt::print("{} is not drawn; the report draws it in the reader's browser\n", picture.out);
                return;
            }
        }
    }
}

} // namespace

int lab(const LabOptions& options) {
    const std::string scenes = (fs::path(RESECT_WEB_FOLDER) / "../scenes").lexically_normal().string();
    const std::string page = (fs::path(RESECT_WEB_FOLDER) / "dist/report.html").string();
    if (!fs::exists(page)) { return refuse(fmt::format("lab: {} is missing; ./run builds it", page)); }
    if (const Result<void> made = make_folder(options.out); !made) { return refuse(made.error().message); }
    const std::pair<const char*, std::function<Result<lab::Section>()>> parts[] = {
        {"scene 1: the cuboid", [&] { return reproduce_cuboid(scenes, options.quick); }},
        {"scene 2: what a cut costs",
         [&]() -> Result<lab::Section> { return reproduce_cutting_cost(options.quick); }},
        {"scene 3: the liver", [&] { return reproduce_liver(scenes, options.quick); }},
        {"the rivals", [&]() -> Result<lab::Section> { return lab::compare_rivals(options.quick); }},
        {"the cut state", [&]() -> Result<lab::Section> { return lab::judge_cut_state(options.quick); }},
        {"paper to code", [&]() -> Result<lab::Section> { return list_paper_to_code(); }}};
    lab::Report report{.title = "A real-time cutting method, reproduced beside its rivals",
                       .machine =
                           fmt::format("resect lab {} on {}, {} threads, {}; {}", version, name_processor(),
                                       std::thread::hardware_concurrency(), instruction_set(),
                                       options.quick ? "quick: coarse bodies, for a look" : "whole")};
    Progress progress;
    for (const auto& [name, make] : parts) {
        progress.show(fmt::format("lab: {}", name));
        Result<lab::Section> section = make();
        if (!section) { return refuse(fmt::format("lab: {}: {}", name, section.error().message)); }
        report.sections.push_back(std::move(*section));
    }
    progress.clear();
    const Result<void> written = lab::write_report(options.out, report, page);
    if (!written) { return refuse(written.error().message); }
    if (!options.quick) { draw_strips(options.out, report); }
    fmt::print("{}/index.html holds the report, the files beside it its figures\n", options.out);
    return done;
}

int check_references(const LabOptions& options) {
    if (const Result<void> made = make_folder(options.out); !made) { return refuse(made.error().message); }
    int off = 0;
    for (const lab::StoredReference& one : lab::list_references()) {
        const std::optional<double> opening =
            lab::find_reference_opening(one.problem, one.quadratic, options.out + "/calculix");
        if (!opening) { return refuse("lab: CalculiX (ccx) did not run: install calculix-ccx"); }
        const double difference = std::abs(*opening / one.stored - 1);
        off += difference < most_off ? 0 : 1;
        fmt::print("{:32} {:.7f} m, stored {:.7f}\n", one.name, *opening, one.stored);
        std::fflush(stdout);
    }
    return off == 0 ? done : refuse(fmt::format("lab: {} stored openings are off", off));
}

} // namespace cli
