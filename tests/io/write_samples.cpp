// SPDX-License-Identifier: Apache-2.0
// Writes the samples in every format into a folder, and the arrays that they hold as plain numbers, for
// meshio_round_trip.py to compare.
#include <string>

#include "resect/files.hpp"

#include "io/bytes.hpp"
#include "io/copies_vtu.hpp"
#include "io/file.hpp"
#include "io/samples.hpp"

namespace resect {

namespace {

template <class T>
void write_array(const std::string& path, const std::vector<T>& values) {
    must(write_file(path, bytes_of(std::span<const T>(values))));
}

void write_samples(const std::string& folder) {
    const Body body = sample_body();
    for (const char* ending : {".vtu", ".vtk", ".msh"}) {
        must(write_body(folder + "/body" + ending, body));
    }
    write_array(folder + "/body.nodes", body.elements.nodes);
    write_array(folder + "/body.tets", body.elements.tets);
    write_array(folder + "/body.region", body.region);

    const SampleSurface surface;
    for (const char* ending : {".obj", ".stl", ".ply", ".vtp"}) {
        must(write_surface(folder + "/surface" + ending, surface.view()));
    }
    for (const char* ending : {".obj", ".ply"}) {
        must(write_surface(folder + "/split" + ending, surface.split()));
    }
    must(write_rest_surface(folder + "/surface_rest.obj", surface.view()));
    write_array(folder + "/surface.position", surface.position);
    write_array(folder + "/surface.normal", surface.normal);
    write_array(folder + "/surface.rest", surface.rest);
    write_array(folder + "/surface.point", surface.point);
    write_array(folder + "/surface.triangle", surface.triangle);
    write_array(folder + "/surface.face", surface.face);
    write_array(folder + "/surface.piece", surface.piece);

    const SampleCopies copies;
    must(write_file(folder + "/copies.vtu", copies_vtu(copies.nodes(), copies.copies(), copies.von_mises)));
    write_array(folder + "/copies.rest", copies.rest);
    write_array(folder + "/copies.displacement", copies.displacement);
    write_array(folder + "/copies.velocity", copies.velocity);
    write_array(folder + "/copies.mass", copies.mass);
    write_array(folder + "/copies.fixed", copies.fixed);
    write_array(folder + "/copies.reference_node", copies.reference);
    write_array(folder + "/copies.node", copies.node);
    write_array(folder + "/copies.element", copies.element);
    write_array(folder + "/copies.piece", copies.piece);
    write_array(folder + "/copies.fraction", copies.fraction);
    write_array(folder + "/copies.von_mises", copies.von_mises);

    const SeriesEntry series[] = {{0, "copies.vtu"}, {1.0 / 60, "a&b.vtu"}};
    must(write_series(folder + "/series.pvd", series));
}

} // namespace

} // namespace resect

int main(int count, char** words) {
    if (count != 2) { return 2; }
    resect::write_samples(words[1]);
    return 0;
}
