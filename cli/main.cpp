// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>

#include "options.hpp"

namespace cli {

int refuse(const std::string& line) {
    fmt::print(stderr, "resect: {}\n", line);
    return refused;
}

} // namespace cli

namespace {

// CLI11's own message may run over several lines; the contract is one.
std::string one_line(std::string text) {
    for (char& c : text) {
        c = c == '\n' ? ' ' : c;
    }
    return text;
}

void add_isa(CLI::App& command, std::string& isa) {
    command.add_option_function<std::string>(
        "--isa",
        [&isa](const std::string& name) {
            isa = name;
            if (!resect::choose_instruction_set(name)) {
                throw CLI::ValidationError(
                    "--isa", fmt::format("'{}' does not run here; give sse2, avx2 or avx512", name));
            }
        },
        "instruction set of the element kernels: sse2, avx2, avx512; the best without");
}

void add_run(CLI::App& app, cli::RunOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("run", "run a scene");
    command->add_option("scene", options.scene, "scene file (JSON)")->required();
    command->add_option("--seconds", options.seconds, "simulated time instead of the scene's duration")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--out", options.out, "folder for meshes, surfaces and the report");
    command->add_option("--threads", options.threads, "threads; 0: one a core")->check(CLI::Range(0, 256));
    command->add_option("--set", options.overrides, "scene values, as key=value")->take_all();
    command->add_option("--json", options.json, "file for the report, or - for standard output");
    command->add_option("--record", options.record, "file for the record, for resect replay");
    add_isa(*command, options.isa);
    command->callback([&] { status = cli::run(options); });
}

void add_replay(CLI::App& app, cli::ReplayOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("replay", "do again what a record holds");
    command->add_option("record", options.record, "record (JSON), as run --record writes it")->required();
    command->add_flag("--check-hash", options.check_hash,
                      "fail if it ends in another state than was recorded");
    command->add_option("--threads", options.threads, "threads; 0: one a core")->check(CLI::Range(0, 256));
    command->add_option("--surface", options.surface,
                        "file for the surface at the end (.obj .stl .ply .vtp)");
    add_isa(*command, options.isa);
    command->callback([&] { status = cli::replay(options); });
}

void add_serve(CLI::App& app, cli::ServeOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("serve", "the simulator: open its page and cut");
    command
        ->add_option("scene", options.scene, "scene file (JSON); its folder gives the scenes to choose from")
        ->required();
    command->add_option("--port", options.port, "0: any that is free")->check(CLI::Range(0, 65535));
    command->add_option("--address", options.address, "to listen on; 0.0.0.0 lets other machines in");
    command->add_option("--name", options.names, "host name that pages may be opened by, beside localhost");
    command->add_option("--threads", options.threads, "threads; 0: half of the cores")
        ->check(CLI::Range(0, 256));
    command->add_option("--out", options.out, "folder for records, surfaces and uploads");
    command->add_flag("--open", options.open, "open the page, where there is a screen");
    add_isa(*command, options.isa);
    command->callback([&] { status = cli::serve(options); });
}

void add_mesh(CLI::App& app, cli::MeshOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("mesh", "make the mesh of a body");
    command->add_option("body", options.source, "liver, kidney or block")->required();
    command
        ->add_option("-o,--out", options.out, "mesh file (.vtu .vtk .msh), or surface (.obj .stl .ply .vtp)")
        ->required();
    command->add_option("--elements", options.lattice.elements, "number of elements of a lattice body");
    command->add_option("--spacing", options.lattice.spacing, "lattice spacing, m");
    command->add_option("--refine", options.lattice.refine, "levels by which the boundary is finer");
    command->add_option("--size", options.size, "of a block, m")->expected(3);
    command->add_option("--cells", options.cells, "of a block")->expected(3);
    command->add_option("--split", options.split, "of a block's cells")->check(CLI::IsMember({"six", "bcc"}));
    command->callback([&] { status = cli::mesh(options); });
}

void add_info(CLI::App& app, std::string& path, int& status) {
    CLI::App* command = app.add_subcommand("info", "what a mesh file holds, its quality and its stable step");
    command->add_option("file", path, "tet mesh: .msh .vtk .vtu")->required();
    command->callback([&] { status = cli::info(path); });
}

void add_picture(CLI::App& app, cli::PictureOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("picture", "draw surfaces (.vtp, .obj) as one PNG");
    command->add_option("surface", options.surfaces, "several make a strip with one camera")->required();
    command->add_option("-o,--out", options.out, "PNG file")->required();
    for (const char* passed : {"--size", "--camera", "--view", "--blade", "--title"}) {
        command->add_option_function<std::string>(
            passed,
            [&options, passed](const std::string& value) {
                options.rest.insert(options.rest.end(), {passed, value});
            },
            "see docs/manual.md");
    }
    command->callback([&] { status = cli::picture(options); });
}

void add_bench(CLI::App& app, cli::BenchOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("bench", "measure this machine with this program");
    command->add_option("name", options.names,
                        "step, cut; both without a name; realtime, soak, matrix, fuzz (minutes)");
    command->add_option("--threads", options.threads, "threads; of matrix: runs at a time")
        ->check(CLI::Range(0, 256));
    command->add_flag("--large", options.large, "of step: blocks of 400k and 3M, a liver of 100,000");
    command->add_option("--seeds", options.seeds, "runs of each cell of matrix")->check(CLI::Range(1, 1000));
    command->add_option("--minutes", options.minutes, "of fuzz")->check(CLI::Range(0.0, 1e5));
    command->add_option("--seed", options.seed, "of fuzz");
    command->add_option("--out", options.out, "folder for the cases of fuzz that fail");
    command->add_option("--json", options.json, "file for the figures, or - for standard output");
    add_isa(*command, options.isa);
    command->callback([&] { status = cli::bench(options); });
}

void add_lab(CLI::App& app, cli::LabOptions& options, int& status) {
    CLI::App* command = app.add_subcommand("lab", "the paper's results and its rivals, as one report");
    command->add_option("--out", options.out, "folder for index.html, .csv and .vtp files")
        ->capture_default_str();
    command->add_flag("--quick", options.quick, "coarse bodies, in under a minute");
    CLI::App* references = command->add_subcommand(
        "references", "solves the stored openings anew by CalculiX, in some minutes, and compares");
    references->fallthrough()->callback([&] { status = cli::check_references(options); });
    command->callback([&, command] {
        if (command->get_subcommands().empty()) { status = cli::lab(options); }
    });
}

bool has_command(const CLI::App& app, const std::string& name) {
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    return std::any_of(commands.begin(), commands.end(),
                       [&](const CLI::App* command) { return command->get_name() == name; });
}

int run_program(int argc, char** argv) {
    CLI::App app("Resect: real-time cutting of nonlinear soft tissue", "resect");
    app.set_version_flag("--version", fmt::format("resect {}", resect::version));
    app.require_subcommand(1);
    int status = cli::done;
    cli::RunOptions run;
    cli::ReplayOptions replay;
    cli::ServeOptions serve;
    cli::MeshOptions mesh;
    std::string info;
    cli::PictureOptions picture;
    cli::BenchOptions bench;
    add_run(app, run, status);
    add_replay(app, replay, status);
    add_serve(app, serve, status);
    add_mesh(app, mesh, status);
    add_info(app, info, status);
    add_picture(app, picture, status);
    add_bench(app, bench, status);
    cli::LabOptions lab;
    add_lab(app, lab, status);
    if (argc > 1 && argv[1][0] != '-' && !has_command(app, argv[1])) {
        return cli::refuse(fmt::format(
            "'{}' is not a command; give run, serve, replay, mesh, info, picture, bench or lab", argv[1]));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) { return app.exit(asked); } catch (const CLI::ParseError& error) {
        return cli::refuse(one_line(error.what()) + "; see resect --help");
    }
    return status;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        return cli::refuse("out of memory; make the mesh smaller");
    } catch (const std::exception& error) { return cli::refuse(one_line(error.what())); }
}
